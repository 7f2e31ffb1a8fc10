//! From any state in motion to a velocity: stop, speed up, slow down.

use crate::constant_jerk::after;
use crate::error::{check, planned, position, unrepresentable};
use crate::{Motion, Real, Setpoint, TrajectoryError, maximum};

/// Limits of a [`VelocityChange`]: one for each sign of the acceleration, and the jerk.
///
/// For a stop from a positive velocity the least acceleration is the braking limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityLimits<T = f64> {
    least: T,
    greatest: T,
    jerk: T,
}

impl<T: Real> VelocityLimits<T> {
    /// Least acceleration (below zero) and greatest (above zero), m/s², and limit on |jerk|, m/s³.
    ///
    /// An infinite jerk is allowed: the acceleration then jumps, and velocity is a trapezoid's.
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] for a value of the wrong sign, zero, NaN, or beyond that of
    /// [`maximum`].
    pub fn new(acceleration_min: T, acceleration_max: T, jerk: T) -> Result<Self, TrajectoryError> {
        let most = T::of(maximum::ACCELERATION);
        Ok(Self {
            least: check(
                acceleration_min < T::ZERO && acceleration_min >= -most,
                "acceleration_min",
                acceleration_min,
                "m/s²",
                "less than zero and at least -1e9",
            )?,
            greatest: check(
                acceleration_max > T::ZERO && acceleration_max <= most,
                "acceleration_max",
                acceleration_max,
                "m/s²",
                "greater than zero and at most 1e9",
            )?,
            jerk: check(
                jerk > T::ZERO && (jerk <= T::of(maximum::JERK) || jerk == T::of(f64::INFINITY)),
                "jerk",
                jerk,
                "m/s³",
                "greater than zero and at most 1e15, or infinite",
            )?,
        })
    }

    /// The same for both signs, of values that are known to be valid.
    pub(crate) fn symmetric(acceleration: T, jerk: T) -> Self {
        Self {
            least: -acceleration,
            greatest: acceleration,
            jerk,
        }
    }

    /// Least acceleration allowed, m/s²; below zero.
    #[inline]
    pub const fn acceleration_min(&self) -> T {
        self.least
    }

    /// Greatest acceleration allowed, m/s².
    #[inline]
    pub const fn acceleration_max(&self) -> T {
        self.greatest
    }

    /// Greatest |jerk| allowed, m/s³; may be infinite.
    #[inline]
    pub const fn jerk(&self) -> T {
        self.jerk
    }
}

/// A stretch of constant jerk, from a known state.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece<T> {
    begin: T,
    state: Setpoint<T>,
    /// Acceleration at its end, m/s².
    last: T,
}

/// Change of velocity in least time, from any position, velocity and acceleration to a given
/// velocity with no acceleration. It allocates nothing, and may be planned anew in every cycle.
///
/// The acceleration never passes its limits. If it is beyond one at the start, it is brought
/// back at full jerk first. The velocity has no limit of its own: it passes the wanted one only
/// if the acceleration at the start cannot be taken back in time.
///
/// ```
/// use trajectories::{Setpoint, VelocityChange, VelocityLimits};
///
/// // Brakes harder (4 m/s²) than it speeds up (2 m/s²).
/// let limits = VelocityLimits::<f64>::new(-4.0, 2.0, 40.0)?;
/// let start = Setpoint { position: 1.0, velocity: 0.8, ..Setpoint::default() };
/// let stop = VelocityChange::stop(&start, &limits)?;
/// assert!((stop.duration() - (0.8 / 4.0 + 4.0 / 40.0)).abs() < 1e-15);
/// assert!((stop.end().position - (1.0 + 0.5 * 0.8 * stop.duration())).abs() < 1e-15);
/// # Ok::<(), trajectories::TrajectoryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityChange<T = f64> {
    /// Brought back to a limit, towards the peak, at the peak, back to zero.
    pieces: [Piece<T>; 4],
    start: Setpoint<T>,
    duration: T,
    end: Setpoint<T>,
}

impl<T: Real> VelocityChange<T> {
    /// To standstill in least time.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    #[inline]
    pub fn stop(start: &Setpoint<T>, limits: &VelocityLimits<T>) -> Result<Self, TrajectoryError> {
        Self::plan(start, T::ZERO, limits)
    }

    /// From `start`, whose jerk is not read, to `velocity` (m/s) in least time.
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] if a value of the state, the velocity or the duration lies
    /// beyond its [`maximum`]; [`TrajectoryError::Unrepresentable`] if the duration overflows, or
    /// that of a true change underflows.
    pub fn plan(
        start: &Setpoint<T>,
        velocity: T,
        limits: &VelocityLimits<T>,
    ) -> Result<Self, TrajectoryError> {
        let bounded = |field, value: T, most, unit, valid| {
            check(value.abs() <= T::of(most), field, value, unit, valid)
        };
        position("position", start.position)?;
        let fast = maximum::VELOCITY;
        bounded("velocity", start.velocity, fast, "m/s", "from -1e9 to 1e9")?;
        bounded("target velocity", velocity, fast, "m/s", "from -1e9 to 1e9")?;
        bounded(
            "acceleration",
            start.acceleration,
            maximum::ACCELERATION,
            "m/s²",
            "from -1e9 to 1e9",
        )?;

        let jerk = limits.jerk;
        let jumps = jerk == T::of(f64::INFINITY);
        let mut course = Course {
            now: T::ZERO,
            state: Setpoint {
                jerk: T::ZERO,
                ..*start
            },
        };
        if jumps {
            // An acceleration that may jump says nothing of what follows.
            course.state.acceleration = T::ZERO;
        }
        let a = course.state.acceleration;
        let inside = clamp(a, limits.least, limits.greatest);
        let brought_back = course.towards(inside, jerk);

        // Taking the acceleration straight to zero gains a|a|/2J of velocity: what is wanted
        // beyond that tells the direction. With the acceleration a up to a peak p and down to
        // zero, Δv = (2p² − a²)/2J.
        let a = inside;
        let gain = velocity - course.state.velocity;
        let upward = if jumps {
            gain >= T::ZERO
        } else {
            jerk * gain >= T::HALF * a * a.abs()
        };
        let (sign, limit) = if upward {
            (T::ONE, limits.greatest)
        } else {
            (-T::ONE, -limits.least)
        };
        let (a, gain) = (sign * a, sign * gain);
        let (peak, held) = if jumps {
            (limit, gain / limit)
        } else {
            let square = (jerk * gain + T::HALF * a * a).max(T::ZERO);
            let free = square.sqrt().max(a).max(T::ZERO);
            if free > limit {
                (limit, (square - limit * limit) / jerk / limit)
            } else {
                (free, T::ZERO)
            }
        };
        let rising = course.towards(sign * peak, jerk);
        let steady = course.hold(held);
        let falling = course.towards(T::ZERO, jerk);

        let duration = planned(course.now, "the duration of the change")?;
        if duration == T::ZERO && velocity != start.velocity {
            return Err(unrepresentable::<T>("the duration of the change"));
        }
        let pieces = [brought_back, rising, steady, falling];
        let end = Setpoint {
            velocity,
            acceleration: T::ZERO,
            jerk: T::ZERO,
            ..course.state
        };
        Ok(Self {
            pieces,
            start: *start,
            duration,
            end,
        })
    }

    /// Time until the velocity is reached, s; zero if it is there already.
    #[inline]
    pub const fn duration(&self) -> T {
        self.duration
    }

    /// State at which the change ends: for a stop, its position is where the axis stands.
    #[inline]
    pub const fn end(&self) -> Setpoint<T> {
        self.end
    }

    /// Where an axis in the state `start` comes to a standstill, m, if it is stopped as fast as `limits` allow.
    ///
    /// ```
    /// use trajectories::{Setpoint, VelocityChange, VelocityLimits};
    ///
    /// let limits = VelocityLimits::<f64>::new(-4.0, 2.0, 40.0)?;
    /// let start = Setpoint { position: 1.0, velocity: 0.8, ..Setpoint::default() };
    /// let place = VelocityChange::stopping_place(&start, &limits)?;
    /// assert!((place - 1.12).abs() < 1e-15); // 0.8 m/s for half of 0.3 s
    /// # Ok::<(), trajectories::TrajectoryError>(())
    /// ```
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    #[inline]
    pub fn stopping_place(
        start: &Setpoint<T>,
        limits: &VelocityLimits<T>,
    ) -> Result<T, TrajectoryError> {
        Ok(Self::stop(start, limits)?.end.position)
    }

    /// Jerk (m/s³), duration (s), and accelerations (m/s²) at both ends, of each stretch.
    pub(crate) fn stretches(&self) -> [(T, T, T, T); 4] {
        let mut next = self.duration;
        let mut stretches = [(T::ZERO, T::ZERO, T::ZERO, T::ZERO); 4];
        for (stretch, piece) in stretches.iter_mut().zip(&self.pieces).rev() {
            let first = piece.state.acceleration;
            *stretch = (piece.state.jerk, next - piece.begin, first, piece.last);
            next = piece.begin;
        }
        stretches
    }

    /// State at `t` (s) after the start: the start for `t < 0` and NaN; from the duration on, the
    /// wanted velocity exactly, and a position that goes on with it.
    pub fn at(&self, t: T) -> Setpoint<T> {
        if t >= self.duration {
            let on = (t - self.duration) * self.end.velocity;
            // At standstill also for an infinite time, of which no product could be taken.
            let position = if self.end.velocity == T::ZERO {
                self.end.position
            } else {
                self.end.position + on
            };
            return Setpoint {
                position,
                ..self.end
            };
        }
        let has_begun = t >= T::ZERO;
        if !has_begun {
            return Setpoint {
                jerk: T::ZERO,
                ..self.start
            };
        }
        let mut piece = &self.pieces[0];
        for next in &self.pieces[1..] {
            if t >= next.begin {
                piece = next;
            }
        }
        let mut state = after(&piece.state, t - piece.begin);
        let (first, last) = (piece.state.acceleration, piece.last);
        // The time may exceed its piece by rounding: the limits hold all the same.
        state.acceleration = clamp(state.acceleration, first.min(last), first.max(last));
        state
    }
}

impl<T: Real> Motion<T> for VelocityChange<T> {
    #[inline]
    fn duration(&self) -> T {
        self.duration
    }

    #[inline]
    fn at(&self, t: T) -> Setpoint<T> {
        Self::at(self, t)
    }
}

/// Where the pieces laid so far have led.
struct Course<T> {
    now: T,
    state: Setpoint<T>,
}

impl<T: Real> Course<T> {
    /// To an acceleration at full jerk, or by a jump if that is infinite.
    fn towards(&mut self, acceleration: T, jerk: T) -> Piece<T> {
        let rise = acceleration - self.state.acceleration;
        let signed = if jerk == T::of(f64::INFINITY) || rise == T::ZERO {
            T::ZERO
        } else if rise > T::ZERO {
            jerk
        } else {
            -jerk
        };
        let time = rise.abs() / jerk;
        self.lay(signed, time, acceleration)
    }

    /// The same acceleration for `time`.
    fn hold(&mut self, time: T) -> Piece<T> {
        self.lay(T::ZERO, time, self.state.acceleration)
    }

    fn lay(&mut self, jerk: T, time: T, last: T) -> Piece<T> {
        let state = Setpoint { jerk, ..self.state };
        let begin = self.now;
        self.now = begin + time;
        self.state = Setpoint {
            acceleration: last,
            ..after(&state, time)
        };
        Piece { begin, state, last }
    }
}

#[inline]
fn clamp<T: Real>(x: T, low: T, high: T) -> T {
    x.max(low).min(high)
}
