//! The machine alone between two communication steps.

use std::sync::Arc;

use axis_sim::actuator::{Actuating, MotorMotion};
use axis_sim::plant::{AdvanceError, Running, Seen};
use axis_sim::{Axis, ClosedLoop, Measured, RunStopped, Start, Stop, StopReason};

use crate::error::UnitError;
use crate::given::Inputs;
use crate::outputs::{Output, Source};
use crate::paced::SAME_POINT;
use crate::simulated::Simulation;

/// The machine of an axis under a motor torque that is held between two points of communication.
#[derive(Debug)]
pub(crate) struct PlantRun {
    axis: Arc<Axis>,
    machine: Box<dyn Running>,
    /// Control periods that were made whole.
    whole: u64,
    /// Sum of those that were made in part.
    parts: f64,
    /// What rounding of times has left to be made, in periods.
    owed: f64,
}

impl Clone for PlantRun {
    fn clone(&self) -> Self {
        Self {
            axis: self.axis.clone(),
            machine: self.machine.copy(),
            ..*self
        }
    }
}

/// A motor whose torque is given: N·m at the end of each internal step, to which the machine goes
/// on a straight line.
#[derive(Clone, Debug)]
struct Held(f64);

impl Actuating for Held {
    fn settle(&mut self, torque: f64, _: f64) -> f64 {
        self.0 = torque;
        torque
    }

    fn command(&mut self, torque: f64, _: &Measured) {
        self.0 = torque;
    }

    fn torque(&mut self, _: &MotorMotion, _: f64) -> f64 {
        self.0
    }

    fn copy(&self) -> Box<dyn Actuating> {
        Box::new(self.clone())
    }
}

impl PlantRun {
    /// At rest at the reference's position, under the loads that the axis has there and the torque
    /// that holds them.
    pub fn begin(axis: &Axis, [given, ..]: &Inputs) -> Result<Self, UnitError> {
        let closed_loop = ClosedLoop::new(axis)?;
        let state = closed_loop.start(&Start::at(given.reference.position))?;
        Ok(Self {
            machine: state.plant().copy(),
            axis: Arc::new(closed_loop.axis().clone()),
            whole: 0,
            parts: 0.0,
            owed: 0.0,
        })
    }

    fn seen(&self) -> &Seen {
        self.machine.seen()
    }

    /// Whether the run can go on, by what the closed loop looks at, too.
    fn check(&self, ran: Result<(), AdvanceError>) -> Result<(), UnitError> {
        let (axis, seen) = (&self.axis, self.seen());
        let mut stroke = [axis.stroke.minimum, axis.stroke.maximum];
        if let Some(reach) = axis.mechanism.reach() {
            stroke = [stroke[0].max(reach.least), stroke[1].min(reach.most)];
        }
        let is_finite = (seen.position + seen.motor_speed).is_finite();
        let reason = match ran {
            _ if !is_finite => StopReason::NotFinite,
            Err(AdvanceError::LoadNotFound { .. }) => StopReason::LoadNotFound,
            Err(_) => StopReason::NotFinite,
            Ok(()) if !(stroke[0]..=stroke[1]).contains(&seen.position) => StopReason::LeftStroke,
            Ok(()) => return Ok(()),
        };
        Err(UnitError::Stopped(RunStopped {
            time: seen.time,
            reason,
            at: Stop {
                position: seen.position,
                error: 0.0,
                motor_speed: seen.motor_speed,
                torque: seen.torque,
                freedom: axis.freedom(),
                motor: axis.mechanism.motor_freedom(),
                stroke,
            },
        }))
    }
}

impl Simulation for PlantRun {
    fn periods(&self) -> f64 {
        self.whole as f64 + (self.parts + self.owed)
    }

    /// Where `periods` is no whole number, the last step is shorter, and the next begins where it ended.
    fn run_on(&mut self, periods: f64, [given, ..]: &Inputs, _: bool) -> Result<(), UnitError> {
        let mut motor = Held(given.motor_torque(&self.axis));
        self.machine.set_outer_load(given.load);
        let target = self.owed + periods;
        let whole = (target + SAME_POINT).floor();
        for _ in 0..whole as u64 {
            let ran = self.machine.advance(&mut motor);
            self.check(ran)?;
            self.whole += 1;
        }
        self.owed = target - whole;
        if self.owed > SAME_POINT {
            let ran = self.machine.advance_part(self.owed, &mut motor);
            self.check(ran)?;
            self.parts += self.owed;
            self.owed = 0.0;
        }
        Ok(())
    }

    fn read(&self, output: &Output) -> f64 {
        match output.source {
            Source::Machine(read, times) => times * read(self.seen()),
            Source::Current(_) | Source::Drive(_) | Source::Tool => f64::NAN,
        }
    }

    fn copy(&self) -> Box<dyn Simulation> {
        Box::new(self.clone())
    }
}
