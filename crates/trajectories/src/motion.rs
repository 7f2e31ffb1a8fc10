//! What every motion of this crate offers: a duration, and a setpoint at any time.

/// Reference state of an axis at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Position, m.
    pub position: f64,
    /// Velocity, m/s.
    pub velocity: f64,
    /// Acceleration, m/s².
    pub acceleration: f64,
    /// Jerk, m/s³. Where it jumps, the value after the jump.
    pub jerk: f64,
}

impl Setpoint {
    /// Standing still at `position` (m).
    #[inline]
    pub const fn at_rest(position: f64) -> Self {
        Self {
            position,
            velocity: 0.0,
            acceleration: 0.0,
            jerk: 0.0,
        }
    }
}

/// A motion from rest to rest. Object safe.
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
pub trait Motion {
    /// Time from the first to the last instant of the motion, s. Finite and not negative.
    fn duration(&self) -> f64;

    /// Setpoint at time `t` (s) after the start.
    ///
    /// For `t < 0` and for NaN it is rest at the start, for `t >= duration()` rest at the end,
    /// exactly. Any `t` is allowed, in any order; the result depends on `t` alone.
    fn at(&self, t: f64) -> Setpoint;
}

impl<M: Motion + ?Sized> Motion for &M {
    #[inline]
    fn duration(&self) -> f64 {
        (**self).duration()
    }

    #[inline]
    fn at(&self, t: f64) -> Setpoint {
        (**self).at(t)
    }
}

#[cfg(feature = "alloc")]
impl<M: Motion + ?Sized> Motion for alloc::boxed::Box<M> {
    #[inline]
    fn duration(&self) -> f64 {
        (**self).duration()
    }

    #[inline]
    fn at(&self, t: f64) -> Setpoint {
        (**self).at(t)
    }
}
