//! The gap between model and logs, channel by channel.

use std::ops::Range;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use axis_sim::{Axis, ReplayError};

use crate::answers::LogSet;
use crate::answers::Rest;
use crate::estimate::fit::Fit;
use crate::noise::{Floor, floors};

/// Root-mean-square gap of a channel, in its unit, from where its logs count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChannelGap {
    /// Name with unit.
    pub channel: String,
    /// Model as its file says.
    pub before: f64,
    /// With the effects.
    pub after: f64,
    /// Of noise alone: sensors and logger as noisy as the residual shows.
    pub floor: f64,
    /// The most of it in any of a few simulated runs.
    pub floor_most: f64,
    /// Whether it is the least that noise may be, as of the torque in a torque balance.
    #[serde(default)]
    pub floor_is_least: bool,
}

impl ChannelGap {
    /// Whether it stood out of its noise before.
    fn stood_out(&self) -> bool {
        self.before > REST * self.floor
    }

    /// Whether it did by more than noise of any colour may.
    fn stood_out_plainly(&self) -> bool {
        match self.floor_is_least {
            true => self.before > COLOURED * self.floor,
            false => self.stood_out(),
        }
    }

    /// Whether the residual may be noise of which only the least is known.
    fn may_be_more_noise(&self) -> bool {
        self.floor_is_least && self.after <= COLOURED * self.floor
    }

    /// Whether the residual is noise.
    pub(crate) fn is_at_floor(&self) -> bool {
        self.after <= (REST * self.floor).max(OF_RUNS * self.floor_most)
    }
}

/// Gap on a set of logs.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Gap {
    /// One entry a channel.
    pub channels: Vec<ChannelGap>,
    /// Share of the gap above the floor that is gone: of the mean square over
    /// all channels, each against its own gap before. Where one stood out by more than noise of
    /// any colour may, over those that did.
    pub reduction: f64,
}

impl Gap {
    /// Whether any channel stood out of its noise before.
    #[must_use]
    pub fn stands_out(&self) -> bool {
        self.channels.iter().any(ChannelGap::stood_out)
    }

    /// Whether the residual is noise in all channels.
    pub(crate) fn is_at_floor(&self) -> bool {
        self.channels.iter().all(ChannelGap::is_at_floor)
    }

    /// Whether the residual may be noise of another colour than that of the floors, whatever else
    /// is
    /// known of it.
    pub(crate) fn may_be_coloured(&self) -> bool {
        self.is_within(COLOURED)
    }

    /// Whether it may be such noise where it does not follow the motion.
    pub(crate) fn may_be_noise_apart_from_motion(&self) -> bool {
        self.is_within(APART_FROM_MOTION)
    }

    /// Whether the residual is noise in all channels, or may be in those of which only its least is known
    /// and of which what was named takes nothing: without it they are `without`, RMS. What is gone
    /// then counts above that noise.
    pub(crate) fn taken_for_noise(&self, without: &[f64]) -> Option<Self> {
        let mut raised = self.channels.clone();
        let takes_nothing = |c: usize| without[c] <= TAKES_NOTHING * self.channels[c].after;
        for (c, gap) in raised.iter_mut().enumerate() {
            if gap.is_at_floor() {
                continue;
            }
            if !(gap.may_be_more_noise() && takes_nothing(c)) {
                return None;
            }
            gap.floor = gap.after;
        }
        Some(Self {
            reduction: reduction(&raised),
            channels: self.channels.clone(),
        })
    }

    fn is_within(&self, floors: f64) -> bool {
        let mut channels = self.channels.iter();
        channels.all(|c| c.after <= floors * c.floor)
    }

    /// What is gone of it, as the beginning of a sentence.
    #[must_use]
    pub fn gone(&self) -> String {
        match self.stands_out() {
            true => format!(
                "{} % of the gap above the noise is gone on motion not used in the fit",
                axis_log::fixed(100.0 * self.reduction, 1)
            ),
            false => "No channel exceeded its noise by more than a fifth: the evidence is from all samples together, on motion not used in the fit as well".to_owned(),
        }
    }
}

/// A channel's rest is significant beyond this multiple of its floor.
const REST: f64 = 1.2;

/// Multiple of the floor, as it is taken from high frequencies, beyond which a
/// residual is no noise, whatever its colour, unless more is known of it.
const COLOURED: f64 = 4.0;

/// The same of a residual that does not follow the motion: noise of a low corner, or of steps in
/// what
/// the
/// controller reads, has most of its power where the loop answers, and little above.
const APART_FROM_MOTION: f64 = 20.0;

/// And beyond this multiple of the noisiest of the runs.
const OF_RUNS: f64 = 1.1;

/// A residual within this multiple of its floor is noise: where nothing was left in
/// simulated logs, it came out between 0.79 (a motor angle, else 0.90) and 1.05
/// of it.
const FLOOR: f64 = 1.05;

/// Deviations of noise by which a channel must be further off to be called so: passed by
/// chance in two of ten thousand, as Student's t with the 32 parts of which the deviation
/// is known.
const DEVIATIONS: f64 = 4.0;

/// Mean of a value over all samples that count.
fn mean(counted: &[Range<usize>], value: impl Fn(usize, usize) -> f64) -> f64 {
    let all = counted.iter().cloned().enumerate();
    let all = all.flat_map(|(l, samples)| samples.map(move |k| (l, k)));
    let samples: usize = counted.iter().map(Range::len).sum();
    all.map(|(l, k)| value(l, k)).sum::<f64>() / samples.max(1) as f64
}

fn mean_square(counted: &[Range<usize>], rest: &Rest, channel: usize) -> f64 {
    mean(counted, |l, k| rest[l][channel][k].powi(2))
}

/// The gap of a set's logs, with residuals before and after something was done.
pub fn gap(set: &LogSet, before: &Rest, after: &Rest, floors: &[Floor]) -> Gap {
    let counted = set.counted();
    let rms = |rest: &Rest, c: usize| mean_square(&counted, rest, c).sqrt();
    let channels: Vec<ChannelGap> = set
        .channels
        .iter()
        .enumerate()
        .map(|(c, name)| ChannelGap {
            channel: (*name).to_owned(),
            before: rms(before, c),
            after: rms(after, c),
            floor: floors[c].rms,
            floor_most: floors[c].most,
            floor_is_least: floors[c].is_least,
        })
        .collect();
    Gap {
        reduction: reduction(&channels),
        channels,
    }
}

/// Share of the gap above the floor that is gone.
fn reduction(channels: &[ChannelGap]) -> f64 {
    let above = |rms: f64, floor: f64| {
        if rms <= FLOOR * floor {
            0.0
        } else {
            rms * rms - floor * floor
        }
    };
    let any_plain = channels.iter().any(ChannelGap::stood_out_plainly);
    let counts = |c: &&ChannelGap| match any_plain {
        true => c.stood_out_plainly(),
        false => c.stood_out(),
    };
    let shares = channels.iter().filter(counts);
    let ratios: Vec<f64> = shares
        .map(|c| above(c.after, c.floor) / above(c.before, c.floor))
        .collect();
    if ratios.is_empty() {
        return 0.0;
    }
    1.0 - (ratios.iter().sum::<f64>() / ratios.len() as f64).sqrt()
}

/// The log whose residual is furthest above its own noise in some channel: its place, and how many
/// times.
pub(crate) fn furthest_above(set: &LogSet, rest: &Rest, floors: &[Floor]) -> Option<(usize, f64)> {
    let counted = set.counted();
    let times = |l: usize, c: usize| {
        let samples = counted[l].clone();
        let count = samples.len().max(1) as f64;
        let square = samples.map(|k| rest[l][c][k].powi(2)).sum::<f64>() / count;
        let floor = floors[c].by_log.get(l).copied().unwrap_or(floors[c].rms);
        square.sqrt() / floor.max(f64::MIN_POSITIVE)
    };
    let of_log = |l: usize| {
        let channels = 0..set.channels.len();
        (l, channels.map(|c| times(l, c)).fold(0.0, f64::max))
    };
    let logs = (0..set.logs.len()).map(of_log);
    logs.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Whether a log holds more than noise, its residual so many times its floor, beside others that
/// show so many
/// times theirs: noise may be twice as large where an axis moves in another range or faster.
pub(crate) fn is_more_than_noise(times: f64, of_others: f64) -> bool {
    times > BETWEEN_LOGS * of_others.clamp(1.0, APART_FROM_MOTION)
}

/// Times by which noise differs from log to log. Not calibrated: of a clean screw in coloured
/// noise 1.2 was too
/// little.
const BETWEEN_LOGS: f64 = 2.0;

/// Least that something must change in a channel of the check logs, RMS, as a share of the
/// channel's noise: left out, it would raise the RMS of the residual by 1.6 %, which no
/// engineer would look for.
pub const MATERIAL_OF_NOISE: f64 = 0.18;

/// The same as what the RMS of a residual without it is a multiple of: √(1 + 0.18²).
const TAKES_NOTHING: f64 = 1.016;

/// Least that it must change in that channel, as a share of the gap, RMS, that there was
/// before anything was named: a thirtieth, a thousandth of its power.
const OF_GAP: f64 = 0.03;

/// Root mean square of each channel's rest.
pub(crate) fn sizes(set: &LogSet, rest: &Rest) -> Vec<f64> {
    let counted = set.counted();
    let all = 0..set.channels.len();
    all.map(|c| mean_square(&counted, rest, c).sqrt()).collect()
}

/// Share of the residual above the noise, as power, that something may leave which takes the
/// residual
/// of
/// a gap.
const OF_REST: f64 = 0.5;

/// Whether the residuals differ by next to nothing of what each channel shows ([`LogSet::immaterial`]).
pub(crate) fn differ_immaterially(machine: &Axis, set: &LogSet, [a, b]: [&Rest; 2]) -> bool {
    let counted = set.counted();
    let change = |c: usize| mean(&counted, |l, k| (a[l][c][k] - b[l][c][k]).powi(2)).sqrt();
    (0..set.channels.len()).all(|c| change(c) < set.immaterial(machine, c))
}

/// Whether what brought the residual from `before` to `after` is not small in some channel beside
/// its noise, nor beside the `gap` that there was. D counts evidence, not size: it falls with
/// the length of the logs, for what is far beneath their noise as well. Whether a channel came
/// nearer is not asked: in noise that is common to several channels something may be plain by
/// how they differ, and yet not bring any one of them nearer.
///
/// What was named before may have made up for most of it, as dry friction does for viscous. So
/// beside the gap it counts by its own size where it takes most of what stands out of the noise
/// yet: the residual would be `without` it if nothing else were changed.
///
/// # Errors
/// [`ReplayError`] if the machine does not run with noise.
pub(crate) fn is_material(
    machine: &Axis,
    set: &LogSet,
    before: &Fit,
    after: &Rest,
    without: impl FnOnce() -> Option<Rest>,
    gap: &[f64],
) -> Result<bool, ReplayError> {
    let earlier = set.rest(&before.traces);
    let floors = floors(machine, set, &before.state, after)?;
    let counted = set.counted();
    let change = |from: &Rest, c: usize| {
        let change = |l: usize, k: usize| after[l][c][k] - from[l][c][k];
        mean(&counted, |l, k| change(l, k).powi(2)).sqrt()
    };
    let of_noise = |c: usize| MATERIAL_OF_NOISE * floors[c].rms;
    let of_gap = |c: usize| OF_GAP * gap.get(c).copied().unwrap_or(0.0);
    let seen = |c: &usize| change(&earlier, *c) >= of_noise(*c).max(f64::MIN_POSITIVE);
    let seen: Vec<usize> = (0..set.channels.len()).filter(seen).collect();
    let of_gap_before = seen.iter().any(|&c| change(&earlier, c) >= of_gap(c));
    let takes_rest = |c: usize| {
        let [before, after] = [&earlier, after].map(|rest| mean_square(&counted, rest, c));
        let above = |power: f64| power - floors[c].rms.powi(2);
        before > (REST * floors[c].rms).powi(2) && above(after) <= OF_REST * above(before)
    };
    let by_itself = || {
        let takers: Vec<usize> = seen.iter().copied().filter(|&c| takes_rest(c)).collect();
        let without = (!takers.is_empty()).then(without).flatten();
        without.is_some_and(|without| takers.iter().any(|&c| change(&without, c) >= of_gap(c)))
    };
    let material = of_gap_before || by_itself();
    tracing::debug!(material, of_gap_before, ?seen, "material on check logs");
    Ok(material)
}

/// Channels that are further off after something was done than before, beyond what noise
/// explains; `None` if none is, and neither is the whole.
///
/// Both residuals hold the same noise n, so their difference δ holds none, and the mean
/// squares differ by what the model did and by twice the mean of n·δ. Of N samples of noise
/// with the standard deviation σ that are worth N′ independent ones, that mean has the
/// deviation σ·RMS(δ)/√N′, and a channel is further off where
///
/// ```text
/// mean square after − mean square before > 4 · 2 σ RMS(δ) / √N′
/// ```
///
/// unless it is noise alone. In total no allowance is made where the residual is far above the
/// noise: the gap above the floor may not be larger than before.
pub fn worsened(
    set: &LogSet,
    before: &Rest,
    after: &Rest,
    floors: &[Floor],
) -> Option<Vec<&'static str>> {
    let counted = set.counted();
    let is_worse = |c: &usize| further_off(&counted, before, after, *c, &floors[*c]);
    let worse: Vec<usize> = (0..set.channels.len()).filter(is_worse).collect();
    let of_gap = gap(set, before, after, floors);
    // Rests of coloured noise trade a little here for a little there.
    let in_total = of_gap.reduction < 0.0 && !of_gap.may_be_coloured();
    (in_total || !worse.is_empty()).then(|| worse.into_iter().map(|c| set.channels[c]).collect())
}

fn further_off(
    counted: &[Range<usize>],
    before: &Rest,
    after: &Rest,
    channel: usize,
    floor: &Floor,
) -> bool {
    let change = |l: usize, k: usize| after[l][channel][k] - before[l][channel][k];
    let change = mean(counted, |l, k| change(l, k).powi(2)).sqrt();
    let by_noise = DEVIATIONS * 2.0 * floor.rms * change / floor.independent.max(1.0).sqrt();
    let [before, after] = [before, after].map(|rest| mean_square(counted, rest, channel));
    after > before + by_noise && after > (FLOOR * floor.rms).powi(2)
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::further_off;
    use crate::noise::Floor;

    const SAMPLES: usize = 4000;

    /// Noise of a first-order autoregression, of unit variance.
    fn noise(memory: f64, random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut value: f64 = StandardNormal.sample(random);
        let mut next = || {
            let new: f64 = StandardNormal.sample(random);
            value = memory * value + (1.0 - memory * memory).sqrt() * new;
            value
        };
        (0..SAMPLES).map(|_| next()).collect()
    }

    /// How often of 400 a channel is called further off: its gap before is a slow wave of
    /// this amplitude, and after the same wave shifted by a quarter, times a factor.
    fn called(memory: f64, amplitude: f64, factor: f64) -> usize {
        let mut random = ChaCha8Rng::seed_from_u64(17);
        let turn = 5.0 * std::f64::consts::TAU / SAMPLES as f64;
        let wave = |k: usize, shift: f64| amplitude * (turn * k as f64 + shift).sin();
        let case = |_: &usize| {
            let noise = noise(memory, &mut random);
            let gap = |shift: f64, by: f64| {
                let one = noise.iter().enumerate();
                vec![vec![one.map(|(k, n)| n + by * wave(k, shift)).collect()]]
            };
            let floor = Floor::of(std::slice::from_ref(&noise));
            let quarter = std::f64::consts::FRAC_PI_2;
            let all = std::slice::from_ref(&(0..SAMPLES));
            further_off(all, &gap(0.0, 1.0), &gap(quarter, factor), 0, &floor)
        };
        (0..400).filter(case).count()
    }

    /// Gaps three times, and a third of, the noise; samples with a memory of ten are worth
    /// a nineteenth of as many independent ones.
    #[test]
    fn another_gap_of_the_same_size_is_no_worse_and_a_larger_one_is() {
        for memory in [0.0, 0.9] {
            for amplitude in [0.3, 3.0] {
                assert_eq!(called(memory, amplitude, 1.0), 0);
            }
        }
        assert_eq!([called(0.0, 3.0, 1.1), called(0.0, 0.3, 2.0)], [400; 2]);
        assert_eq!(called(0.9, 3.0, 1.5), 400);
    }

    /// (1 − φ)/(1 + φ) of the samples, for a memory φ. Measured: within 2 %, of 20 series.
    #[test]
    fn samples_are_worth_what_their_memory_leaves() {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        for memory in [0.5, 0.9] {
            let series: Vec<Vec<f64>> = (0..20).map(|_| noise(memory, &mut random)).collect();
            let floor = Floor::of(&series);
            let exact = 20.0 * SAMPLES as f64 * (1.0 - memory) / (1.0 + memory);
            assert!((floor.independent / exact - 1.0).abs() < 0.1, "{floor:?}");
            assert!((floor.rms - 1.0).abs() < 0.03, "{floor:?}");
        }
    }
}
