//! What every motion of this crate offers: a duration, and a setpoint at any time.

use axis_scalar::Scalar;

/// Reference state of an axis at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint<T = f64> {
    /// Position, m.
    pub position: T,
    /// Velocity, m/s.
    pub velocity: T,
    /// Acceleration, m/s².
    pub acceleration: T,
    /// Jerk, m/s³. Where it jumps, the value after the jump.
    pub jerk: T,
}

impl<T: Scalar> Setpoint<T> {
    /// Standing still at `position` (m).
    #[inline]
    pub const fn at_rest(position: T) -> Self {
        Self {
            position,
            velocity: T::ZERO,
            acceleration: T::ZERO,
            jerk: T::ZERO,
        }
    }
}

/// A motion, from standstill to standstill except for those of [`Transfer`](crate::Transfer) and
/// [`VelocityChange`](crate::VelocityChange), which may start and end in motion. Object safe.
///
/// `T` is the scalar that it computes in: `f64` where none is named, as in `dyn Motion`, or `f32`.
///
/// ```
/// use trajectories::{Limits, Motion, SCurve};
///
/// let curve = SCurve::plan(0.0, 0.1, &Limits::new(0.1, 1.0, 10.0)?)?;
/// let motion: &dyn Motion = &curve;
/// assert_eq!(motion.at(-1.0).position, 0.0);
/// assert_eq!(motion.at(1e9).position, 0.1);
/// # Ok::<(), trajectories::TrajectoryError>(())
/// ```
pub trait Motion<T = f64> {
    /// Time from the first to the last instant of the motion, s. Finite and not negative.
    fn duration(&self) -> T;

    /// Setpoint at time `t` (s) after the start.
    ///
    /// For `t < 0` and for NaN it is the start, for `t = duration()` the end, exactly. After that it is the end
    /// too; a motion that ends with a velocity goes on with it, without acceleration. Any `t` is allowed, in any order; the result depends on `t` alone.
    fn at(&self, t: T) -> Setpoint<T>;
}

impl<T, M: Motion<T> + ?Sized> Motion<T> for &M {
    #[inline]
    fn duration(&self) -> T {
        (**self).duration()
    }

    #[inline]
    fn at(&self, t: T) -> Setpoint<T> {
        (**self).at(t)
    }
}

#[cfg(feature = "alloc")]
impl<T, M: Motion<T> + ?Sized> Motion<T> for alloc::boxed::Box<M> {
    #[inline]
    fn duration(&self) -> T {
        (**self).duration()
    }

    #[inline]
    fn at(&self, t: T) -> Setpoint<T> {
        (**self).at(t)
    }
}
