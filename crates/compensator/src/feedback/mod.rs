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
//! The drive is untouched. The offset of the position
//!
//! ```text
//! position = (ω_m − f_v v_ref/r)/P − (S_ref − S)
//! ```
//!
//! makes its speed error zero, so that its proportional part gives nothing and its integrator
//! holds what it has; the offset of the command is the plan's and u.

#[cfg(feature = "design")]
mod design;
mod gains;
mod with_plan;

use scalar::Scalar;

use crate::plan::Planned;
use crate::{Correction, Sample};
#[cfg(feature = "design")]
pub use design::{DesignError, FeedbackDesign, FeedbackSettings, Margins, Variation};
use gains::{Gains, States, add, dot};
pub use with_plan::PlanWithFeedback;

/// Most states of a feedback's model.
pub const MOST_STATES: usize = 12;
/// Most measurements: position, motor speed, q current.
pub const MOST_MEASURED: usize = 3;
/// Values of χ at which gains are held.
const NODES: usize = 7;

/// What a feedback believes of the axis' deviations from the plan, after a cycle's sample.
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
    /// (rad/s), q current (A; 0 where it is not measured).
    pub innovation: [T; MOST_MEASURED],
    /// Command that the feedback adds to the plan's, in the actuator's unit, as far as the
    /// actuator's limit lets it.
    pub effort: T,
    /// Whether the sample was used; one that is not finite is not.
    pub used: bool,
}

/// Observer and state feedback around a plan. No allocation; 13 KB in `f64`, 6.5 KB in `f32`.
#[derive(Clone, Debug, PartialEq)]
pub struct Feedback<T = f64> {
    gains: Gains<T>,
    /// x̄: what is expected of the coming cycle.
    expected: States<T>,
    /// x̂ after the last sample.
    estimated: States<T>,
    /// Wind-up along the plan at the start: where the motor's angle was set to the load.
    home: Option<T>,
    last: Deviations<T>,
}

impl<T: Scalar> Feedback<T> {
    #[cfg(feature = "design")]
    fn new(gains: Gains<T>) -> Self {
        Self {
            gains,
            expected: [T::ZERO; MOST_STATES],
            estimated: [T::ZERO; MOST_STATES],
            home: None,
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
            home: None,
            last: Deviations::default(),
        }
    }

    /// Forgets everything: the next sample is the first of a motion from rest.
    pub fn reset(&mut self) {
        self.expected = [T::ZERO; MOST_STATES];
        self.estimated = self.expected;
        self.home = None;
        self.last = Deviations::default();
    }

    /// What it believed in the last cycle.
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
        let home = *self.home.get_or_insert(planned.wind_up);
        let g = &self.gains;
        let c = &g.cascade;
        let mut expected_position = planned.position;
        if c.from_motor {
            expected_position += g.travel * (planned.wind_up - home);
        }
        let deviations = [
            sample.position - expected_position,
            sample.motor_speed - planned.motor_speed,
            sample.iq - planned.current,
        ];
        let used = deviations[..g.measured].iter().all(|y| y.is_finite())
            && planned.sticking.is_finite()
            && planned.effort.is_finite();
        if !used {
            return self.without_sample(planned);
        }
        let (low, high, share) = g.around(planned.sticking);
        let mut x = self.expected;
        let mut innovation = [T::ZERO; MOST_MEASURED];
        for i in 0..g.measured {
            innovation[i] = deviations[i] - dot(&g.c[i], &self.expected);
            add(&mut x, &low.l[i], &high.l[i], share, innovation[i]);
        }
        let feedback = dot(&low.k, &x) + share * (dot(&high.k, &x) - dot(&low.k, &x));
        let effort = (planned.effort - g.limit * feedback)
            .max(-g.limit)
            .min(g.limit)
            - planned.effort;
        let mut next = [T::ZERO; MOST_STATES];
        for i in 0..g.states {
            add(&mut next, &low.a[i], &high.a[i], share, x[i]);
        }
        add(&mut next, &low.b, &high.b, share, effort / g.limit);
        if !(effort.is_finite() && next.iter().all(|x| x.is_finite())) {
            self.expected = [T::ZERO; MOST_STATES];
            return self.without_sample(planned);
        }
        self.last = Deviations {
            load: dot(&g.load[0], &x),
            load_speed: dot(&g.load[1], &x),
            force: g.force * x[g.states - 1],
            innovation,
            effort,
            used: true,
        };
        let fed = c.velocity_feedforward * sample.reference.velocity / g.travel;
        let position =
            (sample.motor_speed - fed) / c.position - (sample.reference.position - sample.position);
        self.expected = next;
        self.estimated = x;
        Correction {
            position,
            iq: planned.correction.iq + effort,
        }
    }

    /// A cycle without a sample: the plan's own correction, and the model left as it was but
    /// for the force, as nobody knows what the drive made of such a sample.
    fn without_sample(&mut self, planned: &Planned<T>) -> Correction<T> {
        self.last.used = false;
        self.last.innovation = [T::ZERO; MOST_MEASURED];
        let finite = |value: T| if value.is_finite() { value } else { T::ZERO };
        Correction {
            position: finite(planned.correction.position),
            iq: finite(planned.correction.iq + self.last.effort),
        }
    }
}
