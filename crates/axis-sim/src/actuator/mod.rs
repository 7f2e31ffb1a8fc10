//! Actuators: what makes a torque of the controller's command.

mod current_loop;
mod delay;
mod field_oriented;
mod force_gain;
mod late_voltage;
mod torque_source;

use std::fmt;

use compensator::Drive;
use foc_pmsm::Dq;

use crate::cycle::Measured;
use crate::part::{PartError, PartKind, Values};

/// All kinds of actuator, one line each.
pub const ACTUATORS: &[&PartKind<dyn Actuator>] = &[
    &field_oriented::ROTARY,
    &field_oriented::LINEAR,
    &torque_source::ROTARY,
    &torque_source::LINEAR,
    &force_gain::KIND,
];

/// In what an actuator takes its command: the unit that the gains of a speed
/// controller end in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Current, A.
    Current,
    /// Torque, N·m.
    Torque,
    /// Force, N.
    Force,
    /// Voltage of a drive command, V.
    Voltage,
}

impl Effort {
    /// The effort that the unit of a gain begins with (`a_per_rpm`, `n_m_s_per_rad`), where
    /// it is one.
    pub fn of_gain(unit: &str) -> Option<Self> {
        if unit.starts_with("a_") {
            Some(Self::Current)
        } else if unit.starts_with("n_m_") {
            Some(Self::Torque)
        } else if unit.starts_with("n_") {
            Some(Self::Force)
        } else if unit.starts_with("v_") {
            Some(Self::Voltage)
        } else {
            None
        }
    }

    /// Its SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Current => "A",
            Self::Torque => "N·m",
            Self::Force => "N",
            Self::Voltage => "V",
        }
    }
}

/// What an actuator and a control are told of the axis that they are on.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings {
    /// Control period, s.
    pub period: f64,
    /// Travel of the load per radian of the motor, m/rad or rad/rad.
    pub travel_per_radian: f64,
}

/// The motor's motion in a step.
#[derive(Clone, Copy, Debug)]
pub struct MotorMotion {
    /// Angle at its start, rad.
    pub angle: f64,
    /// Mean speed, rad/s.
    pub speed: f64,
}

/// Currents and voltages of an actuator that has some.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Electrical {
    /// Currents, A.
    pub current: Dq,
    /// Voltages that its controllers ask for in this cycle, V; they act as late as the
    /// actuator says.
    pub voltage: Dq,
    /// Whether the voltage is at its limit.
    pub saturated: bool,
}

/// An actuator, immutable.
pub trait Actuator: fmt::Debug + Send + Sync {
    /// In what it takes its command.
    fn effort(&self) -> Effort;

    /// Greatest command that it takes.
    fn limit(&self) -> f64;

    /// Torque per command at rest, where the load moves by `travel` a radian:
    /// N·m per unit of effort.
    fn torque_constant(&self, travel: f64) -> f64;

    /// Whether it has currents and voltages to log.
    fn has_currents(&self) -> bool {
        false
    }

    /// Voltage per current, as its d controller answers at once: the way by which noise of
    /// the current comes into the voltage. None if it has no current controllers.
    fn current_gain(&self) -> Option<f64> {
        None
    }

    /// Electrical periods per radian of the motor, where its torque ripples with them.
    fn pole_pairs(&self) -> Option<f64> {
        None
    }

    /// It as a feed-forward inverts it, where the load moves by `travel` a radian, and the
    /// time by which its command comes late, s.
    fn inverse(&self, travel: f64) -> (Drive, f64) {
        let lag = Drive::Lag {
            gain: self.torque_constant(travel),
            bandwidth: f64::INFINITY,
        };
        (lag, 0.0)
    }

    /// The values of an actuator of this kind whose current controllers follow the magnitude
    /// optimum where they run once in each `period` (s), all else as in `values`, those that it is
    /// made from. None where it has no current controllers.
    fn with_magnitude_optimum(&self, _values: &Values, _period: f64) -> Option<Values> {
        None
    }

    /// Whether its own controllers are stable where they run once in each period, s.
    ///
    /// # Errors
    /// [`PartError`] if a gain is too high for so slow a controller.
    fn runs_at(&self, _: f64) -> Result<(), PartError> {
        Ok(())
    }

    /// An actuator at rest, without a command.
    ///
    /// # Errors
    /// [`PartError`] if it does not fit its surroundings.
    fn start(&self, on: &Surroundings) -> Result<Box<dyn Actuating>, PartError>;
}

/// An actuator at work.
pub trait Actuating: fmt::Debug + Send + Sync {
    /// Brings it into the state in which it gives `torque` (N·m) at the motor speed
    /// `speed` (rad/s); the command that holds it there.
    fn settle(&mut self, torque: f64, speed: f64) -> f64;

    /// Greatest command that it takes in the coming cycle: less than [`Actuator::limit`] if a
    /// part of that is taken for something else. A control that is told keeps its integral
    /// from winding up. Infinite: that limit alone.
    fn available(&self) -> f64 {
        f64::INFINITY
    }

    /// Takes the command of a cycle, with what the sensors show at its start; of one beyond
    /// what it takes, as much as it does.
    fn command(&mut self, effort: f64, measured: &Measured);

    /// Torque at the end of a step of `h` seconds, N·m.
    fn torque(&mut self, motor: &MotorMotion, h: f64) -> f64;

    /// Its currents and voltages now; zero where it has none.
    fn electrical(&self) -> Electrical {
        Electrical::default()
    }

    /// A copy.
    fn copy(&self) -> Box<dyn Actuating>;
}
