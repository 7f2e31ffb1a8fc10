//! Time stepping of the elastic drive: Newmark's average acceleration (γ = ½,
//! β = ¼; Newmark, J. Eng. Mech. Div. 85 (1959) 67–94).
//!
//! Second order and stable for every stiffness and step; without damping it keeps
//! the energy of a constant stiffness exactly. Its price is a period longer by
//! (ωh)²/12 of itself. A closed form of the free motion would not have that, but
//! holds for one stiffness and a closed contact only; here k(x) changes with every
//! step, and the flanks of a gap part and meet.
//!
//! Where they do, half of a force that was not there at the start, or is gone at the
//! end, would throw the flanks apart faster than they met. Over such a step the
//! end's force acts alone, as in Euler's implicit method, which only takes energy
//! (Kane, Repetto, Ortiz, Marsden, Comput. Methods Appl. Mech. Eng. 180 (1999) 1–26).
//! It is one step for each time they meet or part, so the order stays.
//!
//! The coordinates are the load's displacement y and the compression δ = rθ − y,
//! not θ: the force k δ then keeps its digits however far the axis travels.

use super::ElasticDrive;
use super::average_acceleration::Course;
use super::step_end::{Ahead, Share, Transmission};
use crate::stepper::{check_step, find_load_within};
use crate::{
    DriveError, LoadSearch, NutErrors, Observation, Settled, StepReport, TableMotion, TimeStepper,
};

/// An elastic drive for steps of one length.
///
/// The stiffness is held over a step at the position that speed and acceleration
/// at its start lead to. The load may be anywhere: [`StepReport::on_screw`] is
/// always true.
#[derive(Clone, Debug)]
pub struct ElasticStepper {
    pub(super) drive: ElasticDrive,
    pub(super) step: f64,
    /// 1/m, 1/kg.
    pub(super) load_mobility: f64,
    /// 1/m + r²/J, 1/kg.
    pub(super) mobility: f64,
    /// 1/r.
    radians_per_travel: f64,
    /// r/J: what a newton metre of the motor adds to δ̈.
    pub(super) per_torque: f64,
    /// The transmission where its stiffness is the same everywhere.
    pub(super) constant: Option<Transmission>,
    /// Most by which the load changes with the end speed, N·s/m.
    steepest_load: f64,
}

/// State of an [`ElasticStepper`].
#[derive(Clone, Debug)]
pub struct ElasticState {
    pub(super) origin: f64,
    /// The load's displacement, m.
    pub(super) y: Course,
    /// δ = rθ − y, without errors of the kinematics, m.
    pub(super) compression: Course,
    /// Errors at the end of the last step.
    pub(super) errors: NutErrors,
    /// On the load, N.
    pub(super) force: f64,
    /// −1 or 1 where spring and damper press the flank on that side, otherwise 0.
    pub(super) flank: f64,
    pub(super) load: f64,
    pub(super) load_before: f64,
}

impl ElasticStepper {
    /// Prepares steps of `step` seconds.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] if the step is not above zero and at most 1 s.
    pub fn new(drive: &ElasticDrive, step: f64) -> Result<Self, DriveError> {
        check_step(step)?;
        let p = drive.parameters();
        let mut stepper = Self {
            step,
            load_mobility: 1.0 / p.load_inertia,
            mobility: drive.inverse_inertia(),
            radians_per_travel: 1.0 / p.travel_per_radian,
            per_torque: p.travel_per_radian / p.motor_inertia,
            constant: None,
            steepest_load: f64::INFINITY,
            drive: drive.clone(),
        };
        let stiffness = p.stiffness.constant();
        stepper.constant = stiffness.map(|k| Transmission::new(&stepper, k));
        Ok(stepper)
    }

    /// A step in which the force has the given share.
    #[inline]
    fn advance(
        &self,
        state: &mut ElasticState,
        torque: f64,
        errors: &NutErrors,
        share: Share,
        load: impl FnMut(TableMotion) -> f64,
    ) -> LoadSearch {
        let ahead = Ahead::new(self, state, torque, errors, share);
        let motion = |load: f64| {
            let y = ahead.load_course(load, ahead.force(load));
            TableMotion {
                displacement: y.value,
                speed: y.rate,
            }
        };
        let guess = 2.0 * state.load - state.load_before;
        let give = 0.5 * self.step * self.load_mobility;
        let (load, mut found) = find_load_within(self.steepest_load, guess, give, motion, load);
        ahead.finish(state, load);
        found.converged &= state.compression.value.is_finite();
        found
    }

    /// A step through a gap: see the module's notes on flanks that meet and part.
    #[inline]
    fn through_gap(
        &self,
        state: &mut ElasticState,
        torque: f64,
        errors: &NutErrors,
        mut load: impl FnMut(TableMotion) -> f64,
    ) -> LoadSearch {
        let mut rounds = 0;
        if state.flank != 0.0 {
            let start = state.clone();
            let found = self.advance(state, torque, errors, Share::average(self.step), &mut load);
            if state.flank == start.flank {
                return found;
            }
            *state = start;
            rounds = found.rounds;
        }
        let mut found = self.advance(state, torque, errors, Share::implicit(self.step), load);
        found.rounds += rounds;
        found
    }
}

impl TimeStepper for ElasticStepper {
    type State = ElasticState;

    fn with_steepest_load(self, steepness: f64) -> Self {
        Self {
            steepest_load: steepness,
            ..self
        }
    }

    fn step_length(&self) -> f64 {
        self.step
    }

    fn of_length(&self, step: f64) -> Result<Self, DriveError> {
        Self::new(&self.drive, step)
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
            y: Course {
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
            flank: 0.0,
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
        let load = if errors.gap() == 0.0 {
            self.advance(state, torque, errors, Share::average(self.step), load)
        } else {
            self.through_gap(state, torque, errors, load)
        };
        StepReport {
            load,
            on_screw: true,
        }
    }

    fn observe(&self, state: &ElasticState) -> Observation {
        let (y, compression) = (&state.y, &state.compression);
        Observation {
            motor_angle: (y.value + compression.value) * self.radians_per_travel,
            motor_speed: (y.rate + compression.rate) * self.radians_per_travel,
            displacement: y.value,
            speed: y.rate,
            transmission_force: state.force,
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
