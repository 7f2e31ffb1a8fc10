//! A channel's rest with and without an effect, against what that depends on.

use axis_sim::effects::Effect;
use axis_sim::{Axis, Trace};
use serde::{Deserialize, Serialize};

use crate::model::LogSet;
use crate::noise::{Floor, Rest};

/// Mean rest of a channel over a variable of the motion, on the check logs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Against {
    /// The effect.
    pub effect: String,
    /// The channel whose rest the variable makes out best.
    pub channel: String,
    /// The variable with its unit.
    pub variable: String,
    /// Middles of the variable's bins.
    pub at: Vec<f64>,
    /// Mean of log − model in each, the effect taken out of the model.
    pub without: Vec<f64>,
    /// The same with it.
    pub with: Vec<f64>,
}

/// Bins over a variable.
const BINS: usize = 48;

/// Fewest samples of which a mean is shown.
const LEAST: usize = 5;

/// Looks at the rests of `set` without and with an effect, simulated as
/// `traces` with it. `None` where the motion holds its variable still.
pub(super) fn against(
    machine: &Axis,
    set: &LogSet,
    traces: &[Trace],
    effect: &Effect,
    [without, with]: [&Rest; 2],
    floors: &[Floor],
) -> Option<Against> {
    let (variable, values) = variable(machine, set, traces, effect.depends_on);
    let all = || values.iter().flatten().copied();
    let (low, high) = all().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    if low >= high {
        return None;
    }
    let bin = |x: f64| (((x - low) / (high - low) * BINS as f64) as usize).min(BINS - 1);
    let mut counts = [0usize; BINS];
    all().for_each(|x| counts[bin(x)] += 1);
    let means = |rest: &Rest, channel: usize| -> Vec<f64> {
        let mut sums = vec![0.0; BINS];
        for (series, values) in rest.iter().zip(&values) {
            for (r, &x) in series[channel].iter().zip(values) {
                sums[bin(x)] += r;
            }
        }
        let pairs = sums.iter().zip(&counts);
        pairs.map(|(s, &n)| s / n.max(1) as f64).collect()
    };
    let kept: Vec<usize> = (0..BINS).filter(|&b| counts[b] >= LEAST).collect();
    let pick = |means: Vec<f64>| -> Vec<f64> { kept.iter().map(|&b| means[b]).collect() };
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
    let channel = (0..set.channels.len()).max_by(|&a, &b| made_out(a).total_cmp(&made_out(b)))?;
    let width = (high - low) / BINS as f64;
    Some(Against {
        effect: effect.name.to_owned(),
        channel: set.channels[channel].to_owned(),
        variable,
        at: kept
            .iter()
            .map(|&b| low + width * (b as f64 + 0.5))
            .collect(),
        without: pick(means(without, channel)),
        with: pick(means(with, channel)),
    })
}

/// The variable of the motion that stands for what an effect depends on, and
/// its course in every log.
fn variable(
    machine: &Axis,
    set: &LogSet,
    traces: &[Trace],
    depends_on: &str,
) -> (String, Vec<Vec<f64>>) {
    let per_log = |course: &dyn Fn(usize, &Trace) -> Vec<f64>| -> Vec<Vec<f64>> {
        traces
            .iter()
            .enumerate()
            .map(|(l, t)| course(l, t))
            .collect()
    };
    let position = |t: &Trace| t.position().to_vec();
    let speed = |t: &Trace| t.speed.clone();
    if depends_on.contains("angle") {
        let radians = 1.0 / machine.travel_per_radian();
        let angle = |_, t: &Trace| -> Vec<f64> {
            let turned = position(t).into_iter().map(|x| x * radians);
            turned
                .map(|a| a.rem_euclid(std::f64::consts::TAU))
                .collect()
        };
        ("screw angle, rad".to_owned(), per_log(&angle))
    } else if depends_on.contains("speed") || depends_on.contains("velocity") {
        ("speed, m/s".to_owned(), per_log(&|_, t| speed(t)))
    } else if depends_on.contains("position") {
        ("position, m".to_owned(), per_log(&|_, t| position(t)))
    } else if depends_on.contains("acceleration") || depends_on.contains("nut force") {
        let slope = |l: usize, t: &Trace| -> Vec<f64> {
            let v = speed(t);
            let last = v.len().saturating_sub(1);
            let at = |k: usize| {
                let (from, to) = (k.saturating_sub(1), (k + 1).min(last));
                (v[to] - v[from]) / (set.logs[l].period * (to - from).max(1) as f64)
            };
            (0..v.len()).map(at).collect()
        };
        ("acceleration, m/s²".to_owned(), per_log(&slope))
    } else if depends_on.contains("current") && traces.iter().all(|t| t.channel("iq_a").is_some()) {
        let current = |_, t: &Trace| t.channel("iq_a").unwrap_or_default().to_vec();
        ("current iq, A".to_owned(), per_log(&current))
    } else {
        let time = |l: usize, t: &Trace| -> Vec<f64> {
            (0..t.speed.len())
                .map(|k| k as f64 * set.logs[l].period)
                .collect()
        };
        ("time, s".to_owned(), per_log(&time))
    }
}
