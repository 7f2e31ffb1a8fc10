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

use super::average_acceleration::Course;
use super::prepared::{ElasticState, ElasticStepper};
use super::step_end::Ahead;
use super::transmission::Share;
use crate::stepper::find_load_within;
use crate::{
    DriveError, LoadSearch, NutErrors, Observation, Settled, StepReport, TableMotion, TimeStepper,
};

impl ElasticStepper {
    /// A step to what lies ahead of this state.
    #[inline]
    fn advance(
        &self,
        state: &mut ElasticState,
        ahead: Ahead<'_>,
        load: impl FnMut(TableMotion) -> f64,
    ) -> LoadSearch {
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
            let ahead = Ahead::new(self, state, torque, errors, Share::average(self.step));
            let found = self.advance(state, ahead, &mut load);
            if state.flank == start.flank {
                return found;
            }
            *state = start;
            rounds = found.rounds;
        }
        let ahead = Ahead::new(self, state, torque, errors, Share::implicit(self.step));
        let mut found = self.advance(state, ahead, load);
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
            let ahead = Ahead::new(self, state, torque, errors, Share::average(self.step));
            self.advance(state, ahead, load)
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
