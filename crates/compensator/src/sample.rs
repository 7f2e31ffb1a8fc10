//! What a controller knows in a cycle, and what it adds.

use axis_scalar::Scalar;

/// The reference motion at one instant. SI units, table side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reference<T = f64> {
    /// Position, m.
    pub position: T,
    /// Velocity, m/s.
    pub velocity: T,
    /// Acceleration, m/s².
    pub acceleration: T,
}

/// What a controller knows at the start of a control cycle. Of a load that turns positions are
/// rad, speeds rad/s; of a motor that moves along a line its "angle" is m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample<T = f64> {
    /// Reference at this instant.
    pub reference: Reference<T>,
    /// Reference one cycle ahead: known, because the motion is planned.
    pub next_reference: Reference<T>,
    /// Measured table position, m.
    pub position: T,
    /// Measured motor angle, rad.
    pub motor_angle: T,
    /// Measured motor speed, rad/s.
    pub motor_speed: T,
    /// Measured q current, A; 0 if the actuator has no measured current.
    pub iq: T,
    /// Command of the cycle before, in the actuator's unit: q current (A), torque (N·m), force
    /// (N) or voltage (V).
    pub last_command: T,
}

/// What is added to the controller in this cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction<T = f64> {
    /// Added to the position error, m or rad.
    pub position: T,
    /// Added to the speed controller's command, in the actuator's unit: A, N·m, N or V.
    pub command: T,
}

impl<T: Scalar> Reference<T> {
    /// Each value rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> Reference<U> {
        Reference {
            position: cast(self.position),
            velocity: cast(self.velocity),
            acceleration: cast(self.acceleration),
        }
    }
}

impl<T: Scalar> Sample<T> {
    /// Each value rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> Sample<U> {
        Sample {
            reference: self.reference.cast(),
            next_reference: self.next_reference.cast(),
            position: cast(self.position),
            motor_angle: cast(self.motor_angle),
            motor_speed: cast(self.motor_speed),
            iq: cast(self.iq),
            last_command: cast(self.last_command),
        }
    }
}

impl<T: Scalar> Correction<T> {
    /// Each value rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> Correction<U> {
        Correction {
            position: cast(self.position),
            command: cast(self.command),
        }
    }
}

fn cast<T: Scalar, U: Scalar>(value: T) -> U {
    U::of(value.to_f64())
}
