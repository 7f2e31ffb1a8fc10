//! A log made ready: smoothed signals at every few samples, and what of the torque balance
//! no parameter changes.

use std::vec::Vec;

use super::AdaptError;
use super::assumed::AssumedModel;
use super::check::check;
use super::kernel::{Kernel, mean};
use super::smooth::{Point, Smooth};
use super::torque::torques;
use crate::{DriveModel, Sample};

/// Share of the smoothing that is over the velocity beside the reference.
const VELOCITY: f64 = 0.25;
/// Time at the start over which nothing has moved yet, s.
const AT_START: f64 = 1e-3;
/// Share of friction's torque that counts as hardly any.
const HARDLY: f64 = 0.01;
/// Share of the greatest speed below which an axis counts as at rest there.
const SLOW: f64 = 0.01;
/// Deviations between two points: closer ones say the same.
const SPACING: f64 = 0.5;
/// Least number of points.
const LEAST_POINTS: usize = 40;

/// A log made ready.
#[derive(Clone, Debug)]
pub(super) struct Record {
    pub points: Vec<Point>,
    /// Velocity of the load in the friction's coordinate at each sample.
    pub speeds: Vec<f64>,
    /// What friction computed of the velocity is smoothed with.
    pub kernel: Kernel,
    /// What the torque at the start leaves to friction and constant load, in the
    /// friction's coordinate.
    pub held: f64,
    /// Whether the load's position was measured apart from the motor's angle.
    pub sees_load: bool,
    /// RMS of the motor's torque, N·m.
    pub torque: f64,
    /// Control period, s.
    pub period: f64,
    /// Samples at the start over which the axis rests, where it does.
    pub rest: Option<usize>,
}

impl Record {
    /// Of a log of the axis that is assumed, behind a Gaussian of the deviation `smoothing`
    /// (s). `besides` is what something that the model does not have took of the torque at
    /// each sample: at the motor, and on the load (both N·m at the motor). Empty if there is
    /// no such thing.
    pub fn new(
        assumed: &AssumedModel,
        log: &[Sample],
        smoothing: f64,
        besides: &[[f64; 2]],
    ) -> Result<Self, AdaptError> {
        let model = &assumed.model;
        let period = model.period;
        // Few samples a deviation make no Gaussian.
        let cycles = |time: f64| (time / period).max(1.0);
        let [balance, velocity] =
            [smoothing, VELOCITY * smoothing].map(|time| Kernel::new(cycles(time), period));
        let stride = ((SPACING * cycles(smoothing)) as usize).max(1);
        let edge = balance.half();
        check(model, log, 2 * edge + LEAST_POINTS * stride)?;

        let at_start = standing(model, &log[..cycles(AT_START) as usize]);
        let rest = rests(log, at_start).then_some(at_start);
        let mut torque = torques(model, log);
        let besides = [0, 1].map(|at| -> Vec<f64> { besides.iter().map(|b| b[at]).collect() });
        let angle: Vec<f64> = log.iter().map(|s| s.motor_angle).collect();
        let elastic = model.along.most_compliance() > 0.0;
        let measured: Vec<f64> = log.iter().map(|s| s.position).collect();
        let sees_load = elastic && differs(&measured, &angle, model.travel);
        let mut smooth = Smooth {
            model,
            torques: balance.pad(&torque, rest),
            besides: besides.each_ref().map(|taken| balance.pad(taken, rest)),
            angles: balance.pad(&angle, rest),
            balance: &balance,
        };
        if model.kinematics.amplitude != 0.0 {
            torque = smooth.without_reaction(&torque, &measured, &angle);
            smooth.torques = balance.pad(&torque, rest);
        }
        let position = match elastic && !sees_load {
            true => smooth.load(&measured, &angle),
            false => measured,
        };
        let positions = balance.pad(&position, rest);

        let limit = 0.999 * model.effort_limit;
        let commands = log.iter().enumerate();
        let limited = commands.filter(|(_, s)| s.last_command.abs() >= limit);
        let limited: Vec<usize> = limited.map(|(k, _)| k).collect();
        let near_limit = |k: usize| {
            let next = limited.partition_point(|&at| at + edge < k);
            limited.get(next).is_some_and(|&at| at <= k + edge)
        };
        // Before its first sample a log can be continued only if it begins at standstill; that adds
        // noise, and is done only if friction breaks away within the first samples.
        let way = log[2 * edge].reference.position - log[0].reference.position;
        let early = way.abs() > model.friction.bristle_limit() * model.lever;
        let from = if rest.is_some() && early { 0 } else { edge };
        let all: Vec<usize> = (from..log.len() - edge).step_by(stride).collect();
        let free = all.iter().copied().filter(|&k| !near_limit(k));
        let points: Vec<Point> = free.map(|k| smooth.point(k, &positions, elastic)).collect();
        if points.len() < LEAST_POINTS.max(all.len() / 2) {
            let share = 100.0 * (1.0 - points.len() as f64 / all.len() as f64);
            return Err(AdaptError::Saturated { share });
        }

        // Only what the load did beside its reference is smoothed, and that less: breaking
        // away keeps its shape where the axis follows.
        let reference: Vec<f64> = log.iter().map(|s| s.reference.position).collect();
        let beside = position.iter().zip(&reference).map(|(x, r)| x - r);
        let beside = velocity.pad(&beside.collect::<Vec<_>>(), rest);
        // Without any smoothing: central differences.
        let steps = Kernel::new(0.0, period);
        let ahead = steps.pad(&reference, rest.map(|_| 1));
        let speed = |k: usize| (steps.of(1, &ahead, k) + velocity.of(1, &beside, k)) / model.lever;
        let taken = |of: &Vec<f64>| of.get(..at_start).map_or(0.0, mean);
        let holding = mean(&torque[..at_start]) - besides.iter().map(taken).sum::<f64>();
        let load = model.along.at(position[0]).load;
        let squares: Vec<f64> = torque.iter().map(|t| t * t).collect();
        Ok(Self {
            points,
            speeds: (0..log.len()).map(speed).collect(),
            kernel: balance,
            held: (holding / model.travel - load) * model.lever,
            sees_load,
            torque: mean(&squares).sqrt(),
            period,
            rest,
        })
    }
}

/// First samples in which the reference asks for hardly any torque yet, beside friction's.
fn standing(model: &DriveModel, log: &[Sample]) -> usize {
    let section = model.along.at(log[0].position);
    let inertia = section.rotating / model.travel + model.travel * model.load_inertia;
    let friction = model.travel * model.friction.parameters().stiction / model.lever;
    let hardly = |s: &Sample| (inertia * s.reference.acceleration).abs() <= HARDLY * friction;
    log.iter().take_while(|s| hardly(s)).count().max(1)
}

/// Whether the axis stands still over the first samples, by reference and by measurement.
fn rests(log: &[Sample], samples: usize) -> bool {
    let (first, then) = (&log[0], &log[samples.min(log.len() - 1)]);
    let fastest = |f: &dyn Fn(&Sample) -> f64| {
        let by = |pair: &[Sample]| (f(&pair[samples]) - f(&pair[0])).abs();
        log.windows(samples + 1).map(by).fold(0.0, f64::max)
    };
    let slow = |f: &dyn Fn(&Sample) -> f64| (f(then) - f(first)).abs() <= SLOW * fastest(f);
    slow(&|s| s.reference.position) && slow(&|s| s.position)
}

/// Whether the load's position says more than the motor's angle.
fn differs(position: &[f64], angle: &[f64], travel: f64) -> bool {
    let apart = |k: usize| (position[k] - position[0]) - travel * (angle[k] - angle[0]);
    let scale = |k: usize| position[k].abs() + travel * angle[k].abs();
    (0..position.len()).any(|k| apart(k).abs() > 1e-9 * scale(k))
}
