//! What a discovery says: verdict, effects with intervals, gap before and after.

use axis_sim::effects::Machine;
use axis_sim::{ClosedLoop, ReplayError, Trace};
use serde::{Deserialize, Serialize};

use crate::fit::{Fitter, free_parameters};
use crate::hidden::Noise;
use crate::known::{known_parameters, tolerance, with_known};
use crate::model::{LogSet, State};
use crate::search::Found;

/// The verdict on a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Named effects remove at least 90 % of the gap above the floor on check
    /// motion, and nothing significant is left.
    Explained,
    /// Named effects, and a significant rest that is not named.
    PartlyExplained,
    /// No gap beyond noise and the tolerance of known parameters.
    NothingMissing,
    /// A significant gap, and nothing in the library that explains it.
    Unknown,
}

/// A parameter of an effect with its 95 % interval.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ParameterFound {
    /// Name.
    pub name: String,
    /// Estimate, SI.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// An effect that was named.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct EffectFound {
    /// Name, as in the axis file.
    pub name: String,
    /// One line for people.
    pub summary: String,
    /// Effects that these logs cannot tell from it.
    pub indistinguishable_from: Vec<String>,
    /// Its numbers.
    pub parameters: Vec<ParameterFound>,
    /// Where it shows first.
    pub channel: String,
    /// On what it depends.
    pub depends_on: String,
    /// Share of the check logs' gap that comes back without it.
    pub share_of_gap: f64,
    /// Fall of minus twice the log-likelihood: on the fit logs, on the check logs.
    pub evidence: [f64; 2],
    /// What else was tried in its place, with the fall that it reached.
    pub runners_up: Vec<(String, f64)>,
}

/// Root-mean-square gap of a channel, in its unit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ChannelGap {
    /// Name with unit.
    pub channel: String,
    /// Model as its file says.
    pub before: f64,
    /// With the effects.
    pub after: f64,
    /// Of noise alone: sensors as noisy as the rest's highest frequencies show.
    pub floor: f64,
}

/// Gap on a set of logs.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Gap {
    /// One entry a channel.
    pub channels: Vec<ChannelGap>,
    /// Share of the gap above the floor that is gone: of the mean square over
    /// all channels, each against its own gap before.
    pub reduction: f64,
}

/// A known parameter that was moved inside its tolerance.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Recalibrated {
    /// Name.
    pub name: String,
    /// Share of its value by which it was moved.
    pub share: f64,
    /// Tolerance as a share.
    pub tolerance: f64,
}

/// What `discovery.json` holds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Discovery {
    /// Layout of this file.
    pub schema: u32,
    /// Name of the axis.
    pub axis: String,
    /// Verdict.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    pub sentence: String,
    /// Named effects, largest share first.
    pub effects: Vec<EffectFound>,
    /// Best candidates that were not added.
    pub not_added: Vec<(String, f64)>,
    /// Gap on the fit logs.
    pub fit: Gap,
    /// Gap on the check logs.
    pub check: Gap,
    /// Known parameters.
    pub recalibrated: Vec<Recalibrated>,
}

/// Measured, model before and after, for pictures: one channel of one log.
#[derive(Clone, Debug)]
pub struct Overlay {
    /// Log and channel.
    pub title: String,
    /// Name with unit.
    pub channel: String,
    /// s.
    pub time: Vec<f64>,
    /// Measured minus model, before.
    pub before: Vec<f64>,
    /// Measured minus model, after.
    pub after: Vec<f64>,
}

/// Puts a search's result into words and figures.
///
/// # Errors
/// [`ReplayError`] where a simulation that ran before does not run again.
pub fn discovery(
    machine: &Machine,
    fit_logs: &LogSet,
    check_logs: &LogSet,
    found: &Found,
) -> Result<(Discovery, Vec<Overlay>), ReplayError> {
    let initial = State::initial(machine);
    let gap_of = |set: &LogSet, state: &State, floor_state: &State| -> Result<Gap, ReplayError> {
        let before = set.rest(&set.simulate(machine, &initial)?);
        let after = set.rest(&set.simulate(machine, state)?);
        let best = set.rest(&set.simulate(machine, floor_state)?);
        let floors = floors(machine, set, floor_state, &best)?;
        Ok(gap(set, &before, &after, &floors))
    };
    let full = &found.fit.state;
    let fit = gap_of(fit_logs, full, full)?;
    let check = gap_of(check_logs, full, full)?;

    let mut effects = Vec::new();
    for (index, named) in found.named.iter().enumerate() {
        let mut without = full.clone();
        without.effects.remove(index);
        let lost = gap_of(check_logs, &without, full)?;
        effects.push(effect_found(
            found,
            index,
            named,
            (check.reduction - lost.reduction).clamp(0.0, 1.0),
        ));
    }
    effects.sort_by(|a, b| b.share_of_gap.total_cmp(&a.share_of_gap));

    let checker = Fitter {
        machine,
        set: check_logs,
    };
    let base = checker.at(found.base.state.clone())?;
    let at_floor = |gap: &Gap| gap.channels.iter().all(|c| c.after <= REST * c.floor);
    let rest_significant = !at_floor(&check);
    let verdict = match (effects.is_empty(), rest_significant) {
        (true, false) => Verdict::NothingMissing,
        (true, true) => Verdict::Unknown,
        (false, false) if check.reduction >= 0.9 => Verdict::Explained,
        (false, _) => Verdict::PartlyExplained,
    };
    let name = match machine {
        Machine::BallScrew(axis) => axis.name.clone(),
        Machine::Rigid(axis) => axis.name.clone(),
    };
    let recalibrated = known_parameters(machine)
        .iter()
        .zip(&full.shares)
        .map(|(known, &share)| Recalibrated {
            name: known.name.to_owned(),
            share,
            tolerance: tolerance(machine),
        })
        .collect();
    let overlays = overlays(
        check_logs,
        &base.traces,
        &check_logs.simulate(machine, full)?,
    );
    let discovery = Discovery {
        schema: 1,
        axis: name,
        sentence: sentence(verdict, &effects, &check),
        verdict,
        effects,
        not_added: found
            .leftover
            .iter()
            .map(|r| (r.name.to_owned(), r.gain))
            .collect(),
        fit,
        check,
        recalibrated,
    };
    Ok((discovery, overlays))
}

/// A channel's rest is significant beyond this multiple of its floor.
const REST: f64 = 1.2;

fn effect_found(
    found: &Found,
    index: usize,
    named: &crate::search::Named,
    share_of_gap: f64,
) -> EffectFound {
    let active = &found.fit.state.effects[index];
    let free = free_parameters(&found.fit.state);
    let known = found.fit.state.shares.len();
    let parameter = |(p, (spec, &value)): (usize, (&axis_sim::effects::EffectParameter, &f64))| {
        let column = free
            .iter()
            .position(|&at| at == (index, p))
            .map(|i| known + i);
        let deviation = column.map_or(0.0, |i| found.covariance[(i, i)].max(0.0).sqrt());
        ParameterFound {
            name: spec.name.to_owned(),
            value,
            unit: spec.unit.to_owned(),
            ci95: [value - 1.96 * deviation, value + 1.96 * deviation],
        }
    };
    EffectFound {
        name: active.effect.name.to_owned(),
        summary: active.effect.summary.to_owned(),
        indistinguishable_from: named
            .alike
            .iter()
            .map(|(name, _)| (*name).to_owned())
            .collect(),
        parameters: (active.effect.parameters.iter().zip(&active.values))
            .enumerate()
            .map(parameter)
            .collect(),
        channel: active.effect.channel.name().to_owned(),
        depends_on: active.effect.depends_on.to_owned(),
        share_of_gap,
        evidence: [named.evidence, named.held_out],
        runners_up: named
            .runners_up
            .iter()
            .map(|r| (r.name.to_owned(), r.gain))
            .collect(),
    }
}

type Rest = Vec<Vec<Vec<f64>>>;

fn gap(set: &LogSet, before: &Rest, after: &Rest, floors: &[f64]) -> Gap {
    let rms = |rest: &Rest, c: usize| {
        let (sum, n) = rest.iter().fold((0.0, 0), |(sum, n), log| {
            (
                sum + log[c].iter().map(|r| r * r).sum::<f64>(),
                n + log[c].len(),
            )
        });
        (sum / n.max(1) as f64).sqrt()
    };
    let channels: Vec<ChannelGap> = set
        .channels
        .iter()
        .enumerate()
        .map(|(c, name)| ChannelGap {
            channel: (*name).to_owned(),
            before: rms(before, c),
            after: rms(after, c),
            floor: floors[c],
        })
        .collect();
    let above = |rms: f64, floor: f64| (rms * rms - floor * floor).max(0.0);
    let shares = channels.iter().filter(|c| c.before > REST * c.floor);
    let ratios: Vec<f64> = shares
        .map(|c| above(c.after, c.floor) / above(c.before, c.floor))
        .collect();
    let reduction = if ratios.is_empty() {
        0.0
    } else {
        1.0 - (ratios.iter().sum::<f64>() / ratios.len() as f64).sqrt()
    };
    Gap {
        channels,
        reduction,
    }
}

/// RMS of noise alone in each channel.
///
/// The upper half of the bins lies above what the loop answers to, and shows
/// each sensor's own noise there: position and angle directly, the speed's
/// through the speed controller's gain, the current's through the current
/// controller's. A ball-screw loop is then simulated with such sensors, since
/// most of what they do lies lower, where the loop answers. For a rigid
/// machine the upper spectrum is taken for white.
fn floors(
    machine: &Machine,
    set: &LogSet,
    state: &State,
    best: &Rest,
) -> Result<Vec<f64>, ReplayError> {
    let upper: Vec<f64> = (0..set.channels.len())
        .map(|c| upper_level(set, best, c))
        .collect();
    let Machine::BallScrew(axis) = with_known(machine, &state.shares) else {
        return Ok(upper);
    };
    let level = |name: &str| {
        let channel = set.channels.iter().position(|c| *c == name);
        channel.map_or(0.0, |c| upper[c])
    };
    let gains = *axis.servo.gains();
    let per = |level: f64, gain: f64| if gain > 0.0 { level / gain } else { 0.0 };
    let noise = Noise {
        position: level("position_m"),
        angle: level("motor_angle_rad"),
        speed: per(level("iq_ref_a"), gains.speed_p),
        current: per(level("ud_v"), gains.d_p),
    };
    let mut axis = *axis;
    axis.effects.extend_from_slice(&state.effects);
    let closed_loop = ClosedLoop::new(&axis)?;
    let mut squares = vec![0.0; set.channels.len()];
    let mut samples = 0;
    for (seed, log) in set.logs.iter().enumerate() {
        let with = log
            .replay
            .follow(&closed_loop, noise.sensors(seed as u64))?;
        let without = log.replay.follow(&closed_loop, |_| ())?;
        for (square, name) in squares.iter_mut().zip(&set.channels) {
            let pair = with.channel(name).zip(without.channel(name));
            let Some((a, b)) = pair else { continue };
            *square += a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        }
        samples += log.log.len();
    }
    Ok(squares
        .iter()
        .map(|s| (s / f64::from(samples.max(1) as u32)).sqrt())
        .collect())
}

/// RMS of white noise with the level of the upper half of the bins.
fn upper_level(set: &LogSet, rest: &Rest, channel: usize) -> f64 {
    let spectra = set.amplitudes(rest);
    let m = set.channels.len();
    let (mut sum, mut n) = (0.0, 0usize);
    for bins in &spectra {
        let count = bins.len() / m;
        for k in count / 2..count {
            sum += bins[k * m + channel].norm_sqr();
            n += 1;
        }
    }
    (sum / n.max(1) as f64).sqrt()
}

fn overlays(set: &LogSet, before: &[Trace], after: &[Trace]) -> Vec<Overlay> {
    let (before, after) = (set.rest(before), set.rest(after));
    let mut all = Vec::new();
    for (l, log) in set.logs.iter().enumerate() {
        for (c, name) in set.channels.iter().enumerate() {
            all.push(Overlay {
                title: format!("{}: {name}", log.name),
                channel: (*name).to_owned(),
                time: log.log.time().to_vec(),
                before: before[l][c].clone(),
                after: after[l][c].clone(),
            });
        }
    }
    all
}

fn sentence(verdict: Verdict, effects: &[EffectFound], check: &Gap) -> String {
    let names: Vec<String> = effects
        .iter()
        .map(|e| match e.indistinguishable_from.as_slice() {
            [] => e.name.clone(),
            others => format!(
                "{} (or {}: these logs cannot tell)",
                e.name,
                others.join(", ")
            ),
        })
        .collect();
    let names = names.join("; ");
    let gone = 100.0 * check.reduction;
    match verdict {
        Verdict::NothingMissing => {
            "Nothing is missing: the model and the logs agree to the noise, with known parameters inside their tolerance.".to_owned()
        }
        Verdict::Explained => format!(
            "The model lacks {names}. With it, {gone:.1} % of the gap above the noise is gone on motion that it was not fitted to."
        ),
        Verdict::PartlyExplained => format!(
            "The model lacks {names}; {gone:.1} % of the gap above the noise is gone on motion that it was not fitted to, and a rest remains that is not named."
        ),
        Verdict::Unknown => {
            "Unknown: the model and the logs disagree, and no effect of the library explains it.".to_owned()
        }
    }
}
