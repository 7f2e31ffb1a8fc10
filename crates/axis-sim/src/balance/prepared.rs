//! A log made ready for its torque balance.

use std::ops::Range;

use axis_log::{Channel, Log};

use super::Balance;
use super::filter::LowPass;
use super::friction_scatter::Remeasured;
use super::law::Motions;
use super::motion::{Course, Measured, Whose};
use super::quality::{BalanceQuality, TOLERATED};
use super::spectrum::{least_noise, passed};
use super::transmission::Transmission;
use super::wind_up::WindUp;
use crate::axis::Axis;
use crate::balance_error::{BalanceError, CutoffReason};
use crate::replay::ReplayError;
use crate::torque_channel::TorqueChannel;

/// Highest cut-off of the motion that is chosen by itself, as a share of the sampling rate: there differences
/// over five samples are derivatives to half a per cent.
const HIGHEST: f64 = 0.1;

/// Cut-off of the comparison as a share of that of the motion: there the latter takes less
/// than 0.1 % from the motion, 0.4⁸.
const BELOW: f64 = 0.4;

/// Highest cut-off of the comparison that an axis file may ask for, as a share of the sampling rate: eight samples a
/// period.
const HIGHEST_ASKED: f64 = 0.125;

/// Compared samples per period of the cut-off.
const RATE: f64 = 2.5;

/// Highest cut-off as a share of the natural frequency below which what is measured moves as
/// one: there a two-mass drive's inertia seems greater by 4 %.
const RIGID: f64 = 0.2;

/// Highest cut-off as a share of the frequency at which a load that is not measured swings against
/// the motor: what it does there is computed.
const SOFT: f64 = 0.4;

/// Speeds below so many deviations of its noise are not told from rest.
const DEVIATIONS: f64 = 3.0;

/// Way after which a contact slides for certain, as a multiple of that on which its bristles bend to
/// their limit: twice for bristles bent the other way, and twice again for some half as stiff.
const SLIDES: f64 = 4.0;

/// Periods of the cut-off at either end of a log that are left out: in two, what a filter
/// makes of an end has decayed to a hundredth.
const EDGE: f64 = 2.0;

/// Periods of the cut-off about a sample in which friction has to be known.
const NEAR: f64 = 0.5;

/// Share of the samples that is left at least, however little is known of friction, and how many
/// are left in any case.
const MOST_SURE: f64 = 0.5;
const MOST_SURE_OF: usize = LEAST + LEAST / 4;

/// Fewest samples that are compared.
const LEAST: usize = 32;

impl Balance {
    /// Prepares logs that are compared together, with their sampling periods (s): with one
    /// channel of torque that all have, and the lowest of their cut-offs.
    ///
    /// # Errors
    /// [`ReplayError::Balance`] names what a log lacks.
    pub fn of_logs(logs: &[(&Log, f64)], axis: &Axis) -> Result<Vec<Self>, ReplayError> {
        let only: Vec<&Log> = logs.iter().map(|(log, _)| *log).collect();
        let channel = TorqueChannel::of(&only, axis)?;
        let measured = logs.iter().map(|(log, period)| {
            if !(period.is_finite() && *period > 0.0) {
                return Err(BalanceError::Period { period: *period });
            }
            Measured::of(log, *period, axis)
        });
        let measured: Vec<Vec<Measured>> = measured.collect::<Result<_, _>>()?;
        let own = |(motions, (log, period)): (&Vec<Measured>, &(&Log, f64))| {
            let most = BELOW * HIGHEST / period;
            if let Some(asked) = axis.balance.cutoff {
                return Ok(Cutoff::lower(
                    Cutoff(asked, CutoffReason::Asked),
                    Cutoff(HIGHEST_ASKED / period, CutoffReason::Sampling),
                ));
            }
            // A constant torque is known as well as this by the log, one standard deviation.
            let logged = log.channel(channel.name)?;
            let time = *period * log.len() as f64;
            let least = (0.5 * least_noise(logged, *period) / time).sqrt();
            let acceleration =
                |m: &Measured| least / (channel.per_torque(axis) * inertia(axis, m.whose)).abs();
            let each = motions.iter().map(|m| {
                let cutoff = m.noise.cutoff(most, TOLERATED, acceleration(m));
                Cutoff(cutoff, CutoffReason::Noise)
            });
            let stiff = Cutoff(rigid_below(axis, motions), CutoffReason::Resonance);
            let first = Cutoff::lower(Cutoff(most, CutoffReason::Sampling), stiff);
            Ok(each.fold(first, Cutoff::lower))
        };
        let cutoffs = measured.iter().zip(logs).map(own);
        let cutoffs: Vec<Cutoff> = cutoffs.collect::<Result<_, ReplayError>>()?;
        let cutoff = cutoffs.into_iter().reduce(Cutoff::lower);
        let cutoff = cutoff.unwrap_or(Cutoff(f64::INFINITY, CutoffReason::Sampling));
        let one = |(motions, logged): (Vec<Measured>, &(&Log, f64))| {
            Self::prepared(*logged, axis, channel, &motions, cutoff)
        };
        measured.into_iter().zip(logs).map(one).collect()
    }

    /// One log alone.
    ///
    /// # Errors
    /// As [`Balance::of_logs`].
    pub fn new(log: &Log, period: f64, axis: &Axis) -> Result<Self, ReplayError> {
        let mut all = Self::of_logs(&[(log, period)], axis)?;
        Ok(all.remove(0))
    }

    /// One log, with its sampling period (s).
    fn prepared(
        (log, period): (&Log, f64),
        axis: &Axis,
        channel: TorqueChannel,
        measured: &[Measured],
        Cutoff(cutoff, reason): Cutoff,
    ) -> Result<Self, ReplayError> {
        let motion_cutoff = cutoff / BELOW;
        let motions = motions(axis, measured, period, motion_cutoff);
        let every = ((1.0 / (RATE * cutoff * period)).floor() as usize).max(1);
        let compared_period = every as f64 * period;
        let seen = DEVIATIONS * speed_noise(axis, measured, motion_cutoff);
        let standstill = axis
            .balance
            .slowest
            .map_or(seen, |slowest| slowest.max(seen));
        let (mut moving, all) = moving(&motions.load, period, cutoff, every, standstill);
        let names = measured.iter().map(|m| m.name).chain([channel.name]);
        let holes = names.flat_map(|name| log.missing(name).iter().cloned());
        without_holes(
            &mut moving,
            holes,
            (EDGE / (cutoff * period)).ceil() as usize,
        );
        let filter = LowPass::new(cutoff * period);
        let logged = log.channel(channel.name)?;
        let noise = TorqueNoise::least(channel, logged, &measured[0], period, cutoff);
        let remeasured = Remeasured {
            axis,
            measured: &measured[0],
            load: &motions.load,
            spring: motions.spring(axis),
            period,
            cutoff: motion_cutoff,
        };
        let per_force = channel.per_torque(axis) * axis.travel_per_radian();
        let scatter = remeasured.friction_scatter(&filter);
        let near = (NEAR / (cutoff * period)).ceil() as usize;
        let creeps = creeps(axis, &motions.load, period, near);
        let kept = resolved(&moving, creeps, &scatter, near, noise.rms(axis) / per_force);
        if kept.len() < LEAST {
            let (kept, speed) = (kept.len(), standstill);
            return Err(stands_still([kept, all], speed, axis, Cutoff(cutoff, reason)).into());
        }
        let transmission = Transmission::of(measured, axis, period, cutoff);
        let pick = |series: &[f64]| -> Vec<f64> { kept.iter().map(|&k| series[k]).collect() };
        let shown = |series: &[f64]| pick(&filter.apply(series));
        let position = pick(&motions.load.position);
        let speed = pick(&motions.load.speed);
        let quality = BalanceQuality {
            channel: channel.name,
            motion: measured.iter().map(|m| m.name).collect(),
            cutoff,
            reason,
            motion_cutoff,
            attenuation: (measured.iter())
                .map(|m| m.noise.attenuation(cutoff))
                .fold(0.0, f64::max),
            standstill,
            speed_unit: axis.freedom().speed_unit(),
            compared_period,
            samples: [kept.len(), all],
            unresolved: moving.len() - kept.len(),
            friction: per_force * rms(kept.iter().map(|&k| scatter[k])),
        };
        let mut compared = vec![
            Channel::new("t_s", pick(log.time()))?,
            Channel::new(axis.position_channel(), position.clone())?,
            Channel::new(channel.name, shown(logged))?,
        ];
        if let Some(of) = &transmission {
            compared.push(Channel::new(of.name, shown(&of.samples))?);
        }
        let compared = Log::new(compared)?;
        Ok(Self {
            channel,
            transmission,
            motions,
            period,
            filter,
            kept,
            position: (axis.position_channel(), position),
            speed,
            compared,
            quality,
            noise,
        })
    }
}

/// Too few of all samples are left where the axis moves faster than `speed`.
fn stands_still(
    [kept, samples]: [usize; 2],
    speed: f64,
    axis: &Axis,
    Cutoff(cutoff, reason): Cutoff,
) -> BalanceError {
    BalanceError::Standstill {
        kept,
        samples,
        least: LEAST,
        speed,
        unit: axis.freedom().speed_unit(),
        cutoff,
        reason,
    }
}

/// Least noise of the torque's channel, as the upper spectra of torque and motion leave it possible.
#[derive(Clone, Debug)]
pub(super) struct TorqueNoise {
    channel: TorqueChannel,
    /// Of the channel, RMS in its unit.
    torque: f64,
    whose: Whose,
    /// Of the acceleration of what was measured, RMS, m/s² or rad/s².
    acceleration: f64,
}

impl TorqueNoise {
    /// Of a channel as logged, beside what shows the motion, below the cut-off (Hz).
    fn least(
        channel: TorqueChannel,
        logged: &[f64],
        motion: &Measured,
        period: f64,
        cutoff: f64,
    ) -> Self {
        Self {
            channel,
            torque: (least_noise(logged, period) * passed(0, cutoff)).sqrt(),
            whose: motion.whose,
            acceleration: motion.noise.least_acceleration(cutoff),
        }
    }

    /// RMS in the channel's unit, with the inertia of this axis: a model makes torque of the
    /// acceleration's noise.
    pub(super) fn rms(&self, axis: &Axis) -> f64 {
        let of_motion = self.acceleration * inertia(axis, self.whose);
        self.torque.hypot(self.channel.per_torque(axis) * of_motion)
    }
}

/// A cut-off of the comparison, Hz, and what sets it.
#[derive(Clone, Copy, Debug)]
struct Cutoff(f64, CutoffReason);

impl Cutoff {
    fn lower(self, other: Self) -> Self {
        match other.0 < self.0 {
            true => other,
            false => self,
        }
    }
}

/// Drops the samples of which a hole is within `reach`: what stands in it is interpolated, and the
/// filters spread that.
fn without_holes(kept: &mut Vec<usize>, holes: impl Iterator<Item = Range<usize>>, reach: usize) {
    for hole in holes {
        let touched = hole.start.saturating_sub(reach)..hole.end + reach;
        kept.retain(|k| !touched.contains(k));
    }
}

/// The frequency, Hz, below which one measured motion stands for that of motor and load:
/// well below the first mode. Of two, each has its own inertia, up to the second.
///
/// Of a load that is found by its swinging against the motor: below the frequency of that.
fn rigid_below(axis: &Axis, measured: &[Measured]) -> f64 {
    let highest = match (measured, wind_up(axis)) {
        ([one], Some(wind_up)) if one.whose == Whose::Motor => SOFT * wind_up.swing(axis),
        _ => RIGID * natural_frequency(axis, measured.len()),
    };
    highest / std::f64::consts::TAU
}

/// Root mean square.
fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

/// Middle of the stroke, m or rad.
fn middle(axis: &Axis) -> f64 {
    0.5 * (axis.stroke.minimum + axis.stroke.maximum)
}

/// Natural frequency of the axis in the middle of its stroke, rad/s, the first being 1; infinite
/// where there are fewer.
fn natural_frequency(axis: &Axis, place: usize) -> f64 {
    let mut modes = axis.mechanism.modes(middle(axis)).unwrap_or_default();
    modes.retain(|w| *w > 0.0);
    modes.sort_by(f64::total_cmp);
    modes
        .get(place.saturating_sub(1))
        .copied()
        .unwrap_or(f64::INFINITY)
}

/// The transmission's wind-up: that of the two-mass drive with this axis' inertias and first
/// natural frequency; `None` of a stiff one.
fn wind_up(axis: &Axis) -> Option<WindUp> {
    let r = axis.travel_per_radian();
    let load = axis.mechanism.load_inertia();
    let motor = axis.mechanism.total_inertia() / (r * r) - load;
    let reduced = motor * load / (motor + load);
    let stiffness = natural_frequency(axis, 1).powi(2) * reduced;
    let at = middle(axis);
    let stiffness_by_compliance = stiffness * axis.mechanism.compliance(at);
    let gives_way = stiffness_by_compliance.is_finite() && stiffness_by_compliance > 0.0;
    gives_way.then_some(WindUp {
        at,
        stiffness_by_compliance,
    })
}

/// Motor torque per acceleration of what was measured.
fn inertia(axis: &Axis, whose: Whose) -> f64 {
    match whose {
        Whose::Motor => axis.mechanism.total_inertia(),
        Whose::Load => axis.mechanism.total_inertia() / axis.travel_per_radian(),
    }
}

/// Noise of the load's speed, RMS.
fn speed_noise(axis: &Axis, measured: &[Measured], cutoff: f64) -> f64 {
    let one = &measured[0];
    match one.whose {
        Whose::Load => one.noise.speed(cutoff),
        Whose::Motor => one.noise.speed(cutoff) * axis.travel_per_radian(),
    }
}

/// The motions of load and motor, one made of the other where only one was measured.
fn motions(axis: &Axis, measured: &[Measured], period: f64, cutoff: f64) -> Motions {
    let of = |whose: Whose| measured.iter().find(|m| m.whose == whose);
    let course = |m: &Measured| m.course(period, cutoff);
    let r = axis.travel_per_radian();
    let (load, motor) = (of(Whose::Load).map(course), of(Whose::Motor).map(course));
    let load_is_derived = load.is_none();
    let motor_is_measured = motor.is_some();
    let motor_was_homed = of(Whose::Motor).is_some_and(|m| m.is_loads);
    let empty = || Course {
        position: Vec::new(),
        speed: Vec::new(),
        acceleration: Vec::new(),
    };
    let (load, motor) = match (load, motor) {
        (Some(load), Some(motor)) => (load, motor),
        (Some(load), None) => {
            let motor = load.times(1.0 / r);
            (load, motor)
        }
        (None, Some(motor)) => (motor.times(r), motor),
        // One was found, or there is no motion to prepare.
        (None, None) => (empty(), empty()),
    };
    Motions {
        load,
        motor,
        load_is_derived,
        motor_is_measured,
        motor_was_homed,
        wind_up: (measured.len() == 1).then(|| wind_up(axis)).flatten(),
    }
}

/// Of the samples at which the load moves and does not creep, those about which friction is
/// `scatter` (at the load, by sample of the log) by less than noise of that size alone, `near` to either
/// side; where that would leave too few, the surest.
fn resolved(
    moving: &[usize],
    creeps: impl Fn(usize) -> bool,
    scatter: &[f64],
    near: usize,
    noise: f64,
) -> Vec<usize> {
    let about = |k: &usize| {
        let window = &scatter[k.saturating_sub(near)..(k + near + 1).min(scatter.len())];
        window.iter().copied().fold(0.0, f64::max)
    };
    let limit = |of: &[usize], least: usize| {
        let mut sorted: Vec<f64> = of.iter().map(about).collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(least).map_or(f64::INFINITY, |of| of.max(noise))
    };
    let share = limit(moving, (MOST_SURE * moving.len() as f64) as usize);
    let sliding: Vec<usize> = moving.iter().copied().filter(|k| !creeps(*k)).collect();
    let limit = limit(&sliding, MOST_SURE_OF).max(share);
    let kept = sliding.iter().filter(|k| about(k) <= limit);
    kept.copied().collect()
}

/// Whether the contact may still be in pre-sliding at a sample: the load travels, within `near` samples to
/// either side, less than the displacement at which the contact slides. If it travels that far within no such
/// window, the travel since its last reversal counts instead. In pre-sliding, friction is whatever holds the
/// load, however well its speed is distinguished from standstill.
fn creeps(axis: &Axis, load: &Course, period: f64, near: usize) -> impl Fn(usize) -> bool {
    let friction = axis.friction.share();
    let lever = friction.lever(axis.travel_per_radian());
    let slides = SLIDES * (friction.law.bristle_limit() * lever).abs();
    let mut run = 0.0;
    let mut before = 0.0_f64;
    // Way since the load last turned or stood.
    let runs: Vec<f64> = (load.speed.iter())
        .map(|v| {
            run = if before * v > 0.0 {
                run + period * v.abs()
            } else {
                0.0
            };
            before = *v;
            run
        })
        .collect();
    let about = move |k: usize| {
        let window = &load.speed[k.saturating_sub(near)..(k + near + 1).min(load.speed.len())];
        period * window.iter().map(|v| v.abs()).sum::<f64>()
    };
    // At a cut-off so high that no load goes so far within its period, what has slid slides yet.
    let is_short = (0..load.speed.len()).all(|k| about(k) < slides);
    move |k| match is_short {
        true => runs[k] < slides,
        false => about(k) < slides,
    }
}

/// Every so manyth sample at which the load moves, and how many there are with those at
/// which it does not.
///
/// At rest the force of friction is whatever holds the load, which no measured motion says;
/// a filter spreads it over half a period of its cut-off. At the ends a filter has not
/// settled.
fn moving(
    load: &Course,
    period: f64,
    cutoff: f64,
    every: usize,
    standstill: f64,
) -> (Vec<usize>, usize) {
    let n = load.speed.len();
    let near = (0.25 / (cutoff * period)).ceil() as usize;
    let edge = (EDGE / (cutoff * period)).ceil() as usize;
    let moves = |k: &usize| {
        let window = &load.speed[k.saturating_sub(near)..(k + near + 1).min(n)];
        *k >= edge && k + edge < n && window.iter().all(|v| v.abs() > standstill)
    };
    let all = (0..n).step_by(every);
    (all.clone().filter(moves).collect(), all.len())
}
