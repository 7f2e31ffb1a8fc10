//! What an axis file's `[rating]` says.

use crate::part::Values;

/// A point of the motor's curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorPoint {
    /// Speed, rad/s or m/s.
    pub speed: f64,
    /// Continuous torque there, N·m or N.
    pub continuous: Option<f64>,
    /// Peak torque there.
    pub peak: Option<f64>,
}

/// What the file's `[rating]` says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DataSheets {
    /// Its keys, SI units.
    pub values: Values,
    /// Its `[[rating.motor_curve]]`, in their order.
    pub motor_curve: Vec<MotorPoint>,
    /// How many keys it states, points of the curves not counted.
    pub stated: usize,
}
