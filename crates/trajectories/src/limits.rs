//! The three bounds a move must obey.

use crate::TrajectoryError;
use crate::error::positive;

/// Symmetric limits of a move: each holds for both signs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    velocity: f64,
    acceleration: f64,
    jerk: f64,
}

impl Limits {
    /// Limits on |velocity| (m/s), |acceleration| (m/s²) and |jerk| (m/s³).
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] for a value that is not finite and greater than zero.
    pub fn new(velocity: f64, acceleration: f64, jerk: f64) -> Result<Self, TrajectoryError> {
        Ok(Self {
            velocity: positive("velocity", velocity, "m/s")?,
            acceleration: positive("acceleration", acceleration, "m/s²")?,
            jerk: positive("jerk", jerk, "m/s³")?,
        })
    }

    /// Greatest |velocity| allowed, m/s.
    #[inline]
    pub const fn velocity(&self) -> f64 {
        self.velocity
    }

    /// Greatest |acceleration| allowed, m/s².
    #[inline]
    pub const fn acceleration(&self) -> f64 {
        self.acceleration
    }

    /// Greatest |jerk| allowed, m/s³.
    #[inline]
    pub const fn jerk(&self) -> f64 {
        self.jerk
    }
}
