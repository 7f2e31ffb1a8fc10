//! Time stepping of the elastic drive: Newmark's average acceleration (γ = ½,
//! β = ¼; Newmark, J. Eng. Mech. Div. 85 (1959) 67–94).
//!
//! Second order and stable for every stiffness and step; without damping it keeps
//! the energy of a constant stiffness exactly. Its price is a period longer by
//! (ωh)²/12 of itself. A closed form of the free motion would not have that, but
//! holds for one stiffness and a closed contact only; here k(x) changes with every
//! step, and the flanks of a gap part and meet.
//!
//! The coordinates are the load's displacement y and the compression δ = rθ − y,
//! not θ: the force k δ then keeps its digits however far the axis travels.

use super::ElasticDrive;
use crate::stepper::{Contact, check_step};
use crate::{
    DriveError, NutErrors, Observation, Settled, StepReport, TableMotion, TimeStepper, find_load,
};

/// An elastic drive for steps of one length.
///
/// The stiffness is held over a step at the position that speed and acceleration
/// at its start lead to. The load may be anywhere: [`StepReport::on_screw`] is
/// always true.
#[derive(Clone, Debug)]
pub struct ElasticStepper {
    drive: ElasticDrive,
    step: f64,
    /// 1/m, 1/kg.
    load_mobility: f64,
    /// 1/m + r²/J, 1/kg.
    mobility: f64,
    /// r/J: what a newton metre of the motor adds to δ̈.
    per_torque: f64,
}

/// Value, rate and acceleration of a coordinate.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    value: f64,
    rate: f64,
    acceleration: f64,
}

/// State of an [`ElasticStepper`].
#[derive(Clone, Debug)]
pub struct ElasticState {
    origin: f64,
    /// y, m.
    load_course: Course,
    /// δ = rθ − y, without errors of the kinematics, m.
    compression: Course,
    /// Errors at the end of the last step.
    errors: NutErrors,
    force: f64,
    load: f64,
    load_before: f64,
}

impl ElasticStepper {
    /// Prepares steps of `step` seconds.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] where the step is not above zero and at most 1 s.
    pub fn new(drive: &ElasticDrive, step: f64) -> Result<Self, DriveError> {
        check_step(step)?;
        let p = drive.parameters();
        Ok(Self {
            step,
            load_mobility: 1.0 / p.load_inertia,
            mobility: drive.mobility(),
            per_torque: p.travel_per_radian / p.motor_inertia,
            drive: drive.clone(),
        })
    }

    /// The contact at the end of a step that leads to `x`.
    fn contact(&self, x: f64, errors: &NutErrors) -> Contact {
        let p = self.drive.parameters();
        let stiffness = p.stiffness.at(x);
        Contact {
            stiffness,
            damping: stiffness * p.stiffness_damping,
            travel: 0.25 * self.step * self.step * self.mobility,
            speed: 0.5 * self.step * self.mobility,
            half_gap: 0.5 * errors.gap(),
        }
    }
}

impl Course {
    /// All that the start tells of the end of a step of `h`.
    fn predicted(self, h: f64) -> Self {
        let known = Self {
            acceleration: 0.0,
            ..self
        };
        let moved = Self {
            value: known.value + h * known.rate,
            ..known
        };
        moved.accelerated(h, self.acceleration)
    }

    /// With what an acceleration at one end of a step of `h` adds.
    fn accelerated(self, h: f64, acceleration: f64) -> Self {
        Self {
            value: self.value + 0.25 * h * h * acceleration,
            rate: self.rate + 0.5 * h * acceleration,
            acceleration,
        }
    }
}

impl TimeStepper for ElasticStepper {
    type State = ElasticState;

    fn step_length(&self) -> f64 {
        self.step
    }

    fn travel_per_radian(&self) -> f64 {
        self.drive.parameters().travel_per_radian
    }

    fn settled_torque(&self, _: f64, motion: &Settled) -> f64 {
        let p = self.drive.parameters();
        let force = p.load_inertia * motion.acceleration + motion.load;
        p.motor_inertia * motion.acceleration / p.travel_per_radian + p.travel_per_radian * force
    }

    fn settled(&self, x: f64, motion: &Settled) -> Result<ElasticState, DriveError> {
        self.drive.check_position(x)?;
        motion.check()?;
        let p = self.drive.parameters();
        let force = p.load_inertia * motion.acceleration + motion.load;
        Ok(ElasticState {
            origin: x,
            load_course: Course {
                value: 0.0,
                rate: motion.speed,
                acceleration: motion.acceleration,
            },
            compression: Course {
                value: force / p.stiffness.at(x),
                ..Course::default()
            },
            errors: NutErrors::default(),
            force,
            load: motion.load,
            load_before: motion.load,
        })
    }

    fn step_through(
        &self,
        state: &mut ElasticState,
        torque: f64,
        errors: &NutErrors,
        load: impl FnMut(TableMotion) -> f64,
    ) -> StepReport {
        let h = self.step;
        let y = state.load_course.predicted(h);
        let compression = state.compression.predicted(h);
        let contact = self.contact(state.origin + y.value, errors);

        // The contact's law on the end values, which are linear in its force and in
        // the load.
        let driven = self.per_torque * torque;
        let force = |load: f64| {
            let free = compression.accelerated(h, driven + self.load_mobility * load);
            contact.force(
                free.value + errors.offset(),
                free.rate + errors.offset_rate(),
            )
        };
        let end = |load: f64| y.accelerated(h, self.load_mobility * (force(load) - load));
        let motion = |load: f64| TableMotion {
            displacement: end(load).value,
            speed: end(load).rate,
        };
        let guess = 2.0 * state.load - state.load_before;
        let (end_load, mut found) = find_load(guess, 0.5 * h * self.load_mobility, motion, load);

        state.load_course = end(end_load);
        state.force = force(end_load);
        let free = driven + self.load_mobility * end_load;
        state.compression = compression.accelerated(h, free - self.mobility * state.force);
        state.errors = *errors;
        state.load_before = state.load;
        state.load = end_load;
        found.converged &= state.compression.value.is_finite();
        StepReport {
            load: found,
            on_screw: true,
        }
    }

    fn observe(&self, state: &ElasticState) -> Observation {
        let r = self.travel_per_radian();
        let (y, compression) = (&state.load_course, &state.compression);
        Observation {
            motor_angle: (y.value + compression.value) / r,
            motor_speed: (y.rate + compression.rate) / r,
            displacement: y.value,
            speed: y.rate,
            nut_force: state.force,
        }
    }

    fn energy(&self, state: &ElasticState) -> f64 {
        let p = self.drive.parameters();
        let seen = self.observe(state);
        let stiffness = p.stiffness.at(state.origin + seen.displacement);
        let strain = state.errors.strain(state.compression.value);
        0.5 * (p.motor_inertia * seen.motor_speed * seen.motor_speed
            + p.load_inertia * seen.speed * seen.speed
            + stiffness * strain * strain)
    }
}
