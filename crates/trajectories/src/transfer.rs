//! From any state to any other in least time, or in a duration that is asked for.

mod brake;
mod checks;
mod jumps;
mod lay;
mod limits;
mod side;

use crate::constant_jerk::Course;
use crate::error::{check, planned, position, unrepresentable};
use crate::{Extremes, Motion, Real, Setpoint, TrajectoryError, VelocityLimits, maximum};
use checks::{TARGET, reachable, state};
use lay::{bring_back, complete, task};
pub use limits::TransferLimits;

/// Motion in least time from any position, velocity and acceleration to any other. It allocates nothing, and may be
/// planned anew in every cycle.
///
/// Velocity, acceleration and jerk never pass their limits. A start beyond a limit is first brought back, in the
/// least time that takes. With an infinite jerk the acceleration jumps; those at start and end are then not read.
///
/// After its end the motion goes on with the velocity of its target, without acceleration.
///
/// ```
/// use trajectories::{Limits, Motion, Setpoint, Transfer};
///
/// let limits = Limits::<f64>::new(1.0, 2.0, 40.0)?.into(); // m/s, m/s², m/s³
/// let start = Setpoint { position: 0.0, velocity: -0.3, acceleration: 0.5, jerk: 0.0 };
/// let target = Setpoint { position: 0.2, velocity: 0.4, ..Setpoint::default() };
/// let transfer = Transfer::plan(&start, &target, &limits)?;
/// let end = transfer.at(transfer.duration());
/// assert_eq!((end.position, end.velocity), (0.2, 0.4));
/// # Ok::<(), trajectories::TrajectoryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transfer<T = f64> {
    course: Course<T>,
    start: Setpoint<T>,
    end: Setpoint<T>,
    /// Velocities that are not left once the start is back within the limits, m/s, and when that is, s.
    low: T,
    high: T,
    within: T,
}

impl<T: Real> Transfer<T> {
    /// In least time from `start` to `target`, whose jerks are not read.
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] if a value lies beyond its [`maximum`], or if the target
    /// cannot be reached within the limits: its velocity or acceleration lies beyond one, or its acceleration can be
    /// built up only from a velocity that does. [`TrajectoryError::Unrepresentable`] if the motion over- or
    /// underflows.
    #[inline]
    pub fn plan(
        start: &Setpoint<T>,
        target: &Setpoint<T>,
        limits: &TransferLimits<T>,
    ) -> Result<Self, TrajectoryError> {
        Self::lasting(start, target, limits, T::ZERO)
    }

    /// In least time to a target that moves on from its position with its velocity, to be with it from then on: a belt, a
    /// rotating table, an axis that leads. Its acceleration must be zero.
    ///
    /// It is the transfer to standstill for one who moves with the target.
    ///
    /// ```
    /// use trajectories::{Limits, Motion, Setpoint, Transfer};
    ///
    /// let limits = Limits::<f64>::new(1.0, 2.0, 40.0)?.into();
    /// let part = Setpoint { position: 0.1, velocity: 0.3, ..Setpoint::default() }; // m, m/s
    /// let meet = Transfer::meet(&Setpoint::at_rest(0.0), &part, &limits)?;
    /// let then = meet.at(2.0); // s
    /// assert!(meet.duration() < 2.0 && (then.position - (0.1 + 0.3 * 2.0)).abs() < 1e-12);
    /// # Ok::<(), trajectories::TrajectoryError>(())
    /// ```
    ///
    /// # Errors
    /// As [`plan`](Self::plan); the target's velocity must lie between the limits, not at one.
    pub fn meet(
        start: &Setpoint<T>,
        target: &Setpoint<T>,
        limits: &TransferLimits<T>,
    ) -> Result<Self, TrajectoryError> {
        state(start, ["position", "velocity", "acceleration"])?;
        state(target, TARGET)?;
        let (velocity, a) = (target.velocity, target.acceleration);
        check(
            a == T::ZERO,
            TARGET[2],
            a,
            "m/s²",
            "zero for a target that moves on",
        )?;
        check(
            velocity > limits.back && velocity < limits.fast,
            TARGET[1],
            velocity,
            "m/s",
            "between the velocity limits, not at one",
        )?;
        let seen = TransferLimits {
            back: limits.back - velocity,
            fast: limits.fast - velocity,
            change: limits.change,
        };
        let from = Setpoint {
            velocity: start.velocity - velocity,
            ..*start
        };
        let plan = Self::plan(&from, &Setpoint::at_rest(target.position), &seen)?;
        let duration = plan.duration();
        let end = target.position + velocity * duration;
        Ok(Self {
            course: plan.course.drifting(velocity),
            start: *start,
            end: Setpoint {
                position: position("position at the end", end)?,
                jerk: T::ZERO,
                ..*target
            },
            low: limits.back,
            high: limits.fast,
            within: plan.within,
        })
    }

    /// To standstill as fast as possible, wherever that is: [`end`](Self::end) says where.
    ///
    /// A velocity limit that the start exceeds, or must exceed, does not delay it.
    ///
    /// # Errors
    /// As [`VelocityChange::plan`](crate::VelocityChange::plan).
    pub fn stop(start: &Setpoint<T>, limits: &VelocityLimits<T>) -> Result<Self, TrajectoryError> {
        let change = crate::VelocityChange::stop(start, limits)?;
        let mut course = Course::new(start);
        if limits.jerk() == T::INFINITY {
            course.state.acceleration = T::ZERO;
        }
        for (jerk, time, first, last) in change.stretches() {
            course.state.acceleration = first;
            course.lay(jerk, time, last);
        }
        Ok(Self {
            course,
            start: *start,
            end: change.end(),
            low: -T::INFINITY,
            high: T::INFINITY,
            within: T::ZERO,
        })
    }

    /// In the least possible time that is not below `duration` (s).
    ///
    /// Not every longer time is possible: an axis that moves towards its target at the start, and must move on at its
    /// end, may have to turn back between, for which there must be time. The result then takes the
    /// next longer time that is possible, its [`duration`](Motion::duration).
    ///
    /// Of all motions in a given time the one is taken that lies between the one that goes farthest and the one that
    /// goes least far, in a constant ratio of their jerks: limits on velocity, acceleration and jerk are each convex, so
    /// it obeys them as the two do.
    ///
    /// # Errors
    /// As [`plan`](Self::plan), and for a duration that is negative, NaN or above [`maximum::DURATION`].
    pub fn lasting(
        start: &Setpoint<T>,
        target: &Setpoint<T>,
        limits: &TransferLimits<T>,
        duration: T,
    ) -> Result<Self, TrajectoryError> {
        check(
            duration >= T::ZERO && duration <= T::of(maximum::DURATION),
            "duration",
            duration,
            "s",
            "from 0 to 1e7",
        )?;
        state(start, ["position", "velocity", "acceleration"])?;
        state(target, TARGET)?;
        reachable(target, limits)?;
        let jerk = limits.change.jerk();
        if jerk == T::INFINITY {
            return jumps::plan(start, target, limits, duration);
        }
        let mut task = task(start, target, limits);
        let mut course = Course::new(start);
        // The target may be reached before a limit is exceeded that the start would have to exceed later.
        let direct = brake::is_within(&task) && complete(&task, &mut course, duration, jerk);
        let mut within = T::ZERO;
        if !direct {
            bring_back(&mut task, &mut course, jerk);
            let wanted = (duration - course.now).max(T::ZERO);
            within = course.now + brake::return_time(&task);
            if !complete(&task, &mut course, wanted, jerk) {
                return Err(unrepresentable::<T>("the duration of the transfer"));
            }
        }
        Self::finish(course, (start, target), limits, within)
    }

    /// The motion of a planned course, or an error if its times or positions are not finite.
    fn finish(
        course: Course<T>,
        (start, target): (&Setpoint<T>, &Setpoint<T>),
        limits: &TransferLimits<T>,
        within: T,
    ) -> Result<Self, TrajectoryError> {
        planned(course.now, "the duration of the transfer")?;
        let end = Setpoint {
            jerk: T::ZERO,
            ..*target
        };
        Ok(Self {
            course,
            start: *start,
            end,
            low: limits.back,
            high: limits.fast,
            within,
        })
    }

    /// State at which the motion ends: the target.
    #[inline]
    pub const fn end(&self) -> Setpoint<T> {
        self.end
    }

    /// Time after which position, velocity and acceleration keep their limits, s: zero for a start within them.
    #[inline]
    pub const fn within_limits_after(&self) -> T {
        self.within
    }

    /// The values reached, those at a start beyond a limit included.
    pub fn extremes(&self) -> Extremes<T> {
        let ends = [&self.start, &self.end].map(|s| Extremes {
            position_min: s.position,
            position_max: s.position,
            velocity: s.velocity.abs(),
            acceleration: s.acceleration.abs(),
            jerk: T::ZERO,
        });
        self.course.extremes(ends[0].union(ends[1]))
    }

    /// This motion, if it stays between two positions (m).
    ///
    /// # Errors
    /// [`TrajectoryError::LeavesRange`] with the position that is reached.
    pub fn between(self, position_min: T, position_max: T) -> Result<Self, TrajectoryError> {
        let found = self.extremes();
        let low = found.position_min >= position_min;
        if low && found.position_max <= position_max {
            return Ok(self);
        }
        Err(TrajectoryError::LeavesRange {
            position: if low {
                found.position_max.to_f64()
            } else {
                found.position_min.to_f64()
            },
            position_min: position_min.to_f64(),
            position_max: position_max.to_f64(),
        })
    }

    /// Standing still at zero.
    pub(crate) fn at_rest() -> Self {
        let rest = Setpoint::at_rest(T::ZERO);
        Self {
            course: Course::new(&rest),
            start: rest,
            end: rest,
            low: -T::INFINITY,
            high: T::INFINITY,
            within: T::ZERO,
        }
    }

    /// The same motion along another axis, on which all distances are `factor` times as long.
    pub(crate) fn scaled(&self, factor: T, start: &Setpoint<T>, end: &Setpoint<T>) -> Self {
        let (low, high) = (factor * self.low, factor * self.high);
        Self {
            course: self.course.scaled(factor, start.position),
            start: *start,
            end: Setpoint {
                jerk: T::ZERO,
                ..*end
            },
            low: low.min(high),
            high: low.max(high),
            within: self.within,
        }
    }
}

impl<T: Real> Motion<T> for Transfer<T> {
    #[inline]
    fn duration(&self) -> T {
        self.course.now
    }

    fn at(&self, t: T) -> Setpoint<T> {
        let end = self.course.now;
        if t > end {
            let on = if self.end.velocity == T::ZERO {
                T::ZERO
            } else {
                (t - end) * self.end.velocity
            };
            return Setpoint {
                position: self.end.position + on,
                acceleration: T::ZERO,
                ..self.end
            };
        }
        if t == end {
            return self.end;
        }
        let has_begun = t >= T::ZERO;
        if !has_begun {
            return Setpoint {
                jerk: T::ZERO,
                ..self.start
            };
        }
        let mut state = self.course.at(t);
        if t >= self.within {
            state.velocity = state.velocity.max(self.low).min(self.high);
        }
        state
    }
}
