//! Replaying a logged reference through the whole closed loop.
//!
//! The reference carries no noise, so nothing that was measured is fed back
//! into the simulation, and its residuals are free of that bias (closed-loop
//! output error: Gautier, Janot, Vandanjon, IEEE Trans. Control Syst. Technol.
//! 21 (2013) 428–444, doi:10.1109/TCST.2012.2185697).

mod error;
mod reference;

use std::sync::Arc;

use axis_log::Log;
use compensator::NoCompensation;
use trajectories::Motion;

use crate::effects::{ActiveEffect, Hooks, Machine};
use crate::rigid::{RigidCycle, Start};
use crate::work::{check_period, cycles_of, substeps_of};
use crate::{ClosedLoop, Cycle, Measured, RigidAxis};
pub use error::ReplayError;
use error::check_length;
pub use reference::LoggedReference;

/// Simulated channels at the instants of a log, named as in logs.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Name with unit, samples.
    pub channels: Vec<(&'static str, Vec<f64>)>,
    /// Table speed, m/s, for looking at residuals.
    pub speed: Vec<f64>,
}

impl Trace {
    /// The samples of a channel.
    pub fn channel(&self, name: &str) -> Option<&[f64]> {
        let found = self.channels.iter().find(|(n, _)| *n == name);
        found.map(|(_, samples)| samples.as_slice())
    }
}

/// A disturbance given in time, for asking how the loop answers to it: one
/// sample per sampling period of the log, linear between.
#[derive(Clone, Debug)]
pub enum Probe {
    /// Force on the table, N, against positive motion.
    Load(Arc<[f64]>),
    /// Displacement between screw and table, m.
    Offset(Arc<[f64]>),
}

/// One log's reference, ready to be run through any machine.
#[derive(Clone, Debug)]
pub struct Replay {
    reference: LoggedReference,
    samples: usize,
    start: Start,
    added: Option<Vec<f64>>,
}

/// Column of a log: a reading of the sensors, or of the command.
type Column = (&'static str, fn(&Cycle) -> f64);

const COLUMNS: [Column; 6] = [
    ("position_m", |c| c.measured.position),
    ("motor_angle_rad", |c| c.measured.motor_angle),
    ("iq_ref_a", |c| c.command.iq_ref),
    ("iq_a", |c| c.measured.current.q),
    ("ud_v", |c| c.command.voltage.d),
    ("uq_v", |c| c.command.voltage.q),
];

impl Replay {
    /// The reference of a uniformly sampled log.
    ///
    /// Where the table moves at the log's first samples, its position and speed
    /// there are the start of a rigid machine.
    ///
    /// # Errors
    /// [`ReplayError::Log`] where a channel is missing; [`ReplayError::Period`].
    pub fn new(log: &Log, period: f64) -> Result<Self, ReplayError> {
        let position = log.channel("position_m")?;
        let few = position.len().min(6) - 1;
        let start = Start {
            position: position[0],
            speed: (position[few] - position[0]) / (few.max(1) as f64 * period),
        };
        Ok(Self {
            reference: LoggedReference::new(log, period)?,
            samples: log.len(),
            start,
            added: log
                .channel("drive_command_added_v")
                .ok()
                .map(<[f64]>::to_vec),
        })
    }

    /// The reference.
    pub fn reference(&self) -> &LoggedReference {
        &self.reference
    }

    /// Where a rigid machine starts.
    pub fn start(&self) -> Start {
        self.start
    }

    /// Runs the reference through the machine, with `effects` beside its own.
    ///
    /// # Errors
    /// [`ReplayError`]: the machine cannot be set up, or its loop does not hold.
    pub fn run(
        &self,
        machine: &Machine,
        effects: &[ActiveEffect],
        probe: Option<&Probe>,
    ) -> Result<Trace, ReplayError> {
        match machine {
            Machine::BallScrew(axis) => {
                let mut axis = (**axis).clone();
                axis.effects.extend_from_slice(effects);
                let mut closed_loop = ClosedLoop::new(&axis)?;
                if let Some(probe) = probe {
                    closed_loop.add(|hooks| self.attach(hooks, probe));
                }
                self.follow(&closed_loop, |_| ())
            }
            Machine::Rigid(axis) => {
                let mut axis = (**axis).clone();
                axis.effects.extend_from_slice(effects);
                let (axis, mut hooks) = axis.with_effects()?;
                if let Some(probe) = probe {
                    self.attach(&mut hooks, probe);
                }
                self.follow_rigid(&axis, &hooks)
            }
        }
    }

    fn follow_rigid(&self, axis: &RigidAxis, hooks: &Hooks) -> Result<Trace, ReplayError> {
        check_period(axis.period)?;
        let cycles = cycles_of(self.reference.duration(), axis.period);
        check_length(cycles, substeps_of(axis.period, axis.step))?;
        let added = |k: usize| {
            let at = k as f64 * axis.period / self.reference.period;
            let added = self.added.as_ref();
            added
                .and_then(|a| a.get(at.round() as usize))
                .copied()
                .unwrap_or(0.0)
        };
        let log = axis
            .follow(hooks, &self.reference, self.start, cycles as usize, added)
            .map_err(|halt| match halt.position + halt.speed + halt.residual {
                state if state.is_finite() => ReplayError::LoadNotFound {
                    time: halt.time,
                    position: halt.position,
                    speed: halt.speed,
                },
                _ => ReplayError::Diverged { time: halt.time },
            })?;
        self.check_held(axis, &log)?;
        let position: Vec<f64> = log.iter().map(|c| c.position).collect();
        let command: Vec<f64> = log.iter().map(|c| c.command).collect();
        let position = self.resample(position, axis.period, 0.0);
        Ok(Trace {
            speed: self.differences(&position),
            channels: vec![
                ("position_m", position),
                ("drive_command_v", self.resample(command, axis.period, 0.0)),
            ],
        })
    }

    /// Whether the loop held the reference: in numbers, and within its limit.
    fn check_held(&self, axis: &RigidAxis, log: &[RigidCycle]) -> Result<(), ReplayError> {
        for (k, cycle) in log.iter().enumerate() {
            let time = k as f64 * axis.period;
            if !(cycle.position + cycle.command).is_finite() {
                return Err(ReplayError::Diverged { time });
            }
            let Some(limit) = axis.following_error_limit else {
                continue;
            };
            let error = self.reference.at(time).position - cycle.position;
            if error.abs() > limit {
                return Err(ReplayError::FollowingError { time, error, limit });
            }
        }
        Ok(())
    }

    /// Runs the reference through a prepared closed loop; `sense` as in
    /// [`ClosedLoop::run_sensed`].
    ///
    /// # Errors
    /// [`ReplayError::Stopped`] where the loop does not hold;
    /// [`ReplayError::TooLong`] where the log is longer than can be held.
    pub fn follow(
        &self,
        closed_loop: &ClosedLoop,
        sense: impl FnMut(&mut Measured),
    ) -> Result<Trace, ReplayError> {
        let period = closed_loop.axis().period;
        let cycles = cycles_of(self.reference.duration(), period);
        check_length(cycles, closed_loop.steps(&self.reference) / cycles)?;
        let cycles = cycles as usize;
        let mut columns: [Vec<f64>; COLUMNS.len()] =
            std::array::from_fn(|_| Vec::with_capacity(cycles));
        let mut speed: Vec<f64> = Vec::with_capacity(cycles);
        closed_loop
            .run_sensed(&self.reference, &mut NoCompensation, sense, |c| {
                for (column, (_, read)) in columns.iter_mut().zip(&COLUMNS) {
                    column.push(read(c));
                }
                speed.push(c.table_speed);
            })
            .completed()?;
        let late = closed_loop.clock_offset();
        let channel = |((name, _), samples): (&Column, Vec<f64>)| {
            let by = if *name == "position_m" { late } else { 0.0 };
            (*name, self.resample(samples, period, by))
        };
        Ok(Trace {
            channels: COLUMNS.iter().zip(columns).map(channel).collect(),
            speed: self.resample(speed, period, 0.0),
        })
    }

    /// Samples at the log's instants of what was recorded every `period`, late by `by`.
    fn resample(&self, mut samples: Vec<f64>, period: f64, by: f64) -> Vec<f64> {
        if by == 0.0 && period == self.reference.period && samples.len() >= self.samples {
            samples.truncate(self.samples);
            return samples;
        }
        let last = (samples.len() - 1) as f64;
        let at = |k: usize| {
            let along = ((k as f64 * self.reference.period - by) / period).clamp(0.0, last);
            let near = along.round();
            if (along - near).abs() < 1e-6 {
                return samples[near as usize];
            }
            let i = along as usize;
            let part = along - i as f64;
            let next = samples[(i + 1).min(samples.len() - 1)];
            (1.0 - part) * samples[i] + part * next
        };
        (0..self.samples).map(at).collect()
    }

    fn differences(&self, position: &[f64]) -> Vec<f64> {
        let last = position.len() - 1;
        let at = |k: usize| {
            let (a, b) = (k.saturating_sub(1), (k + 1).min(last));
            (position[b] - position[a]) / (self.reference.period * (b - a).max(1) as f64)
        };
        (0..=last).map(at).collect()
    }

    fn attach(&self, hooks: &mut Hooks, probe: &Probe) {
        let h = self.reference.period;
        let value = move |samples: &[f64], t: f64| {
            let Some(last) = samples.len().checked_sub(1) else {
                return [0.0; 2];
            };
            let along = (t / h).clamp(0.0, last as f64);
            let i = (along as usize).min(last.saturating_sub(1));
            let next = samples[(i + 1).min(last)];
            [
                samples[i] + (along - i as f64) * (next - samples[i]),
                (next - samples[i]) / h,
            ]
        };
        match probe.clone() {
            Probe::Load(samples) => hooks.load(move |t| value(&samples, t.time)[0]),
            Probe::Offset(samples) => hooks.offset(move |s| value(&samples, s.time)),
        }
    }
}
