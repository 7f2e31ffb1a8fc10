//! Feedback around a plan that knows the friction's state: observer and state feedback.
//!
//! Measured deviations y from the plan (position, motor speed, q current) correct a model of
//! the axis' deviations x, whose last state is a force on the load that the plan does not
//! have; the command takes all of it back:
//!
//! ```text
//! x̂ = x̄ + L (y − C x̄)       u = −K x̂       x̄(k+1) = A x̂ + b u
//! ```
//!
//! A, b, L and K follow χ, the share of bristles that move with the load
//! ([`Planned::sticking`]): in pre-sliding friction is a spring and a strong damper, in sliding
//! neither, and gains for the one make a limit cycle of the other. They are linear in χ
//! between nodes. `FeedbackDesign` (feature `design`) makes them.
//!
//! A load that slides slowly is unstable by itself: with 1/τ = σ0 |ω|/G a vibration faster
//! than that meets the damping σ2 + σ1 |ω| G'/G, negative where the Stribeck curve falls
//! ([`lugre::LuGre::vibration_damping`]). The gains at χ = 0 are made for that.
//!
//! The drive is untouched. The offset of the position
//!
//! ```text
//! position = (ω_m − f_v v_ref/r)/P − (S_ref − S)
//! ```
//!
//! makes its speed error zero, so that its proportional part gives nothing and its integrator
//! holds what it has; the offset of the command is the plan's and u. What the drive commanded
//! besides (a position loop at a lower rate leaves something) is taken off again, and the
//! observer goes by [`Sample::last_command`].

#[cfg(feature = "design")]
mod design;
mod gains;
mod with_plan;

use axis_scalar::Scalar;

use crate::plan::Planned;
use crate::{Correction, Sample};
#[cfg(feature = "design")]
pub use design::{
    DesignError, DriveSituation, FeedbackDesign, FeedbackSettings, Margins, SampledDrive,
    SampledResponse, Variation,
};
pub use gains::{Gains, Node, States};
use gains::{add, dot};
pub use with_plan::PlanWithFeedback;

/// Most states of a feedback's model.
pub const MOST_STATES: usize = 12;
/// Most measurements: position, motor speed, q current.
pub const MOST_MEASURED: usize = 3;
/// Values of χ at which gains are held.
pub const NODES: usize = 7;
/// Share of a cycle's difference between what the drive commanded and what it was asked for
/// that is taken as lasting. Slow against filters in the drive's command, quick against an
/// integrator that sees the speed between two executions of a slower position loop.
const OWN: f64 = 1.0 / 16.0;
/// The same for how that changes in a cycle: twice the root of it is [`OWN`], so that both settle
/// as fast as they can without swinging.
const OWN_RATE: f64 = 0.25 * OWN * OWN;
/// Greatest state that is trusted, in its unit: what the greatest force moves in a cycle, or
/// that force, or the greatest command.
const MOST: f64 = 1e6;

/// What a feedback assumes of the axis' deviations from the plan, after a cycle's sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviations<T = f64> {
    /// Load's position, m (rad).
    pub load: T,
    /// Load's speed, m/s (rad/s).
    pub load_speed: T,
    /// Force against the load that the plan does not have, N (N·m): positive as friction is in
    /// positive motion, and as [`crate::Target::force`] is.
    pub force: T,
    /// What the measurements were off what was expected of them: position (m), motor speed
    /// (rad/s), q current (A; 0 if it is not measured).
    pub innovation: [T; MOST_MEASURED],
    /// The same as one number: √(Σ (νᵢ/sᵢ)²/m) over m measurements, sᵢ being the deviation of
    /// the innovation νᵢ that the Kalman filter reckons with. About 1 while its noise is what it
    /// was designed for; infinite for a sample that is not finite.
    pub surprise: T,
    /// Command that the feedback adds to the plan's, in the actuator's unit, as far as the
    /// actuator's limit lets it.
    pub effort: T,
    /// Whether the sample was used; one that is not finite is not.
    pub used: bool,
}

/// A cycle's command and what belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Before<T> {
    sticking: T,
    /// Command of the plan, and with the feedback, limited.
    planned: T,
    effort: T,
}

/// Observer and state feedback around a plan. No allocation; 13 KB in `f64`, 6.5 KB in `f32`.
#[derive(Clone, Debug, PartialEq)]
pub struct Feedback<T = f64> {
    gains: Gains<T>,
    /// x̄: what was expected of the last cycle.
    expected: States<T>,
    /// x̂: what its sample made of it.
    estimated: States<T>,
    /// What was asked for then.
    before: Option<Before<T>>,
    /// What the drive's own loops add to the command, beside what they held at the start.
    own: T,
    /// How that changes in a cycle.
    own_rate: T,
    /// Motor's speed along the plan in the cycle before, rad/s.
    speed: T,
    last: Deviations<T>,
}

impl<T: Scalar> Feedback<T> {
    #[cfg(feature = "design")]
    fn new(gains: Gains<T>) -> Self {
        Self {
            gains,
            expected: [T::ZERO; MOST_STATES],
            estimated: [T::ZERO; MOST_STATES],
            before: None,
            own: T::ZERO,
            own_rate: T::ZERO,
            speed: T::ZERO,
            last: Deviations::default(),
        }
    }

    /// The same, each number rounded to the nearest of another scalar; at the start of a
    /// motion.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> Feedback<U> {
        Feedback {
            gains: self.gains.cast(),
            expected: [U::ZERO; MOST_STATES],
            estimated: [U::ZERO; MOST_STATES],
            before: None,
            own: U::ZERO,
            own_rate: U::ZERO,
            speed: U::ZERO,
            last: Deviations::default(),
        }
    }

    /// Model and gains, for code that is generated from them.
    pub fn gains(&self) -> &Gains<T> {
        &self.gains
    }

    /// Forgets everything: the next sample is the first of a motion from rest.
    pub fn reset(&mut self) {
        self.expected = [T::ZERO; MOST_STATES];
        self.estimated = self.expected;
        self.before = None;
        self.own = T::ZERO;
        self.own_rate = T::ZERO;
        self.speed = T::ZERO;
        self.last = Deviations::default();
    }

    /// What it assumed in the last cycle.
    pub fn deviations(&self) -> &Deviations<T> {
        &self.last
    }

    /// The estimated states after the last sample, in units of their own, the force's last.
    pub fn states(&self) -> &[T] {
        &self.estimated[..self.gains.states]
    }

    /// The correction of the cycle that begins with `sample` and that the plan has as
    /// `planned`. It replaces the plan's own and the drive's loops.
    pub fn correct(&mut self, sample: &Sample<T>, planned: &Planned<T>) -> Correction<T> {
        self.predict(sample.last_command);
        let g = &self.gains;
        let c = &g.cascade;
        let mut position = planned.position;
        if c.from_motor {
            position += g.travel * (planned.wind_up - planned.home);
        }
        // A difference of angles is the mean speed of the cycle before.
        let mut speed = planned.motor_speed;
        if g.differences {
            speed = T::HALF * (speed + self.speed);
        }
        self.speed = planned.motor_speed;
        let deviations = [
            sample.position - position,
            sample.motor_speed - speed,
            sample.iq - planned.current,
        ];
        let planned_well = [planned.sticking, planned.effort, planned.correction.command];
        let mut known = deviations[..g.measured].iter().chain(&planned_well);
        if !known.all(|value| value.is_finite()) {
            return self.without_sample(planned);
        }
        let (low, high, share) = g.around(planned.sticking);
        let mut x = self.expected;
        let mut innovation = [T::ZERO; MOST_MEASURED];
        let mut surprise = T::ZERO;
        for i in 0..g.measured {
            innovation[i] = deviations[i] - dot(&g.c[i], &self.expected);
            let spread = low.expected[i] + share * (high.expected[i] - low.expected[i]);
            let ratio = innovation[i] / spread;
            surprise += ratio * ratio;
            add(&mut x, &low.l[i], &high.l[i], share, innovation[i]);
        }
        let [at_low, at_high] = [low, high].map(|node| dot(&node.k, &x));
        let asked = planned.effort - g.limit * (at_low + share * (at_high - at_low));
        let effort = asked.max(-g.limit).min(g.limit);
        let fed = c.velocity_feedforward * sample.reference.velocity / g.travel;
        let correction = Correction {
            position: (sample.motor_speed - fed) / c.position
                - (sample.reference.position - sample.position),
            command: planned.correction.command + (effort - planned.effort) - self.own,
        };
        // Beyond this nothing was measured: the sample was wrong.
        let sound = x.iter().all(|x| x.abs() <= T::of(MOST)) && correction.position.is_finite();
        if !sound || !correction.command.is_finite() {
            return self.without_sample(planned);
        }
        self.last = Deviations {
            load: dot(&g.load[0], &x),
            load_speed: dot(&g.load[1], &x),
            force: g.force * x[g.states - 1],
            innovation,
            surprise: (surprise / T::of(g.measured as f64)).sqrt(),
            effort: effort - planned.effort,
            used: true,
        };
        self.estimated = x;
        self.before = Some(Before {
            sticking: planned.sticking,
            planned: planned.effort,
            effort,
        });
        correction
    }

    /// From the last estimate to what is expected now, by what the drive says that it has
    /// commanded; by what it was asked for where it says nothing.
    fn predict(&mut self, commanded: T) {
        let Some(before) = self.before else {
            return;
        };
        let g = &self.gains;
        let mut effort = before.effort;
        let other = commanded - before.effort;
        if other.abs() <= T::TWO * g.limit {
            effort = commanded;
            let limited = |value: T| value.max(-g.limit).min(g.limit);
            self.own_rate = limited(self.own_rate + T::of(OWN_RATE) * other);
            self.own = limited(self.own + self.own_rate + T::of(OWN) * other);
        }
        let (low, high, share) = g.around(before.sticking);
        let mut next = [T::ZERO; MOST_STATES];
        for (i, &x) in self.estimated[..g.states].iter().enumerate() {
            add(&mut next, &low.a[i], &high.a[i], share, x);
        }
        let input = (effort - before.planned) / g.limit;
        let input = input.max(-T::TWO).min(T::TWO);
        add(&mut next, &low.b, &high.b, share, input);
        self.expected = next;
    }

    /// A cycle without a sample: the plan's own correction and what the feedback added last.
    /// The model starts anew with the next one, as nobody knows what the drive has made of
    /// this one; the force alone is kept.
    fn without_sample(&mut self, planned: &Planned<T>) -> Correction<T> {
        let g = &self.gains;
        let force = self.estimated[g.states - 1];
        self.estimated = [T::ZERO; MOST_STATES];
        self.estimated[g.states - 1] = force;
        self.expected = self.estimated;
        self.before = None;
        self.last.used = false;
        self.last.innovation = [T::ZERO; MOST_MEASURED];
        self.last.surprise = T::INFINITY;
        let finite = |value: T| if value.is_finite() { value } else { T::ZERO };
        Correction {
            position: finite(planned.correction.position),
            command: finite(planned.correction.command + self.last.effort - self.own),
        }
    }
}
