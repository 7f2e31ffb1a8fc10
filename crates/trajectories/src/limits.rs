//! The three bounds a move must obey.

use crate::error::check;
use crate::{TrajectoryError, maximum};

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
    /// [`TrajectoryError::Invalid`] for a value that is not greater than zero, or lies above that
    /// of [`maximum`].
    pub fn new(velocity: f64, acceleration: f64, jerk: f64) -> Result<Self, TrajectoryError> {
        let (v, a, j) = (velocity, acceleration, jerk);
        let inside = |value: f64, most: f64| value > 0.0 && value <= most;
        Ok(Self {
            velocity: check(
                inside(v, maximum::VELOCITY),
                "velocity",
                v,
                "m/s",
                "greater than zero and at most 1e6",
            )?,
            acceleration: check(
                inside(a, maximum::ACCELERATION),
                "acceleration",
                a,
                "m/s²",
                "greater than zero and at most 1e9",
            )?,
            jerk: check(
                inside(j, maximum::JERK),
                "jerk",
                j,
                "m/s³",
                "greater than zero and at most 1e15",
            )?,
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
