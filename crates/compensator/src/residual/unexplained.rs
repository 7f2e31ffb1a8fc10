//! What a residual is learned from.

/// What the model did not explain at an instant of a log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unexplained {
    /// Position of the load, m or rad.
    pub position: f64,
    /// Angle of the motor, rad.
    pub motor_angle: f64,
    /// Its speed, rad/s.
    pub motor_speed: f64,
    /// Share of the Coulomb level that the bristles hold, −1 to 1.
    pub direction: f64,
    /// Torque at the motor that was needed besides, N·m, smoothed by a Gaussian.
    pub torque: f64,
}
