//! A channel's rest with and without an effect, against what that depends on.

use axis_sim::effects::{Effect, EffectChannel, EffectVariable, Measure};
use axis_sim::{Axis, Trace};
use serde::{Deserialize, Serialize};

use super::cost::effort;
use super::units::channel_unit;
use crate::answers::LogSet;
use crate::answers::Rest;
use crate::name::curves::{angles, slope};
use crate::noise::Floor;

/// Mean rest of a channel over a variable of the motion, on the check logs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Against {
    /// The effect.
    pub effect: String,
    /// The channel that shows it: of a torque what the drive gives, of others the one whose
    /// rest the variable makes out best.
    pub channel: String,
    /// SI unit of the means: of a torque that of a force on the load, of others the channel's.
    pub unit: String,
    /// The variable.
    pub variable: String,
    /// Its SI unit.
    pub variable_unit: String,
    /// Middles of the variable's bins.
    pub at: Vec<f64>,
    /// Mean of log − model in each, the effect taken out of the model.
    pub without: Vec<f64>,
    /// The same with it.
    pub with: Vec<f64>,
}

/// Most bins over a variable.
const BINS: usize = 48;

/// Samples a bin where there are few, on average.
const EACH: usize = 10;

/// Fewest samples of which a mean is shown.
const LEAST: usize = 5;

/// Looks at the residuals of `set` without and with an effect, simulated as
/// `traces` with it. `None` if the motion holds its variable still, or there are too few
/// samples to show anything.
pub(super) fn against(
    machine: &Axis,
    set: &LogSet,
    traces: &[Trace],
    effect: &Effect,
    [without, with]: [&Rest; 2],
    floors: &[Floor],
) -> Option<Against> {
    let ([variable, variable_unit], values) = variable(machine, set, traces, effect.shown_over);
    let all = || values.iter().flatten().copied();
    let (low, high) = all().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    if low >= high {
        return None;
    }
    let bins = (all().count() / EACH).clamp(1, BINS);
    let bin = |x: f64| (((x - low) / (high - low) * bins as f64) as usize).min(bins - 1);
    let mut counts = vec![0usize; bins];
    all().for_each(|x| counts[bin(x)] += 1);
    let means = |rest: &Rest, channel: usize| -> Vec<f64> {
        let mut sums = vec![0.0; bins];
        for (series, values) in rest.iter().zip(&values) {
            for (r, &x) in series[channel].iter().zip(values) {
                sums[bin(x)] += r;
            }
        }
        let pairs = sums.iter().zip(&counts);
        pairs.map(|(s, &n)| s / n.max(1) as f64).collect()
    };
    let kept: Vec<usize> = (0..bins).filter(|&b| counts[b] >= LEAST).collect();
    if kept.is_empty() {
        return None;
    }
    let pick = |means: Vec<f64>| -> Vec<f64> { kept.iter().map(|&b| means[b]).collect() };
    let scaled = |means: Vec<f64>, by: f64| -> Vec<f64> { means.iter().map(|m| by * m).collect() };
    // How much of a channel's rest above its noise the variable alone makes out:
    // a force is the sharpest in the current, a slack in the position.
    let power = |channel: usize| -> f64 {
        let all = without.iter().flat_map(|log| &log[channel]);
        all.map(|r| r * r).sum()
    };
    let samples: usize = counts.iter().sum();
    let made_out = |channel: usize| -> f64 {
        let noise = samples as f64 * floors[channel].rms.powi(2);
        let means = means(without, channel);
        let squares = kept.iter().map(|&b| counts[b] as f64 * means[b].powi(2));
        squares.sum::<f64>() / (power(channel) + 10.0 * noise).max(f64::MIN_POSITIVE)
    };
    let force = effort(machine, set).filter(|_| effect.channel == EffectChannel::Torque);
    let (channel, factor) = match force {
        Some(force) => force,
        None => {
            let sharpest = |a: &usize, b: &usize| made_out(*a).total_cmp(&made_out(*b));
            ((0..set.channels.len()).max_by(sharpest)?, 1.0)
        }
    };
    let unit = match force {
        Some(_) => Measure::Force.unit(machine.freedom()),
        None => channel_unit(set.channels[channel]),
    };
    let width = (high - low) / bins as f64;
    Some(Against {
        effect: effect.name.to_owned(),
        channel: set.channels[channel].to_owned(),
        unit: unit.to_owned(),
        variable,
        variable_unit,
        at: kept
            .iter()
            .map(|&b| low + width * (b as f64 + 0.5))
            .collect(),
        without: scaled(pick(means(without, channel)), factor),
        with: scaled(pick(means(with, channel)), factor),
    })
}

/// A variable of the motion in words, its unit, and its course in every log.
fn variable(
    machine: &Axis,
    set: &LogSet,
    traces: &[Trace],
    over: EffectVariable,
) -> ([String; 2], Vec<Vec<f64>>) {
    let shown = |trace: &Trace| trace.channel("iq_a").is_some();
    let over = match over {
        EffectVariable::Current if !traces.iter().all(shown) => EffectVariable::Time,
        over => over,
    };
    let course = |(log, trace): (usize, &Trace)| {
        let period = set.logs[log].period;
        match over {
            EffectVariable::MotorAngle => angles(trace.position(), machine.travel_per_radian()),
            EffectVariable::Speed => trace.speed.clone(),
            EffectVariable::Position => trace.position().to_vec(),
            EffectVariable::Acceleration => slope(&trace.speed, period),
            EffectVariable::Current => trace.channel("iq_a").unwrap_or_default().to_vec(),
            EffectVariable::Distance => way(trace.position()),
            EffectVariable::Time => (0..trace.speed.len()).map(|k| k as f64 * period).collect(),
        }
    };
    let of = |measure: Measure| measure.unit(machine.freedom());
    let words = match over {
        EffectVariable::MotorAngle => ["motor angle within a turn", "rad"],
        EffectVariable::Speed => ["speed", of(Measure::Speed)],
        EffectVariable::Position => ["position", of(Measure::Travel)],
        EffectVariable::Acceleration => ["acceleration", of(Measure::Acceleration)],
        EffectVariable::Current => ["current iq", "A"],
        EffectVariable::Distance => ["distance travelled", of(Measure::Travel)],
        EffectVariable::Time => ["time", "s"],
    };
    let courses = traces.iter().enumerate().map(course).collect();
    (words.map(str::to_owned), courses)
}

/// Sum of all ways to and fro.
fn way(positions: &[f64]) -> Vec<f64> {
    let mut last = positions.first().copied().unwrap_or(0.0);
    let mut sum = 0.0;
    let one = |&x: &f64| {
        sum += (x - last).abs();
        last = x;
        sum
    };
    positions.iter().map(one).collect()
}
