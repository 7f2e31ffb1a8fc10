//! Limits of a transfer.

use crate::error::check;
use crate::{Limits, Real, TrajectoryError, VelocityLimits, maximum};

/// Limits of a [`Transfer`](crate::Transfer): a velocity and an acceleration for each sign, and the jerk.
///
/// ```
/// use trajectories::{TransferLimits, VelocityLimits};
///
/// // Down faster than up; brakes harder than it speeds up.
/// let acceleration = VelocityLimits::<f64>::new(-4.0, 2.0, 40.0)?; // m/s², m/s², m/s³
/// let limits = TransferLimits::new(-1.0, 0.5, acceleration)?; // m/s
/// assert_eq!(limits.velocity_max(), 0.5);
/// # Ok::<(), trajectories::TrajectoryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferLimits<T = f64> {
    pub(super) back: T,
    pub(super) fast: T,
    pub(super) change: VelocityLimits<T>,
}

impl<T: Real> TransferLimits<T> {
    /// Least velocity (below zero) and greatest (above zero), m/s, and what limits their change.
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] for a value of the wrong sign, zero, NaN, or beyond that of
    /// [`maximum`].
    pub fn new(
        velocity_min: T,
        velocity_max: T,
        change: VelocityLimits<T>,
    ) -> Result<Self, TrajectoryError> {
        let most = T::of(maximum::VELOCITY);
        let back = check(
            velocity_min < T::ZERO && velocity_min >= -most,
            "velocity_min",
            velocity_min,
            "m/s",
            "less than zero and at least -1e9",
        )?;
        let fast = check(
            velocity_max > T::ZERO && velocity_max <= most,
            "velocity_max",
            velocity_max,
            "m/s",
            "greater than zero and at most 1e9",
        )?;
        Ok(Self { back, fast, change })
    }

    /// Least velocity allowed, m/s; below zero.
    #[inline]
    pub const fn velocity_min(&self) -> T {
        self.back
    }

    /// Greatest velocity allowed, m/s.
    #[inline]
    pub const fn velocity_max(&self) -> T {
        self.fast
    }

    /// Limits of acceleration and jerk.
    #[inline]
    pub const fn change(&self) -> &VelocityLimits<T> {
        &self.change
    }
}

impl<T: Real> From<Limits<T>> for TransferLimits<T> {
    fn from(limits: Limits<T>) -> Self {
        let (v, a) = (limits.velocity(), limits.acceleration());
        Self {
            back: -v,
            fast: v,
            change: VelocityLimits::symmetric(a, limits.jerk()),
        }
    }
}
