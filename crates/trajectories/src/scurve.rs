//! One rest-to-rest move: planned in closed form, evaluated by one cubic.

use crate::error::{duration, position};
use crate::phases::Phases;
use crate::{Extremes, Limits, Motion, Setpoint, TrajectoryError};

/// A stretch of constant jerk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Time at which it begins, s after the start of the move.
    pub start: f64,
    /// Its length, s; may be zero.
    pub duration: f64,
    /// The jerk during it, m/s³.
    pub jerk: f64,
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
struct Knot {
    origin: f64,
    position: f64,
    velocity: f64,
    acceleration: f64,
    jerk: f64,
    velocity_share: f64,
    position_share: f64,
}

/// Time-optimal jerk-limited move between two rests.
///
/// Seven segments of constant jerk (some of zero length). Evaluation takes the same time for
/// any `t`, in any order; no limit is passed and no position outside the two ends is given, not
/// by rounding either.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SCurve {
    /// Switching instants, s: 0, …, duration.
    switches: [f64; 8],
    knots: [Knot; 7],
    from: f64,
    to: f64,
    /// Least position, velocity and acceleration of the move.
    low: [f64; 3],
    /// Greatest position, velocity and acceleration of the move.
    high: [f64; 3],
    /// Greatest |jerk| of the move.
    jerk: f64,
}

impl SCurve {
    /// The move in least time from rest at `from` (m) to rest at `to` (m) within `limits`.
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] if an end or the duration lies beyond its
    /// [`maximum`](crate::maximum), [`TrajectoryError::Unrepresentable`] if the duration overflows,
    /// or that of a true move underflows.
    #[inline]
    pub fn plan(from: f64, to: f64, limits: &Limits) -> Result<Self, TrajectoryError> {
        position("from", from)?;
        position("to", to)?;
        let distance = (to - from).abs();
        if distance == 0.0 {
            return Ok(Self::standing(to));
        }
        let phases = Phases::time_optimal(distance, limits);
        let switches = phases.switching_times();
        if !(switches[7].is_finite() && switches[7] > 0.0) {
            return Err(TrajectoryError::Unrepresentable {
                what: "the duration of the move",
            });
        }
        duration(switches[7])?;
        Ok(Self::assemble(from, to, limits.jerk(), &phases, switches))
    }

    /// No move at all: the limits of zero displacement.
    fn standing(position: f64) -> Self {
        Self {
            switches: [0.0; 8],
            knots: [Knot::REST; 7],
            from: position,
            to: position,
            low: [position, 0.0, 0.0],
            high: [position, 0.0, 0.0],
            jerk: 0.0,
        }
    }

    /// States at the knots.
    ///
    /// Each segment is evaluated from the end that is known best: the first half builds on
    /// `from`, the second on `to`, so nothing accumulates and the end is met exactly. Segments 2
    /// and 3 are evaluated backwards from their ends, 5 and 6 forwards from their starts: so all
    /// segments of full jerk are evaluated from where the acceleration is exactly zero.
    #[inline]
    fn assemble(from: f64, to: f64, jerk: f64, phases: &Phases, switches: [f64; 8]) -> Self {
        let sign = if to > from { 1.0 } else { -1.0 };
        let (tau, peak) = (phases.jerk_time, phases.velocity);
        // Without a cruise the two halves must meet in the middle.
        let ramp_distance = if phases.cruise_time > 0.0 {
            0.5 * peak * switches[3]
        } else {
            0.5 * (to - from).abs()
        };
        // State at switches 2 and 5, where the acceleration begins to fall, or is fully negative.
        let shoulder_velocity = peak - 0.5 * phases.acceleration * tau;
        let shoulder_distance = ramp_distance - tau * (peak - phases.acceleration * tau / 6.0);

        let pushed = |origin, position, velocity, jerk| Knot {
            origin,
            position,
            velocity: sign * velocity,
            acceleration: 0.0,
            jerk: sign * jerk,
            velocity_share: 1.0 / 2.0,
            position_share: 1.0 / 6.0,
        };
        let steady = |origin, position, velocity, acceleration| Knot {
            origin,
            position,
            velocity: sign * velocity,
            acceleration: sign * acceleration,
            jerk: 0.0,
            velocity_share: 1.0,
            position_share: 1.0 / 2.0,
        };
        let a = phases.acceleration;
        let (begun, ended) = (from + sign * ramp_distance, to - sign * ramp_distance);
        let rising = from + sign * shoulder_distance;
        let falling = to - sign * shoulder_distance;
        Self {
            switches,
            knots: [
                pushed(0.0, from, 0.0, jerk),
                steady(switches[2], rising, shoulder_velocity, a),
                pushed(switches[3], begun, peak, -jerk),
                steady(switches[3], begun, peak, 0.0),
                pushed(switches[4], ended, peak, -jerk),
                steady(switches[5], falling, shoulder_velocity, -a),
                pushed(switches[7], to, 0.0, jerk),
            ],
            from,
            to,
            low: [from.min(to), -peak, -a],
            high: [from.max(to), peak, a],
            jerk,
        }
    }

    /// The seven segments in order, those of zero length included.
    pub fn segments(&self) -> [Segment; 7] {
        core::array::from_fn(|i| Segment {
            start: self.switches[i],
            duration: self.switches[i + 1] - self.switches[i],
            jerk: self.knots[i].jerk,
        })
    }

    /// When the move runs at constant velocity: begin and end, s after its start.
    ///
    /// `None` if it never does.
    pub fn cruise(&self) -> Option<(f64, f64)> {
        let (begin, end) = (self.switches[3], self.switches[4]);
        (end > begin).then_some((begin, end))
    }

    /// Position at the start, m.
    #[inline]
    pub const fn from(&self) -> f64 {
        self.from
    }

    /// Position at the end, m.
    #[inline]
    pub const fn to(&self) -> f64 {
        self.to
    }

    /// Greatest |velocity| reached, m/s.
    #[inline]
    pub const fn peak_velocity(&self) -> f64 {
        self.high[1]
    }

    /// Greatest |acceleration| reached, m/s².
    #[inline]
    pub const fn peak_acceleration(&self) -> f64 {
        self.high[2]
    }

    /// Position range, and greatest velocity, acceleration and jerk reached.
    pub const fn extremes(&self) -> Extremes {
        Extremes {
            position_min: self.low[0],
            position_max: self.high[0],
            velocity: self.high[1],
            acceleration: self.high[2],
            jerk: self.jerk,
        }
    }
}

impl Motion for SCurve {
    #[inline]
    fn duration(&self) -> f64 {
        self.switches[7]
    }

    #[inline]
    fn at(&self, t: f64) -> Setpoint {
        // The bits of numbers that are not negative order as the numbers do; a sign bit or NaN
        // makes them greater than any duration. So one comparison finds the usual case, and all
        // comparisons run beside the floating-point work instead of queueing with it.
        if t.to_bits() < self.switches[7].to_bits() {
            self.during(t)
        } else {
            self.outside(t)
        }
    }
}

impl SCurve {
    /// Setpoint at `t` in `[0, duration)`, sign bit clear.
    #[inline]
    fn during(&self, t: f64) -> Setpoint {
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
    /// sampled in order, and these are then foreseen; a search without branches measured half
    /// as slow again in order, and a little faster at random.
    #[inline]
    fn segment(&self, t: f64) -> usize {
        let before = |i: usize| t.to_bits() < self.switches[i].to_bits();
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
    fn outside(&self, t: f64) -> Setpoint {
        let after = t >= self.switches[7];
        Setpoint {
            position: if after { self.to } else { self.from },
            velocity: 0.0,
            acceleration: 0.0,
            jerk: if t == 0.0 && !after {
                self.knots[0].jerk
            } else {
                0.0
            },
        }
    }
}

/// `x` between `low` and `high`; two machine instructions, unlike `f64::clamp`, which must also
/// check its bounds.
#[inline]
fn clamp(x: f64, low: f64, high: f64) -> f64 {
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}

impl Knot {
    /// Stands for the segments of a move of no length, which no `t` falls into.
    const REST: Self = Self {
        origin: 0.0,
        position: 0.0,
        velocity: 0.0,
        acceleration: 0.0,
        jerk: 0.0,
        velocity_share: 0.0,
        position_share: 0.0,
    };
}
