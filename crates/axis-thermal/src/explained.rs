//! What growth and warming friction explain of logs of hours.

use nalgebra::DVector;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::error::ThermalError;
use crate::growth_log::{FollowedFriction, FollowedGrowth, FollowedLog, usual_duration};
use crate::heat_effects::{
    Assumed, BOTH, Deviations, FALLS, Fitted, GROWTH, HeldLog, LEVELS, PER_KELVIN, Problem, shown,
};
use crate::parameters::ThermalParameters;
use crate::residual_noise::ResidualNoise;
use crate::rival_drift::{self, RivalDrift};

/// A number with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct HeatEstimate {
    /// The estimate.
    pub value: f64,
    /// Its interval.
    pub interval: [f64; 2],
}

/// RMS of log less model: growth in m, power in W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct HeatGap {
    /// Readings.
    pub readings: usize,
    /// Without growth, friction constant at the level that fits best.
    pub before: f64,
    /// With the named effects.
    pub after: f64,
    /// Of noise alone.
    pub noise: f64,
    /// Greatest value that was read.
    pub of: f64,
}

impl HeatGap {
    /// Share of the gap above the noise that is gone.
    pub fn reduction(&self) -> f64 {
        let above = |rms: f64| (rms * rms - self.noise * self.noise).max(0.0);
        match self.stands_out() {
            true => 1.0 - above(self.after) / above(self.before),
            false => 0.0,
        }
    }

    /// Whether it is above the noise: by a fifth, and by three standard deviations of an RMS of so many readings.
    pub fn stands_out(&self) -> bool {
        let chance = 3.0 / (2.0 * self.readings.max(1) as f64).sqrt();
        self.before > self.noise * (1.0 + chance.max(0.2))
    }
}

/// What a log shows of one of the two effects.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct HeatEffect {
    /// Whether it is named.
    pub named: bool,
    /// By which D is greater without it: on what is fitted, on what is not.
    pub evidence: [f64; 2],
    /// The same of the drifts in its place, against neither.
    pub rivals: Vec<(RivalDrift, [f64; 2])>,
    /// Whether one of them does better.
    pub is_a_drift: bool,
    /// Growth at the reading with the greatest one, m; share of the friction's power that is lost at the reading with the
    /// greatest loss.
    pub size: HeatEstimate,
    /// Time (s) and, of growth, position (m) of that reading.
    pub at: [f64; 2],
    /// The least such size that these logs would name.
    pub limit: f64,
    /// Gaps of what is fitted, and of what is not.
    pub gaps: [HeatGap; 2],
}

/// Readings of a log that were not fitted, log less model, before and after.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct HeatResidual {
    /// Position, m; none of the friction's power.
    pub place: Option<f64>,
    /// s.
    pub time: Vec<f64>,
    /// m or W.
    pub before: Vec<f64>,
    /// m or W.
    pub after: Vec<f64>,
}

/// What both effects explain.
#[derive(Clone, Debug)]
pub struct HeatExplained {
    /// Growth of the screw; none if the logs do not show it.
    pub growth: Option<HeatEffect>,
    /// Friction that falls with warmth; none if the logs do not show the friction's power.
    pub warming: Option<HeatEffect>,
    /// Fall of viscous and of dry friction and rise of the preload, 1/K; none without readings of the power.
    pub falls: Option<[HeatEstimate; 3]>,
    /// The numbers with what is named.
    pub parameters: ThermalParameters,
    /// Dry and viscous friction at the reference temperature, as multiples of the file's.
    pub levels: [f64; 2],
    /// Residuals of each log.
    pub residuals: Vec<Vec<HeatResidual>>,
}

/// By which D must be greater without an effect: on what is fitted, on what is not.
const DECISIVE_EVIDENCE: [f64; 2] = [25.0, 9.0];

/// Share of its gap that an effect must take away to be named.
const LEAST_REDUCTION: f64 = 0.5;

/// Half of a 95 % interval in standard deviations that have so many degrees of freedom.
fn within(freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |t| t.inverse_cdf(0.975))
}

/// Sums of squares of growth and of friction's power: of what is fitted, of what is not.
fn squares(logs: &[HeldLog], fitted: &Fitted, deviations: Deviations) -> [[f64; 2]; 2] {
    let usual = usual_duration(&fitted.followed);
    let mut sums = [[0.0; 2]; 2];
    for (held, followed) in logs.iter().zip(&fitted.followed) {
        let part = |stretch: usize| usize::from(stretch >= held.fitted);
        for read in &followed.growth {
            let error = fitted.size() * read.predicted - read.found;
            sums[0][part(read.stretch)] += (error / deviations.growth).powi(2);
        }
        for read in followed.powers() {
            let error = read.deviation(usual) / deviations.friction;
            sums[1][part(read.stretch)] += error * error;
        }
    }
    sums
}

/// Fits under all assumptions.
struct Fits {
    both: Fitted,
    without_growth: Fitted,
    without_warming: Fitted,
    neither: Fitted,
    deviations: Deviations,
    noise: [ResidualNoise; 2],
}

impl Fits {
    fn of(problem: &Problem<'_>) -> Result<Self, ThermalError> {
        let first = Deviations {
            growth: 1e-6,
            friction: 0.01,
        };
        let rough = problem.fit(BOTH, first, None)?;
        let (_, determined) = problem.covariance(BOTH, &rough, first)?;
        let of = |noise: [ResidualNoise; 2]| Deviations {
            growth: noise[0].all,
            friction: noise[1].all,
        };
        let second = of(problem.noise(&rough, determined));
        let both = problem.fit(BOTH, second, Some(&rough))?;
        let (_, determined) = problem.covariance(BOTH, &both, second)?;
        let noise = problem.noise(&both, determined);
        let deviations = of(noise);
        let fit = |growth: bool, warming: bool| {
            problem.fit(Assumed { growth, warming }, deviations, None)
        };
        Ok(Self {
            both: problem.fit(BOTH, deviations, Some(&both))?,
            without_growth: fit(false, true)?,
            without_warming: fit(true, false)?,
            neither: fit(false, false)?,
            deviations,
            noise,
        })
    }
}

impl ThermalParameters {
    /// Whether growth and friction that falls with warmth explain these logs, as states of the network of these
    /// numbers.
    ///
    /// # Errors
    /// [`ThermalError`] if the logs have too few readings, a number of them is not finite, or the numbers make no
    /// model.
    pub fn explain(&self, logs: &[HeldLog]) -> Result<HeatExplained, ThermalError> {
        let shows = shown(logs)?;
        let problem = Problem {
            assumed: self,
            logs,
            shows,
        };
        let fits = Fits::of(&problem)?;
        let growth = shows.growth.then(|| growth(&problem, &fits)).transpose()?;
        let warming = shows
            .warming
            .then(|| warming(&problem, &fits))
            .transpose()?;
        let is_named = |effect: &Option<HeatEffect>| effect.as_ref().is_none_or(|e| e.named);
        let last = match (is_named(&growth), is_named(&warming)) {
            (true, true) => &fits.both,
            (true, false) => &fits.without_warming,
            (false, true) => &fits.without_growth,
            (false, false) => &fits.neither,
        };
        let mut found = HeatExplained {
            falls: shows.warming.then(|| falls(&problem, &fits)).transpose()?,
            parameters: problem.parameters(&last.at),
            levels: last.levels(),
            residuals: residuals(logs, &fits.neither, last),
            growth,
            warming,
        };
        if let Some(screw) = &mut found.parameters.screw
            && found.growth.as_ref().is_some_and(|effect| effect.named)
        {
            screw.expansion *= last.size();
        }
        let [growth, friction] = [0, 1].map(|kind| gaps(logs, &fits, last, kind));
        for (effect, gaps) in [(&mut found.growth, growth), (&mut found.warming, friction)] {
            if let Some(effect) = effect {
                effect.gaps = gaps;
            }
        }
        Ok(found)
    }
}

/// Whether an effect is named, with its evidence and its rivals. `kind`: 0 growth, 1 friction.
fn judged(
    problem: &Problem<'_>,
    fits: &Fits,
    kind: usize,
    rivals: Vec<RivalDrift>,
    found: (HeatEstimate, [f64; 2], f64),
) -> HeatEffect {
    let without = [&fits.without_growth, &fits.without_warming][kind];
    let of = |fitted: &Fitted| squares(problem.logs, fitted, fits.deviations);
    let [with_it, without_it, none] = [&fits.both, without, &fits.neither].map(of);
    let held = |of: [[f64; 2]; 2]| of[0][1] + of[1][1];
    let evidence = [
        without.deviance - fits.both.deviance,
        held(without_it) - held(with_it),
    ];
    // What this kind of readings and the priors cost.
    let own = fits.both.deviance - with_it[1 - kind][0] + with_it[kind][1];
    let falls = |r: &RivalDrift| [0, 1].map(|part| none[kind][part] - r.deviance[part]);
    let is_better = |r: &RivalDrift| {
        let [fitted, held] = falls(r);
        fitted >= DECISIVE_EVIDENCE[0]
            && held >= DECISIVE_EVIDENCE[1]
            && r.deviance[0] + r.deviance[1] < own
    };
    let is_a_drift = rivals.iter().any(is_better);
    let gaps = gaps(problem.logs, fits, &fits.both, kind);
    let alone = gaps_between(problem.logs, fits, [without, &fits.both], kind);
    let named = !is_a_drift
        && evidence[0] >= DECISIVE_EVIDENCE[0]
        && evidence[1] >= DECISIVE_EVIDENCE[1]
        && alone[1].reduction() >= LEAST_REDUCTION;
    let (size, at, limit) = found;
    HeatEffect {
        named,
        evidence,
        rivals: rivals.iter().map(|r| (*r, falls(r))).collect(),
        is_a_drift,
        size,
        at,
        limit,
        gaps,
    }
}

fn interval(value: f64, deviation: f64, freedom: f64) -> HeatEstimate {
    let half = within(freedom) * deviation;
    HeatEstimate {
        value,
        interval: [value - half, value + half],
    }
}

fn growth(problem: &Problem<'_>, fits: &Fits) -> Result<HeatEffect, ThermalError> {
    let logs = problem.logs;
    let (covariance, determined) = problem.covariance(BOTH, &fits.both, fits.deviations)?;
    let freedom = problem.freedom(determined)[0];
    let all = fits.both.followed.iter().enumerate();
    let all = all.flat_map(|(l, log)| log.growth.iter().enumerate().map(move |(i, r)| (l, i, r)));
    let greatest = all.max_by(|a, b| a.2.found.abs().total_cmp(&b.2.found.abs()));
    let Some((l, i, read)) = greatest else {
        return Err(ThermalError::NoDuration);
    };
    let of =
        |at: &DVector<f64>, followed: &[FollowedLog]| at[GROWTH] * followed[l].growth[i].predicted;
    let spread = problem.spread(&fits.both, &covariance, of)?;
    let size = interval(fits.both.size() * read.predicted, spread, freedom);
    let mut sums = [0.0; 2];
    for (held, followed) in logs.iter().zip(&fits.both.followed) {
        for r in &followed.growth {
            sums[usize::from(r.stretch >= held.fitted)] += r.predicted * r.predicted;
        }
    }
    let limit =
        [0, 1].map(|part| fits.deviations.growth * (DECISIVE_EVIDENCE[part] / sums[part]).sqrt());
    let limit = limit[0].max(limit[1]) * read.predicted.abs();
    let rivals = rival_drift::of_growth(logs, fits.deviations.growth);
    let at = [read.time, read.place];
    Ok(judged(problem, fits, 0, rivals, (size, at, limit)))
}

/// Power of the friction of a reading if it did not change with temperature, W.
fn cold(problem: &Problem<'_>, log: usize, read: &FollowedFriction, levels: [f64; 2]) -> f64 {
    let duty = &problem.logs[log].log.stretches[read.stretch].duty;
    let [dry, viscous] = duty.friction_power();
    levels[0] * dry + levels[1] * viscous
}

fn warming(problem: &Problem<'_>, fits: &Fits) -> Result<HeatEffect, ThermalError> {
    let both = &fits.both;
    let (covariance, determined) = problem.covariance(BOTH, both, fits.deviations)?;
    let freedom = problem.freedom(determined)[1];
    let lost = |log: usize, read: &FollowedFriction, levels: [f64; 2]| {
        1.0 - read.predicted / cold(problem, log, read, levels)
    };
    // Where it is greatest if friction falls as the file has it: a fit without a fall has no such place.
    let probed = problem.as_the_file_falls(both)?;
    let all = probed.iter().enumerate();
    let all = all.flat_map(|(l, log)| log.friction.iter().enumerate().map(move |(i, r)| (l, i, r)));
    let worked = all.filter(|(_, _, read)| read.found > 0.0);
    let loss = |(l, _, read): &(usize, usize, &FollowedFriction)| lost(*l, read, both.levels());
    let greatest = worked.max_by(|a, b| loss(a).total_cmp(&loss(b)));
    let Some((l, i, read)) = greatest else {
        return Err(ThermalError::NoDuration);
    };
    let of = |at: &DVector<f64>, followed: &[FollowedLog]| {
        let levels = [0, 1].map(|i| at[LEVELS + i].exp());
        lost(l, &followed[l].friction[i], levels)
    };
    let value = of(&both.at, &both.followed);
    let spread = problem.spread(both, &covariance, of)?;
    let size = interval(value, spread, freedom);
    let rivals = rival_drift::of_friction(problem.logs, both, fits.deviations);
    let time: f64 = problem.logs[l].log.stretches[..=read.stretch]
        .iter()
        .map(|stretch| stretch.duration)
        .sum();
    // A fall of one part of the friction, with its level left free: five standard deviations of its size.
    let limit = 5.0 * spread;
    Ok(judged(problem, fits, 1, rivals, (size, [time, 0.0], limit)))
}

fn falls(problem: &Problem<'_>, fits: &Fits) -> Result<[HeatEstimate; 3], ThermalError> {
    let (covariance, determined) = problem.covariance(BOTH, &fits.both, fits.deviations)?;
    let freedom = problem.freedom(determined)[1];
    let values = fits.both.falls();
    Ok([0, 1, 2].map(|i| {
        let k = FALLS + i;
        let deviation = covariance[(k, k)].max(0.0).sqrt();
        interval(values[i], PER_KELVIN[i] * deviation, freedom)
    }))
}

/// Gaps of one kind of readings against neither effect, before; `after` a fit.
fn gaps(logs: &[HeldLog], fits: &Fits, after: &Fitted, kind: usize) -> [HeatGap; 2] {
    gaps_between(logs, fits, [&fits.neither, after], kind)
}

fn gaps_between(
    logs: &[HeldLog],
    fits: &Fits,
    [before, after]: [&Fitted; 2],
    kind: usize,
) -> [HeatGap; 2] {
    let mut found = [HeatGap::default(); 2];
    let mut add = |part: usize, errors: [f64; 2], read: f64| {
        let gap = &mut found[part];
        gap.readings += 1;
        gap.before += errors[0] * errors[0];
        gap.after += errors[1] * errors[1];
        // Noise of the power is a share of it.
        let noise = fits.noise[kind].white * if kind == 1 { read } else { 1.0 };
        gap.noise += noise * noise;
        gap.of = gap.of.max(read.abs());
    };
    for (l, held) in logs.iter().enumerate() {
        let part = |stretch: usize| usize::from(stretch >= held.fitted);
        let [a, b] = [before, after].map(|fit| &fit.followed[l]);
        if kind == 0 {
            for (a, b) in a.growth.iter().zip(&b.growth) {
                let error = |fit: &Fitted, r: &FollowedGrowth| fit.size() * r.predicted - r.found;
                add(
                    part(a.stretch),
                    [error(before, a), error(after, b)],
                    a.found,
                );
            }
        } else {
            for (a, b) in a.powers().zip(b.powers()) {
                let errors = [a, b].map(|r| r.predicted - r.found);
                add(part(a.stretch), errors, a.found);
            }
        }
    }
    for gap in &mut found {
        let count = gap.readings.max(1) as f64;
        for value in [&mut gap.before, &mut gap.after, &mut gap.noise] {
            *value = (*value / count).sqrt();
        }
    }
    found
}

/// Log less model of each place of each log, and of its power.
fn residuals(logs: &[HeldLog], before: &Fitted, after: &Fitted) -> Vec<Vec<HeatResidual>> {
    let one = |l: usize| {
        let mut all: Vec<HeatResidual> = Vec::new();
        let [a, b] = [before, after].map(|fit| &fit.followed[l]);
        let mut add = |place: Option<f64>, time: f64, errors: [f64; 2]| {
            let known = all.iter().position(|r| r.place == place);
            let at = known.unwrap_or_else(|| {
                all.push(HeatResidual {
                    place,
                    ..HeatResidual::default()
                });
                all.len() - 1
            });
            all[at].time.push(time);
            all[at].before.push(errors[0]);
            all[at].after.push(errors[1]);
        };
        let from = logs[l].fitted;
        let growth = a.growth.iter().zip(&b.growth);
        for (a, b) in growth.filter(|(a, _)| a.stretch >= from) {
            let errors = [(before, a), (after, b)];
            let errors = errors.map(|(fit, r)| r.found - fit.size() * r.predicted);
            add(Some(a.place), a.time, errors);
        }
        let ends = ends(&logs[l]);
        let powers = a.powers().zip(b.powers());
        for (a, b) in powers.filter(|(a, _)| a.stretch >= from) {
            add(None, ends[a.stretch], [a, b].map(|r| r.found - r.predicted));
        }
        all
    };
    (0..logs.len()).map(one).collect()
}

/// Times at which the stretches end, s.
fn ends(held: &HeldLog) -> Vec<f64> {
    let mut time = 0.0;
    let stretches = held.log.stretches.iter();
    stretches
        .map(|stretch| {
            time += stretch.duration;
            time
        })
        .collect()
}
