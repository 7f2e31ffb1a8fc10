//! One rest-to-rest move: planned in closed form, evaluated by one cubic.

use crate::error::{duration, position, unrepresentable};
use crate::phases::Phases;
use crate::{Extremes, Limits, Motion, Real, Setpoint, TrajectoryError};

/// A stretch of constant jerk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<T = f64> {
    /// Time at which it begins, s after the start of the move.
    pub start: T,
    /// Its length, s; may be zero.
    pub duration: T,
    /// The jerk during it, m/s³.
    pub jerk: T,
}

/// A known state of a segment, and how to go on from it.
///
/// With `dt = t − origin`, `a = acceleration + jerk dt` and `q = a dt`, one of acceleration and
/// jerk being zero in each segment,
///
/// ```text
/// velocity = v + velocity_share q         shares: 1, 1/2 at constant acceleration
/// position = p + dt (v + position_share q)        1/2, 1/6 at constant jerk
/// ```
///
/// are the segment's parabola and cubic.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot<T> {
    origin: T,
    position: T,
    velocity: T,
    acceleration: T,
    jerk: T,
    velocity_share: T,
    position_share: T,
}

/// Time-optimal jerk-limited move between two rests.
///
/// Seven segments of constant jerk (some of zero length). Evaluation takes the same time for
/// any `t`, in any order; no limit is passed and no position outside the two ends is given, not
/// by rounding either.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SCurve<T = f64> {
    /// Switching instants, s: 0, …, duration.
    switches: [T; 8],
    knots: [Knot<T>; 7],
    from: T,
    to: T,
    /// Least position, velocity and acceleration of the move.
    low: [T; 3],
    /// Greatest position, velocity and acceleration of the move.
    high: [T; 3],
    /// Greatest |jerk| of the move.
    jerk: T,
}

impl<T: Real> SCurve<T> {
    /// The move in least time from rest at `from` (m) to rest at `to` (m) within `limits`.
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] if an end or the duration lies beyond its
    /// [`maximum`](crate::maximum), [`TrajectoryError::Unrepresentable`] if the duration overflows,
    /// or that of a true move underflows.
    #[inline]
    pub fn plan(from: T, to: T, limits: &Limits<T>) -> Result<Self, TrajectoryError> {
        position("from", from)?;
        position("to", to)?;
        let distance = (to - from).abs();
        if distance == T::ZERO {
            return Ok(Self::standing(to));
        }
        let phases = Phases::time_optimal(distance, limits);
        let switches = phases.switching_times();
        if !(switches[7].is_finite() && switches[7] > T::ZERO) {
            return Err(unrepresentable::<T>("the duration of the move"));
        }
        duration(switches[7])?;
        Ok(Self::assemble(from, to, limits.jerk(), &phases, switches))
    }

    /// No move at all: the limits of zero displacement.
    fn standing(position: T) -> Self {
        Self {
            switches: [T::ZERO; 8],
            knots: [Knot::REST; 7],
            from: position,
            to: position,
            low: [position, T::ZERO, T::ZERO],
            high: [position, T::ZERO, T::ZERO],
            jerk: T::ZERO,
        }
    }

    /// States at the knots.
    ///
    /// Each segment is evaluated from the end that is known best: the first half builds on
    /// `from`, the second on `to`, so nothing accumulates and the end is met exactly. Segments 2
    /// and 3 are evaluated backwards from their ends, 5 and 6 forwards from their starts: so all
    /// segments of full jerk are evaluated from where the acceleration is exactly zero.
    #[inline]
    fn assemble(from: T, to: T, jerk: T, phases: &Phases<T>, switches: [T; 8]) -> Self {
        let sign = if to > from { T::ONE } else { -T::ONE };
        let (tau, peak) = (phases.jerk_time, phases.velocity);
        // Without a cruise the two halves must meet in the middle.
        let ramp_distance = if phases.cruise_time > T::ZERO {
            T::HALF * peak * switches[3]
        } else {
            T::HALF * (to - from).abs()
        };
        // State at switches 2 and 5, where the acceleration begins to fall, or is fully negative.
        let shoulder_velocity = peak - T::HALF * phases.acceleration * tau;
        let shoulder_distance =
            ramp_distance - tau * (peak - phases.acceleration * tau / T::of(6.0));

        let pushed = |origin, position, velocity, jerk| Knot {
            origin,
            position,
            velocity: sign * velocity,
            acceleration: T::ZERO,
            jerk: sign * jerk,
            velocity_share: T::HALF,
            position_share: T::of(1.0 / 6.0),
        };
        let steady = |origin, position, velocity, acceleration| Knot {
            origin,
            position,
            velocity: sign * velocity,
            acceleration: sign * acceleration,
            jerk: T::ZERO,
            velocity_share: T::ONE,
            position_share: T::HALF,
        };
        let a = phases.acceleration;
        let (begun, ended) = (from + sign * ramp_distance, to - sign * ramp_distance);
        let rising = from + sign * shoulder_distance;
        let falling = to - sign * shoulder_distance;
        Self {
            switches,
            knots: [
                pushed(T::ZERO, from, T::ZERO, jerk),
                steady(switches[2], rising, shoulder_velocity, a),
                pushed(switches[3], begun, peak, -jerk),
                steady(switches[3], begun, peak, T::ZERO),
                pushed(switches[4], ended, peak, -jerk),
                steady(switches[5], falling, shoulder_velocity, -a),
                pushed(switches[7], to, T::ZERO, jerk),
            ],
            from,
            to,
            low: [from.min(to), -peak, -a],
            high: [from.max(to), peak, a],
            jerk,
        }
    }

    /// The seven segments in order, those of zero length included.
    pub fn segments(&self) -> [Segment<T>; 7] {
        core::array::from_fn(|i| Segment {
            start: self.switches[i],
            duration: self.switches[i + 1] - self.switches[i],
            jerk: self.knots[i].jerk,
        })
    }

    /// When the move runs at constant velocity: begin and end, s after its start.
    ///
    /// `None` if it never does.
    pub fn cruise(&self) -> Option<(T, T)> {
        let (begin, end) = (self.switches[3], self.switches[4]);
        (end > begin).then_some((begin, end))
    }

    /// Position at the start, m.
    #[inline]
    pub const fn from(&self) -> T {
        self.from
    }

    /// Position at the end, m.
    #[inline]
    pub const fn to(&self) -> T {
        self.to
    }

    /// Greatest |velocity| reached, m/s.
    #[inline]
    pub const fn peak_velocity(&self) -> T {
        self.high[1]
    }

    /// Greatest |acceleration| reached, m/s².
    #[inline]
    pub const fn peak_acceleration(&self) -> T {
        self.high[2]
    }

    /// Position range, and greatest velocity, acceleration and jerk reached.
    pub const fn extremes(&self) -> Extremes<T> {
        Extremes {
            position_min: self.low[0],
            position_max: self.high[0],
            velocity: self.high[1],
            acceleration: self.high[2],
            jerk: self.jerk,
        }
    }
}

impl<T: Real> Motion<T> for SCurve<T> {
    #[inline]
    fn duration(&self) -> T {
        self.switches[7]
    }

    #[inline]
    fn at(&self, t: T) -> Setpoint<T> {
        // One comparison of integers finds the usual case, and all comparisons run beside the
        // floating-point work instead of queueing with it.
        if t.is_before(self.switches[7]) {
            self.during(t)
        } else {
            self.outside(t)
        }
    }
}

impl<T: Real> SCurve<T> {
    /// Setpoint at `t` in `[0, duration)`, sign bit clear.
    #[inline]
    fn during(&self, t: T) -> Setpoint<T> {
        let knot = &self.knots[self.segment(t)];
        let dt = t - knot.origin;
        let acceleration = knot.acceleration + dt * knot.jerk;
        let q = dt * acceleration;
        let velocity = knot.velocity + q * knot.velocity_share;
        let position = knot.position + dt * (knot.velocity + q * knot.position_share);
        // dt may exceed its segment by the rounding of t: the limits hold all the same.
        Setpoint {
            position: clamp(position, self.low[0], self.high[0]),
            velocity: clamp(velocity, self.low[1], self.high[1]),
            acceleration: clamp(acceleration, self.low[2], self.high[2]),
            jerk: knot.jerk,
        }
    }

    /// Index of the segment that holds `t` in `[0, duration)`; at a switch, of the later one.
    ///
    /// The cruise comes first, being the longest as a rule. Branches, because motions are mostly
    /// sampled in order, and these are then predicted; a search without branches measured half
    /// as slow again in order, and a little faster at random.
    #[inline]
    fn segment(&self, t: T) -> usize {
        let before = |i: usize| t.is_before(self.switches[i]);
        match () {
            () if before(4) && !before(3) => 3,
            () if before(1) => 0,
            () if before(2) => 1,
            () if before(3) => 2,
            () if before(5) => 4,
            () if before(6) => 5,
            () => 6,
        }
    }

    /// Setpoint at any other `t`: before, after, NaN, or zero with its sign set.
    ///
    /// Calls nothing, lest the usual path had to save its registers for a call never made.
    #[inline]
    fn outside(&self, t: T) -> Setpoint<T> {
        let after = t >= self.switches[7];
        Setpoint {
            position: if after { self.to } else { self.from },
            velocity: T::ZERO,
            acceleration: T::ZERO,
            jerk: if t == T::ZERO && !after {
                self.knots[0].jerk
            } else {
                T::ZERO
            },
        }
    }
}

/// `x` between `low` and `high`; two machine instructions, unlike `f64::clamp`, which must also
/// check its bounds.
#[inline]
fn clamp<T: Real>(x: T, low: T, high: T) -> T {
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}

impl<T: Real> Knot<T> {
    /// Stands for the segments of a move of no length, which no `t` falls into.
    const REST: Self = Self {
        origin: T::ZERO,
        position: T::ZERO,
        velocity: T::ZERO,
        acceleration: T::ZERO,
        jerk: T::ZERO,
        velocity_share: T::ZERO,
        position_share: T::ZERO,
    };
}
