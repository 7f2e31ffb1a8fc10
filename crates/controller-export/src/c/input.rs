//! What a step is given.

use axis_scalar::Scalar;
use compensator::Sample;

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
    /// Position of the newest set point, as far ahead as the plan needs.
    AheadPosition,
    /// Its velocity.
    AheadVelocity,
    /// Its acceleration.
    AheadAcceleration,
    /// Measured position of the load.
    Position,
    /// Measured speed of the motor.
    MotorSpeed,
    /// Measured q current.
    Current,
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
            Self::AheadPosition => "ahead_position",
            Self::AheadVelocity => "ahead_velocity",
            Self::AheadAcceleration => "ahead_acceleration",
            Self::Position => "position",
            Self::MotorSpeed => "motor_speed",
            Self::Current => "current",
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
            Self::AheadPosition => "@L@: newest set point",
            Self::AheadVelocity => "@L@/s: of the newest set point",
            Self::AheadAcceleration => "@L@/s^2: of the newest set point",
            Self::Position => "@L@: measured position of the load",
            Self::MotorSpeed => "rad/s: measured speed of the motor",
            Self::Current => "A: measured q current; not read if the actuator has none",
            Self::EffortCommand => {
                "@E@: the actuator's command in the cycle before, this correction included"
            }
        }
    }

    /// The same of a sample; the newest set point stands as the next reference.
    pub fn of<T: Scalar>(self, sample: &Sample<T>) -> T {
        let (now, next) = (&sample.reference, &sample.next_reference);
        match self {
            Self::ReferenceVelocity => now.velocity,
            Self::ReferenceAcceleration => now.acceleration,
            Self::NextReferencePosition | Self::AheadPosition => next.position,
            Self::AheadVelocity => next.velocity,
            Self::NextReferenceAcceleration | Self::AheadAcceleration => next.acceleration,
            Self::Position => sample.position,
            Self::MotorSpeed => sample.motor_speed,
            Self::Current => sample.iq,
            Self::EffortCommand => sample.last_command,
        }
    }
}
