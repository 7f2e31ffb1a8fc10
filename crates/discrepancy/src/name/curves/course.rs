//! The motion of a log, as simulated.

use axis_sim::{Axis, Trace};

use super::variable::Variable;
use crate::answers::LogSet;
use crate::answers::effort::of_drive;

/// The motion of one log as simulated.
pub struct Course {
    pub time: Vec<f64>,
    pub position: Vec<f64>,
    pub speed: Vec<f64>,
    /// In [0, 2π).
    pub angle: Vec<f64>,
    pub acceleration: Vec<f64>,
    /// Empty if no channel shows it.
    pub effort: Vec<f64>,
}

impl Course {
    /// One of its variables.
    pub fn of(&self, variable: Variable) -> &[f64] {
        match variable {
            Variable::Speed => &self.speed,
            Variable::Position => &self.position,
            Variable::Time => &self.time,
            Variable::Angle => &self.angle,
            Variable::Acceleration => &self.acceleration,
            Variable::Effort => &self.effort,
        }
    }
}

/// Speed below which a direction is not one, m/s.
pub const STANDS: f64 = 1e-3;

/// The motions of all logs.
pub fn courses(machine: &Axis, set: &LogSet, traces: &[Trace]) -> Vec<Course> {
    (0..set.logs.len())
        .map(|log| course(machine, set, traces, log))
        .collect()
}

pub fn course(machine: &Axis, set: &LogSet, traces: &[Trace], log: usize) -> Course {
    let trace = &traces[log];
    let position = trace.position().to_vec();
    let period = set.logs[log].period;
    let effort = of_drive().find_map(|name| trace.channel(name));
    Course {
        time: (0..position.len()).map(|k| k as f64 * period).collect(),
        angle: angles(&position, machine.travel_per_radian()),
        acceleration: slope(&trace.speed, period),
        effort: effort.unwrap_or_default().to_vec(),
        speed: trace.speed.clone(),
        position,
    }
}

/// Angles of the motor within a turn, where the load moves by `travel` a radian.
pub fn angles(positions: &[f64], travel: f64) -> Vec<f64> {
    let radians = 1.0 / travel;
    let turned = positions.iter().map(|x| x * radians);
    turned
        .map(|a| a.rem_euclid(std::f64::consts::TAU))
        .collect()
}

/// Central differences.
pub fn slope(samples: &[f64], period: f64) -> Vec<f64> {
    let last = samples.len().saturating_sub(1);
    let at = |k: usize| {
        let (from, to) = (k.saturating_sub(1), (k + 1).min(last));
        (samples[to] - samples[from]) / (period * (to - from).max(1) as f64)
    };
    (0..samples.len()).map(at).collect()
}
