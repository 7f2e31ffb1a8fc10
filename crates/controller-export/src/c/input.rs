//! What a step is given.

use compensator::Sample;
use scalar::Scalar;

/// A member of the input of a step. Only those that a strategy reads are in its struct.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Input {
    /// Reference velocity at this instant.
    ReferenceVelocity,
    /// Reference acceleration at this instant.
    ReferenceAcceleration,
    /// Reference position one cycle ahead.
    NextReferencePosition,
    /// Reference acceleration one cycle ahead.
    NextReferenceAcceleration,
    /// Measured position of the load.
    Position,
    /// Measured speed of the motor.
    MotorSpeed,
    /// Command of the cycle before.
    EffortCommand,
}

impl Input {
    /// Its name in C.
    pub fn name(self) -> &'static str {
        match self {
            Self::ReferenceVelocity => "reference_velocity",
            Self::ReferenceAcceleration => "reference_acceleration",
            Self::NextReferencePosition => "next_reference_position",
            Self::NextReferenceAcceleration => "next_reference_acceleration",
            Self::Position => "position",
            Self::MotorSpeed => "motor_speed",
            Self::EffortCommand => "effort_command",
        }
    }

    /// Unit and meaning, with `@L@` for the load's unit and `@E@` for the command's.
    pub(super) fn meaning(self) -> &'static str {
        match self {
            Self::ReferenceVelocity => "@L@/s: reference at this instant",
            Self::ReferenceAcceleration => "@L@/s^2: reference at this instant",
            Self::NextReferencePosition => "@L@: reference one cycle ahead",
            Self::NextReferenceAcceleration => "@L@/s^2: reference one cycle ahead",
            Self::Position => "@L@: measured position of the load",
            Self::MotorSpeed => "rad/s: measured speed of the motor",
            Self::EffortCommand => {
                "@E@: what the actuator was commanded in the cycle before, this correction included"
            }
        }
    }

    /// The same of a sample.
    pub fn of<T: Scalar>(self, sample: &Sample<T>) -> T {
        match self {
            Self::ReferenceVelocity => sample.reference.velocity,
            Self::ReferenceAcceleration => sample.reference.acceleration,
            Self::NextReferencePosition => sample.next_reference.position,
            Self::NextReferenceAcceleration => sample.next_reference.acceleration,
            Self::Position => sample.position,
            Self::MotorSpeed => sample.motor_speed,
            Self::EffortCommand => sample.iq_command,
        }
    }
}
