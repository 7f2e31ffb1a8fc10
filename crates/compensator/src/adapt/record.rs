//! A log made ready: smoothed signals at every few samples, and what of the torque balance
//! no parameter changes.

use std::vec::Vec;

use super::AdaptError;
use super::belief::Belief;
use super::check::check;
use super::kernel::Kernel;
use super::torque::torques;
use crate::Sample;

/// Share of the smoothing that is over the velocity beside the reference.
const VELOCITY: f64 = 0.25;
/// Time at the start over which nothing has moved yet, s.
const AT_START: f64 = 1e-3;
/// Deviations between two points: closer ones say the same.
const SPACING: f64 = 0.5;
/// Least number of points.
const LEAST_POINTS: usize = 40;

/// The balance at one instant. Torques at the motor, N·m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Sample that it is at.
    pub sample: usize,
    /// Torque that is left for inertia of the load, friction and standing load.
    pub left: f64,
    /// Acceleration of the load.
    pub acceleration: f64,
    /// Motor angle against that of the load, rad.
    pub lead: f64,
    /// Torque through the transmission.
    pub transmitted: f64,
    /// Compliance of the model there, rad/(N·m).
    pub compliance: f64,
}

/// A log made ready.
#[derive(Clone, Debug)]
pub(super) struct Record {
    pub points: Vec<Point>,
    /// Velocity of the load in the friction's coordinate at each sample.
    pub speeds: Vec<f64>,
    /// What friction computed of the velocity is smoothed with.
    pub kernel: Kernel,
    /// What the torque at the start leaves to friction and standing load, in the
    /// friction's coordinate.
    pub held: f64,
    /// Whether the load's position was measured apart from the motor's angle.
    pub sees_load: bool,
    /// RMS of the motor's torque, N·m.
    pub torque: f64,
    /// Control period, s.
    pub period: f64,
}

impl Record {
    /// Of a log of the axis that is believed.
    pub fn new(belief: &Belief, log: &[Sample]) -> Result<Self, AdaptError> {
        let model = &belief.model;
        let (period, smoothing) = (model.period, belief.smoothing());
        // Few samples a deviation make no Gaussian.
        let cycles = |time: f64| (time / period).max(1.0);
        let [balance, velocity] =
            [smoothing, VELOCITY * smoothing].map(|time| Kernel::new(cycles(time), period));
        // Without any smoothing: central differences.
        let steps = Kernel::new(0.0, period);
        let stride = ((SPACING * cycles(smoothing)) as usize).max(1);
        let edge = balance.half();
        let least = 2 * edge + LEAST_POINTS * stride;
        check(model, log, least)?;

        let padded = |kernel: &Kernel, series: &[f64]| Kernel::pad(series, kernel.half());
        let torque = torques(model, log);
        let angle: Vec<f64> = log.iter().map(|s| s.motor_angle).collect();
        let (torques, angles) = (padded(&balance, &torque), padded(&balance, &angle));
        let measured: Vec<f64> = log.iter().map(|s| s.position).collect();
        let elastic = model.along.most_compliance() > 0.0;
        let sees_load = elastic && differs(&measured, &angle, model.travel);
        let position = match elastic && !sees_load {
            false => measured,
            // It is the motor's angle: less the wind-up that the torque tells.
            true => {
                let home = measured[0] - model.travel * angle[0];
                let wound = |k: usize| {
                    let section = model.along.at(measured[k]);
                    let through = balance.of(0, &torques, k)
                        - (section.rotating - section.lagging) * balance.of(2, &angles, k);
                    section.compliance * through
                };
                let start = wound(0);
                let load = |k: usize| home + model.travel * (angle[k] - wound(k) + start);
                (0..log.len()).map(load).collect()
            }
        };
        let positions = padded(&balance, &position);
        let at_limit: Vec<usize> = (log.iter().enumerate())
            .filter(|(_, s)| s.iq_command.abs() >= 0.999 * model.effort_limit)
            .map(|(k, _)| k)
            .collect();
        let near_limit = |k: usize| {
            let next = at_limit.partition_point(|&at| at + edge < k);
            at_limit.get(next).is_some_and(|&at| at <= k + edge)
        };
        let all: Vec<usize> = (edge..log.len() - edge).step_by(stride).collect();
        let point = |sample: usize| {
            let x = balance.of(0, &positions, sample);
            let acceleration = balance.of(2, &positions, sample);
            let section = model.along.at(x);
            let of_motor = match elastic {
                true => balance.of(2, &angles, sample),
                false => acceleration / model.travel,
            };
            let torque = balance.of(0, &torques, sample);
            let transmitted = torque - (section.rotating - section.lagging) * of_motor;
            Point {
                sample,
                left: transmitted
                    - section.lagging * acceleration / model.travel
                    - model.travel * section.load,
                acceleration,
                lead: balance.of(0, &angles, sample) - x / model.travel,
                transmitted,
                compliance: section.compliance,
            }
        };
        let free = all.iter().copied().filter(|&k| !near_limit(k));
        let points: Vec<Point> = free.map(point).collect();
        if points.len() < LEAST_POINTS.max(all.len() / 2) {
            let share = 100.0 * (1.0 - points.len() as f64 / all.len() as f64);
            return Err(AdaptError::Saturated { share });
        }

        // Only what the load did beside its reference is smoothed, and that less: breaking
        // away keeps its shape where the axis follows.
        let reference: Vec<f64> = log.iter().map(|s| s.reference.position).collect();
        let beside = position.iter().zip(&reference).map(|(x, r)| x - r);
        let beside = padded(&velocity, &beside.collect::<Vec<_>>());
        let ahead = padded(&steps, &reference);
        let speed = |k: usize| (steps.of(1, &ahead, k) + velocity.of(1, &beside, k)) / model.lever;
        let first = &torque[..(cycles(AT_START) as usize).clamp(1, torque.len())];
        let standing = first.iter().sum::<f64>() / first.len() as f64;
        let load = model.along.at(position[0]).load;
        let mean_square = torque.iter().map(|t| t * t).sum::<f64>() / torque.len() as f64;
        Ok(Self {
            points,
            speeds: (0..log.len()).map(speed).collect(),
            kernel: balance.clone(),
            held: (standing / model.travel - load) * model.lever,
            sees_load,
            torque: mean_square.sqrt(),
            period,
        })
    }
}

/// Whether the load's position says more than the motor's angle.
fn differs(position: &[f64], angle: &[f64], travel: f64) -> bool {
    let apart = |k: usize| (position[k] - position[0]) - travel * (angle[k] - angle[0]);
    let scale = |k: usize| position[k].abs() + travel * angle[k].abs();
    (0..position.len()).any(|k| apart(k).abs() > 1e-9 * scale(k))
}
