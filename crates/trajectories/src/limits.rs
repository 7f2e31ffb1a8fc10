//! The three bounds a move must obey.

use axis_scalar::Scalar;

use crate::error::check;
use crate::{TrajectoryError, maximum};

/// Symmetric limits of a move: each holds for both signs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<T = f64> {
    velocity: T,
    acceleration: T,
    jerk: T,
}

impl<T: Scalar> Limits<T> {
    /// Limits on |velocity| (m/s), |acceleration| (m/s²) and |jerk| (m/s³).
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] for a value that is not greater than zero, or lies above that
    /// of [`maximum`].
    pub fn new(velocity: T, acceleration: T, jerk: T) -> Result<Self, TrajectoryError> {
        let (v, a, j) = (velocity, acceleration, jerk);
        let inside = |value: T, most: f64| value > T::ZERO && value <= T::of(most);
        Ok(Self {
            velocity: check(
                inside(v, maximum::VELOCITY),
                "velocity",
                v,
                "m/s",
                "greater than zero and at most 1e9",
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

    /// The same limits, each rounded to the nearest number of another scalar.
    ///
    /// # Errors
    /// As [`new`](Self::new), where one rounds to zero.
    pub fn cast<U: Scalar>(&self) -> Result<Limits<U>, TrajectoryError> {
        let cast = |value: T| U::of(value.to_f64());
        Limits::new(
            cast(self.velocity),
            cast(self.acceleration),
            cast(self.jerk),
        )
    }

    /// Greatest |velocity| allowed, m/s.
    #[inline]
    pub const fn velocity(&self) -> T {
        self.velocity
    }

    /// Greatest |acceleration| allowed, m/s².
    #[inline]
    pub const fn acceleration(&self) -> T {
        self.acceleration
    }

    /// Greatest |jerk| allowed, m/s³.
    #[inline]
    pub const fn jerk(&self) -> T {
        self.jerk
    }
}
