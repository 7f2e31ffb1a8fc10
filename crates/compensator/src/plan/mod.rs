//! The plan: offsets of position and torque from the motion that is known ahead.
//!
//! For every set point the force of friction and loads is known beforehand, from it the
//! transmission's wind-up s, and from both the motor's speed and torque:
//!
//! ```text
//! F   = T_f(ω_ref)/lever + load(x)               LuGre stepped along the reference
//! s   = Gauss * (C T_t + b(T_t)/r)               T_t = r (m a + F) + J_w a/r
//! l   = −(e(θ) − e(θ₀))/r                        what an error of the kinematics asks for
//! ω_d = v/r + ṡ + l̇
//! T_d = J a/r + (r + e'(θ)) (m a + F) + (J − J_w) s̈ + J l̈
//! u   = the command with which the actuator's model has T_d a cycle later
//! ```
//!
//! and the offsets that make the drive ask for just that, its own errors being zero:
//!
//! ```text
//! position = (ω_d − f_v v/r)/P      effort = u − what the integrator holds
//! ```
//!
//! b is the side of its free travel on which the transmission lies, e the error of its
//! kinematics at the motor's angle θ ([`crate::Kinematics`]).
//!
//! [`Planner`] takes set points one by one and is [`Planner::look_ahead`] of them late;
//! [`Plan`] runs it ahead of a motion that is known.

mod actuator;
mod known;
mod smoothing;
mod target;

use lugre::{Exponential, LuGre};

pub use known::Plan;
pub use target::{HomedAt, PlanSettings, Planned, Standstill, Target};

use crate::error::{require, within};
use crate::model::{DriveModel, MOST_DELAY};
use crate::residual::{Residual, ResidualAt, ResidualModel};
use crate::warmed::warmed;
use crate::{CompensatorError, Correction, Reference};
use actuator::Inverse;
use smoothing::{MOST_HALF, Smoothing};

/// One set point with the forces along it.
#[derive(Clone, Copy, Debug, Default)]
struct Ahead<T> {
    reference: Reference<T>,
    shift: Reference<T>,
    friction: T,
    sticking: T,
    /// J a/r + (r + e') (m a + F), N·m.
    rigid: T,
    /// J − J_w, kg·m².
    inertia: T,
    /// J, kg·m².
    rotating: T,
    /// What the kinematics' error asks of the motor, rad.
    lead: T,
}

/// A set point with wind-up and torque.
#[derive(Clone, Copy, Debug, Default)]
struct Wound<T> {
    ahead: Ahead<T>,
    wind_up: T,
    motor_speed: T,
    torque: T,
}

/// An axis at rest.
struct Resting<T> {
    bristle: T,
    /// On the load, N or N·m.
    friction: T,
    /// What the motor gives against it, N·m.
    torque: T,
    wind_up: T,
}

/// Set points between the newest and the one whose wind-up is smoothed.
const AHEAD: usize = MOST_HALF + 2;
/// Those between that and the cycle that is planned.
const WOUND: usize = MOST_DELAY + 2;

/// Makes the plan of a stream of set points, one a control cycle. No allocation; 42 KB in
/// `f64`.
#[derive(Clone, Debug)]
pub struct Planner<T = f64, R = ResidualModel<T>> {
    model: DriveModel<T>,
    /// Friction of the model as it was given.
    cold: LuGre<T>,
    /// Dry and viscous friction now, as multiples of that.
    warm: [T; 2],
    half: usize,
    /// Cycles by which a command and the voltage made of it come late, whole.
    late: usize,
    /// What a part of a cycle more is.
    late_part: T,
    smoothing: Smoothing<T>,
    inverse: Inverse<T>,
    bristle: T,
    speed: T,
    ahead: [Ahead<T>; AHEAD],
    wound: [Wound<T>; WOUND],
    /// Where the rings are written next.
    ahead_at: usize,
    wound_at: usize,
    /// Set points since the start, as far as the look-ahead counts them.
    pushed: usize,
    /// Wind-up with which the position loop was homed, rad.
    home: T,
    /// What the drive's integrator holds.
    held: T,
    residual: Option<R>,
    /// Angle of the motor where the load is at 0 and nothing wound up, rad.
    zero_angle: T,
    /// Error of the kinematics at the start, m or rad at the load.
    ahead_at_start: T,
}

impl<T: Exponential> Planner<T> {
    /// For an axis as `model` has it, relaxed at position 0 until [`Planner::begin`].
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] names what no plan can be made from.
    pub fn new(
        model: &DriveModel<T>,
        settings: &PlanSettings<T>,
    ) -> Result<Self, CompensatorError> {
        model.check()?;
        let sigma = settings.smoothing / model.period;
        let most = MOST_HALF as f64 / 4.0;
        let valid = "from 0 to 48 control periods";
        require(
            within(sigma, 0.0, most),
            "smoothing",
            settings.smoothing,
            valid,
        )?;
        let half = ((T::of(4.0) * sigma).ceil().to_f64() as usize + 1).min(MOST_HALF);
        let cycles = model.delay / model.period + model.drive.late();
        let whole = cycles.floor();
        let mut planner = Self {
            model: *model,
            cold: model.friction,
            warm: [T::ONE; 2],
            half,
            late: whole.to_f64() as usize,
            late_part: cycles - whole,
            smoothing: Smoothing::new(sigma, half, model.period),
            inverse: Inverse::new(model),
            bristle: T::ZERO,
            speed: T::ZERO,
            ahead: [Ahead::default(); AHEAD],
            wound: [Wound::default(); WOUND],
            ahead_at: 0,
            wound_at: 0,
            pushed: 0,
            home: T::ZERO,
            held: T::ZERO,
            residual: None,
            zero_angle: T::ZERO,
            ahead_at_start: T::ZERO,
        };
        planner.begin(T::ZERO, &Standstill::default());
        Ok(planner)
    }

    /// With what was learned of torque and force that the model does not have.
    #[must_use]
    pub fn with_residual<R: Residual<T>>(self, residual: Option<R>) -> Planner<T, R> {
        Planner {
            model: self.model,
            cold: self.cold,
            warm: self.warm,
            half: self.half,
            late: self.late,
            late_part: self.late_part,
            smoothing: self.smoothing,
            inverse: self.inverse,
            bristle: self.bristle,
            speed: self.speed,
            ahead: self.ahead,
            wound: self.wound,
            ahead_at: self.ahead_at,
            wound_at: self.wound_at,
            pushed: self.pushed,
            home: self.home,
            held: self.held,
            residual,
            zero_angle: self.zero_angle,
            ahead_at_start: self.ahead_at_start,
        }
    }
}

/// What a planner computes with besides its model ([`Planner::constants`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannerConstants<'a, T = f64> {
    /// Set points from the smoothed one to either end of the Gaussian.
    pub half: usize,
    /// Whole cycles by which a command and the voltage made of it come late.
    pub late: usize,
    /// The part of a cycle more.
    pub late_part: T,
    /// Weights of value, rate (1/s) and second rate (1/s²), 2 `half` + 1 each, oldest first.
    pub weights: [&'a [T]; 3],
    /// Share of the torque that the actuator's lag keeps over a cycle.
    pub kept: T,
}

impl<T: Exponential, R: Residual<T>> Planner<T, R> {
    /// What it computes with besides its model, for code that is generated from it.
    pub fn constants(&self) -> PlannerConstants<'_, T> {
        PlannerConstants {
            half: self.half,
            late: self.late,
            late_part: self.late_part,
            weights: self.smoothing.weights(),
            kept: self.inverse.kept(),
        }
    }

    /// The model that it plans with.
    pub fn model(&self) -> &DriveModel<T> {
        &self.model
    }

    /// Set points that must be known beyond the present one.
    pub fn look_ahead(&self) -> usize {
        self.half + 1 + self.late_cycles()
    }

    fn late_cycles(&self) -> usize {
        self.late + usize::from(self.late_part > T::ZERO)
    }

    /// Starts anew, at rest at `position`, the drive holding what `standstill` says. Where
    /// that differs from the axis' own load, friction holds the difference: bristles are
    /// taken as deflected so far.
    pub fn begin(&mut self, position: T, standstill: &Standstill<T>) {
        let angle = standstill.motor_angle;
        let resting = self.resting(position, standstill.effort, standstill.held, angle);
        let Resting {
            friction,
            torque,
            wind_up,
            ..
        } = resting;
        self.bristle = resting.bristle;
        self.speed = T::ZERO;
        let m = &self.model;
        let section = m.along.at(position);
        let ahead = Ahead {
            reference: Reference {
                position,
                ..Reference::default()
            },
            shift: Reference::default(),
            friction,
            sticking: T::ONE,
            rigid: torque,
            inertia: section.rotating - section.lagging,
            rotating: section.rotating,
            lead: T::ZERO,
        };
        self.ahead = [ahead; AHEAD];
        self.wound = [Wound {
            ahead,
            wind_up,
            motor_speed: T::ZERO,
            torque,
        }; WOUND];
        self.smoothing.settle(wind_up);
        self.inverse.settle(torque);
        self.home = match &standstill.homed {
            Some(homed) => {
                let there = angle + (homed.position - position) / m.travel;
                self.resting(homed.position, homed.effort, None, there)
                    .wind_up
            }
            None => wind_up,
        };
        let m = &self.model;
        self.zero_angle = standstill.motor_angle - position / m.travel - wind_up;
        self.ahead_at_start = m.kinematics.ahead(standstill.motor_angle);
        self.held = standstill.effort - standstill.own;
        (self.ahead_at, self.wound_at, self.pushed) = (0, 0, 0);
    }

    /// The axis at rest at a position and an angle of the motor, the drive holding a command: bristles hold
    /// what the command has beside the load, or `held` where that is known.
    fn resting(&self, position: T, effort: T, held: Option<T>, angle: T) -> Resting<T> {
        let m = &self.model;
        let section = m.along.at(position);
        let lever = m.travel + m.kinematics.growth(angle);
        let beside = m.torque_constant() * effort / lever - section.load;
        let holding = held.unwrap_or(beside);
        let p = m.friction.parameters();
        let most = m.friction.bristle_limit();
        let bristle = if p.stiffness > T::ZERO {
            (holding * m.lever / p.stiffness).max(-most).min(most)
        } else {
            T::ZERO
        };
        let friction = m.friction.torque(bristle, T::ZERO) / m.lever;
        let force = friction + section.load;
        let rigid = m.travel * force;
        Resting {
            bristle,
            friction,
            torque: lever * force,
            wind_up: section.compliance * rigid + self.side(rigid),
        }
    }

    /// Takes the next set point. From the [`Planner::look_ahead`]th after the first on it
    /// gives the plan of the cycle that many before.
    pub fn push(&mut self, target: Target<T>) -> Option<Planned<T>> {
        let (ahead, wind_up) = self.forces(target);
        // Rings: the newest overwrites the oldest.
        let (length, at) = (self.half + 2, self.ahead_at);
        self.ahead[at] = ahead;
        self.ahead_at = (at + 1) % length;
        let [before, middle, after] = [1, 2, 3].map(|i| self.ahead[(at + i) % length]);
        // As smooth as a sine: its neighbours do for its rates.
        let period = self.model.period;
        let lead_rate = (after.lead - before.lead) / (T::TWO * period);
        let lead_second = (after.lead - T::TWO * middle.lead + before.lead) / (period * period);
        let [wind_up, rate, second] = self.smoothing.push(wind_up);
        let velocity = middle.reference.velocity + middle.shift.velocity;
        let newest = Wound {
            wind_up: wind_up + middle.lead,
            motor_speed: velocity / self.model.travel + rate + lead_rate,
            torque: middle.rigid + middle.inertia * second + middle.rotating * lead_second,
            ahead: middle,
        };
        let late = self.late_cycles();
        let (length, at) = (late + 2, self.wound_at);
        self.wound[at] = newest;
        self.wound_at = (at + 1) % length;
        if self.pushed < self.look_ahead() {
            self.pushed += 1;
            return None;
        }
        let ago = |i: usize| self.wound[(at + length - i) % length];
        Some(self.cycle(&ago(late + 1), [&ago(1), &newest]))
    }

    /// Takes friction as it is at another temperature. Factors that make no law leave it as it is.
    fn warm(&mut self, factors: [T; 2]) {
        if factors == self.warm {
            return;
        }
        if let Ok(friction) = warmed(&self.cold, factors) {
            self.model.friction = friction;
            self.warm = factors;
        }
    }

    /// Force and raw wind-up at a set point.
    fn forces(&mut self, target: Target<T>) -> (Ahead<T>, T) {
        if let Some(factors) = target.friction {
            self.warm(factors);
        }
        let m = &self.model;
        let r = &target.reference;
        let speed = r.velocity / m.lever;
        let (bristle, torque) = m
            .friction
            .step_torque(self.bristle, self.speed, speed, m.period);
        self.bristle = bristle;
        self.speed = speed;
        let section = m.along.at(r.position);
        let friction = torque / m.lever;
        let acceleration = r.acceleration + target.shift.acceleration;
        let at_motor = acceleration / m.travel;
        let mut force = m.load_inertia * acceleration + friction + section.load + target.force;
        let mut at_angle = T::ZERO;
        if let Some(residual) = &mut self.residual {
            let wind_up = section.compliance * m.travel * force;
            let [torque, besides] = residual.besides(&ResidualAt {
                motor_angle: self.zero_angle + r.position / m.travel + wind_up,
                motor_speed: r.velocity / m.travel,
                position: r.position,
                direction: m.friction.coulomb_share(bristle),
            });
            at_angle = torque;
            force += besides;
        }
        let rigid = m.travel * force;
        let transmitted = rigid + section.lagging * at_motor;
        let wind_up = section.compliance * transmitted + self.side(transmitted);
        let position = r.position + target.shift.position;
        let lead = self.lead(position, wind_up);
        let angle = self.zero_angle + position / m.travel + wind_up + lead;
        let reaction = m.kinematics.growth(angle) * force;
        let ahead = Ahead {
            reference: *r,
            shift: target.shift,
            friction,
            sticking: self.sticking(),
            rigid: section.rotating * at_motor + rigid + reaction + at_angle,
            inertia: section.rotating - section.lagging,
            rotating: section.rotating,
            lead,
        };
        (ahead, wind_up)
    }

    /// Angle by which free travel puts the motor ahead, under a torque through the
    /// transmission (N·m).
    fn side(&self, transmitted: T) -> T {
        let m = &self.model;
        if m.kinematics.free_travel == T::ZERO {
            return T::ZERO;
        }
        let level = m.travel * m.friction.parameters().coulomb / m.lever;
        m.kinematics.side(transmitted / level.max(T::MIN_POSITIVE)) / m.travel
    }

    /// Angle that the error of the kinematics asks of the motor, the load being at `position`.
    fn lead(&self, position: T, wind_up: T) -> T {
        let (k, travel) = (&self.model.kinematics, self.model.travel);
        if k.amplitude == T::ZERO {
            return T::ZERO;
        }
        let angle = self.zero_angle + position / travel + wind_up;
        let lead = |at: T| (self.ahead_at_start - k.ahead(at)) / travel;
        // The error is one of the angle with the lead: what is left shrinks by a n/r a round.
        lead(angle + lead(angle + lead(angle)))
    }

    /// χ = 1 − z/z_ss, from 0 to 1.
    fn sticking(&self) -> T {
        let steady = self.model.friction.steady_bristle(self.speed);
        if steady == T::ZERO {
            return T::ONE;
        }
        (T::ONE - self.bristle / steady).max(T::ZERO).min(T::ONE)
    }

    /// The plan of the cycle that begins at `start`. Its command acts on the torque a cycle
    /// and a delay later, which lies between the two of `late`.
    fn cycle(&mut self, start: &Wound<T>, late: [&Wound<T>; 2]) -> Planned<T> {
        let model = self.model;
        let Ahead {
            reference, shift, ..
        } = start.ahead;
        let share = if self.late_part > T::ZERO {
            self.late_part
        } else {
            T::ONE
        };
        let [before, after] = late;
        let torque = before.torque + share * (after.torque - before.torque);
        let current = match self.late_cycles() {
            0 => self.inverse.effort_now(),
            _ => start.torque / model.torque_constant(),
        };
        let mean = T::HALF * (before.motor_speed + after.motor_speed);
        let commanded = self.inverse.towards(torque, mean);
        let c = &model.cascade;
        let fed = c.velocity_feedforward * reference.velocity / model.travel;
        let mut position = shift.position;
        if c.position > T::ZERO {
            position += (start.motor_speed - fed) / c.position;
        }
        if c.from_motor {
            position += model.travel * (start.wind_up - self.home);
        }
        let effort =
            commanded.effort - self.held - c.acceleration_feedforward * reference.acceleration;
        Planned {
            reference,
            position: reference.position + shift.position,
            motor_speed: start.motor_speed,
            wind_up: start.wind_up,
            home: self.home,
            torque: start.torque,
            friction: start.ahead.friction,
            sticking: start.ahead.sticking,
            current,
            effort: commanded.effort,
            limited: commanded.limited,
            correction: Correction {
                position,
                command: effort,
            },
        }
    }
}
