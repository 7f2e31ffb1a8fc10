//! How far a motion goes in each quantity, for checks against an axis.

use axis_scalar::Scalar;

/// Bounds on a motion over its whole time.
///
/// For S-curves and dwells they are the values reached. For sines and chirps they are safe: never
/// passed, but not all reached; for a sine at most 2 % above what is reached in acceleration and
/// 10 % in jerk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes<T = f64> {
    /// Least position, m.
    pub position_min: T,
    /// Greatest position, m.
    pub position_max: T,
    /// Greatest |velocity|, m/s.
    pub velocity: T,
    /// Greatest |acceleration|, m/s².
    pub acceleration: T,
    /// Greatest |jerk|, m/s³.
    pub jerk: T,
}

impl<T: Scalar> Extremes<T> {
    /// Standing still at `position` (m).
    pub const fn at_rest(position: T) -> Self {
        Self {
            position_min: position,
            position_max: position,
            velocity: T::ZERO,
            acceleration: T::ZERO,
            jerk: T::ZERO,
        }
    }

    /// Bounds that hold for both motions.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            position_min: self.position_min.min(other.position_min),
            position_max: self.position_max.max(other.position_max),
            velocity: self.velocity.max(other.velocity),
            acceleration: self.acceleration.max(other.acceleration),
            jerk: self.jerk.max(other.jerk),
        }
    }
}
