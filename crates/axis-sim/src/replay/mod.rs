//! Replaying a logged reference through the whole closed loop.
//!
//! The reference carries no noise, so nothing that was measured is fed back
//! into the simulation, and its residuals are free of that bias (closed-loop
//! output error: Gautier, Janot, Vandanjon, IEEE Trans. Control Syst. Technol.
//! 21 (2013) 428–444, doi:10.1109/TCST.2012.2185697).

mod curve;
mod error;
mod reference;
mod sampled;
mod smooth;

use std::sync::Arc;

use axis_log::Log;
use compensator::{Compensator, Correction, Sample};
use trajectories::Motion;

use crate::axis::Axis;
use crate::channels::{
    ChannelPart, LogChannel, channels, excitation_in, position_in, position_shown,
};
use crate::effects::{ActiveEffect, Hooks, Steepness};
use crate::plant::Start;
use crate::work::cycles_of;
use crate::{ClosedLoop, Cycle, Measured, SetupError};
pub use curve::SampledCurve;
pub use error::ReplayError;
use error::check_length;
pub use reference::LoggedReference;
use sampled::{Instants, Sampled};

/// Simulated channels at the instants of a log, named as in logs.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Name with unit, samples.
    pub channels: Vec<(&'static str, Vec<f64>)>,
    /// Speed of the load, for looking at residuals; measured in a torque balance.
    pub speed: Vec<f64>,
}

impl Trace {
    /// Position of the load, m or rad.
    pub fn position(&self) -> &[f64] {
        let position = self.channel("position_m").or(self.channel("position_rad"));
        position.unwrap_or_default()
    }

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
    /// Force on the load, N or N·m, against positive motion.
    Load(Arc<[f64]>),
    /// Displacement between motor and load, m or rad.
    Offset(Arc<[f64]>),
}

/// What is stored at a log's start: a state of that log, not of the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Stored {
    /// Nothing: bristles free, the drive holds the axis' own loads, and loads of effects
    /// come up over 20 ms.
    #[default]
    Nothing,
    /// All loads have acted for long. The drive holds what the own loads ask for, the
    /// bristles hold the loads of effects.
    InBristles,
    /// All loads have acted for long, and the drive holds the axis with this command, in
    /// the actuator's unit; the bristles hold what is missing ([`ClosedLoop::holding`]).
    Effort(f64),
    /// All loads have acted for long, and the bristles hold this share, −1 to 1, of what
    /// they can; the drive holds what is missing.
    Share(f64),
}

/// One log's reference, ready to be run through any axis.
#[derive(Clone, Debug)]
pub struct Replay {
    reference: LoggedReference,
    samples: usize,
    /// Position and speed at the log's first samples.
    start: [f64; 2],
    added: Option<Vec<f64>>,
    stored: Stored,
    /// Cycles from one in which all loops of the control ran to the log's first sample.
    ticked: u32,
}

impl Replay {
    /// The reference of a uniformly sampled log.
    ///
    /// Where the load moves at the log's first samples, its position and speed
    /// there are the start of an axis that can begin in motion
    /// ([`Control::starts_in_motion`](crate::control::Control::starts_in_motion)).
    ///
    /// # Errors
    /// [`ReplayError::Log`] if a channel is missing; [`ReplayError::Period`].
    pub fn new(log: &Log, period: f64) -> Result<Self, ReplayError> {
        Self::beginning(log, period, position_in(log)?)
    }

    /// The same for logs of this axis: without a sensor at the load, the motor's angle will do in place of the
    /// load's position ([`position_shown`]).
    ///
    /// # Errors
    /// As [`Replay::new`].
    pub fn of_axis(log: &Log, period: f64, axis: &Axis) -> Result<Self, ReplayError> {
        Self::beginning(log, period, &position_shown(log, axis)?)
    }

    /// Of a log that shows these positions of the load.
    fn beginning(log: &Log, period: f64, position: &[f64]) -> Result<Self, ReplayError> {
        let few = position.len().min(6) - 1;
        let speed = (position[few] - position[0]) / (few.max(1) as f64 * period);
        Ok(Self {
            reference: LoggedReference::new(log, period)?,
            samples: log.len(),
            start: [position[0], speed],
            added: excitation_in(log).map(<[f64]>::to_vec),
            stored: Stored::Nothing,
            ticked: 0,
        })
    }

    /// The same with this stored at its start. An axis that can begin in motion begins as
    /// the log's first samples say, whatever is stored.
    #[must_use]
    pub fn storing(self, stored: Stored) -> Self {
        Self { stored, ..self }
    }

    /// The same where all loops of the control ran so many of its cycles before the log's first sample: of a controller with
    /// slower loops, which no log shows ([`Control::ticks`](crate::control::Control::ticks)).
    #[must_use]
    pub fn ticked(self, cycles: u32) -> Self {
        Self {
            ticked: cycles,
            ..self
        }
    }

    /// Cycles from one in which all loops of the control ran to the log's first sample.
    pub fn ticks(&self) -> u32 {
        self.ticked
    }

    /// What is stored at its start.
    pub fn stored(&self) -> Stored {
        self.stored
    }

    /// The reference.
    pub fn reference(&self) -> &LoggedReference {
        &self.reference
    }

    /// Position and speed at the log's first samples.
    pub fn start(&self) -> [f64; 2] {
        self.start
    }

    /// Runs the reference through the axis, with `effects` beside its own, its sensors
    /// without noise and steps.
    ///
    /// # Errors
    /// [`ReplayError`]: the axis cannot be set up, or its loop does not hold.
    pub fn run(
        &self,
        axis: &Axis,
        effects: &[ActiveEffect],
        probe: Option<&Probe>,
    ) -> Result<Trace, ReplayError> {
        let mut axis = axis.clone();
        axis.effects.extend_from_slice(effects);
        let closed_loop = ClosedLoop::disturbed(&axis, |hooks| {
            if let Some(probe) = probe {
                self.attach(hooks, probe);
            }
        })?;
        self.follow(&closed_loop.without_noise(), |_| ())
    }

    /// Runs the reference through a prepared closed loop; `sense` as in
    /// [`ClosedLoop::run_sensed`].
    ///
    /// # Errors
    /// [`ReplayError::Stopped`] if the loop does not hold;
    /// [`ReplayError::TooLong`] if the log is longer than can be held.
    pub fn follow(
        &self,
        closed_loop: &ClosedLoop,
        sense: impl FnMut(&mut Measured),
    ) -> Result<Trace, ReplayError> {
        let axis = closed_loop.axis();
        let period = axis.period;
        let cycles = cycles_of(self.reference.duration(), period);
        check_length(cycles, closed_loop.steps(&self.reference) / cycles)?;
        let compared = |c: &LogChannel| matches!(c.part, ChannelPart::Sensed | ChannelPart::Made);
        let compared: Vec<LogChannel> = channels(axis).into_iter().filter(compared).collect();
        // A late clock shows the positions of a while ago.
        let (late, timely): (Vec<LogChannel>, Vec<LogChannel>) =
            (compared.iter()).partition(|c| c.name(axis).starts_with("position_"));
        let speed: fn(&Cycle) -> f64 = |c| c.load_speed;
        let sampled = |channels: &[LogChannel], beside: Option<fn(&Cycle) -> f64>, late: f64| {
            let instants = Instants::new([period, self.reference.period()], late, self.samples);
            let reads = channels.iter().map(|c| c.read).chain(beside).collect();
            Sampled::new(reads, instants, cycles as usize)
        };
        let mut positions = sampled(&late, None, closed_loop.clock_offset());
        let mut others = sampled(&timely, Some(speed), 0.0);
        let mut state = closed_loop.start(&self.begin(closed_loop)?)?;
        closed_loop.begin_after(&mut state, self.ticked);
        let mut added = Added {
            replay: self,
            period,
            cycle: 0,
        };
        let reference = self.reference.ahead_by(closed_loop.reference_delay());
        closed_loop
            .run_from(&mut state, &reference, &mut added, sense, |c| {
                positions.take(c);
                others.take(c);
            })
            .completed()?;
        let named = |channels: Vec<LogChannel>, columns: Vec<Vec<f64>>| {
            let names = channels.into_iter().map(|c| c.name(axis));
            names.zip(columns).collect::<Vec<_>>()
        };
        let mut others = others.columns();
        let speed = others.pop().unwrap_or_default();
        let mut channels = named(late, positions.columns());
        channels.extend(named(timely, others));
        Ok(Trace { channels, speed })
    }

    /// Where an axis begins: at rest at the reference's start with what is stored there, or,
    /// where nothing that a log does not show decides on how it goes on, in the motion that
    /// the log begins with.
    fn begin(&self, closed_loop: &ClosedLoop) -> Result<Start, SetupError> {
        let [position, speed] = self.start;
        if closed_loop.axis().control.starts_in_motion() {
            return Ok(Start {
                speed,
                ..Start::at(position)
            });
        }
        let position = self.reference.at(0.0).position;
        match self.stored {
            Stored::Nothing => Ok(Start::at(position)),
            Stored::InBristles => closed_loop.holding(position, None),
            Stored::Effort(effort) => closed_loop.holding(position, Some(effort)),
            Stored::Share(friction) => Ok(Start {
                friction,
                held: true,
                ..Start::at(position)
            }),
        }
    }

    fn attach(&self, hooks: &mut Hooks, probe: &Probe) {
        let h = self.reference.period();
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
            Probe::Load(samples) => {
                hooks.load(Steepness::default(), move |t| value(&samples, t.time)[0]);
            }
            Probe::Offset(samples) => hooks.offset(move |s| {
                let [offset, rate] = value(&samples, s.time);
                [offset, rate, 0.0]
            }),
        }
    }
}

/// What the log shows was added to the controller's command.
struct Added<'a> {
    replay: &'a Replay,
    period: f64,
    cycle: usize,
}

impl Compensator for Added<'_> {
    fn reset(&mut self) {
        self.cycle = 0;
    }

    fn correct(&mut self, _: &Sample) -> Correction {
        let Some(added) = &self.replay.added else {
            return Correction::default();
        };
        let at = self.cycle as f64 * self.period / self.replay.reference.period();
        self.cycle += 1;
        Correction {
            position: 0.0,
            command: added.get(at.round() as usize).copied().unwrap_or(0.0),
        }
    }
}
