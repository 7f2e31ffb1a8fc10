//! The machine as a motion begins.

use std::fmt;
use std::sync::Arc;

use feed_dynamics::{DriveError, Observation, TimeStepper};

use super::law::Law;
use super::state::State;
use super::{Plant, Running, Seen, Start};

impl<S> Plant for Law<S>
where
    S: TimeStepper + fmt::Debug + Send + Sync + 'static,
    S::State: fmt::Debug + Send + Sync + 'static,
{
    fn start(self: Arc<Self>, start: &Start) -> Result<Box<dyn Running>, DriveError> {
        let motion = self.settled(start);
        let drive = self.stepper.settled(start.position, &motion)?;
        let at = self.stepper.observe(&drive);
        let [bristle, unit_bristle] = self.bristles(start);
        let mut state = State {
            origin: start.position,
            motor_origin: start.position / self.travel,
            offset_origin: 0.0,
            bristle,
            contact: self.contact(start),
            unit_bristle,
            memory: self.assembly.hooks.memories().settled(start).0,
            travelled: 0.0,
            outer_load: 0.0,
            force_change: 0.0,
            motor_acceleration: start.acceleration / self.travel,
            loaded: Self::is_loaded(start),
            seen: Seen::default(),
            law: self,
            drive,
        };
        let origins = [state.origin, state.motor_origin];
        let ([offset, _, growth], force) = state.law.kinematics(start, &at);
        state.offset_origin = offset;
        let law = &state.law;
        let torque = law.stepper.settled_torque(start.position, &motion) + growth * force;
        state.seen = Seen::of(&at, origins, start.time, torque, motion.load);
        Ok(Box::new(state))
    }

    fn torque(&self, start: &Start) -> f64 {
        let motion = self.settled(start);
        let torque = self.stepper.settled_torque(start.position, &motion);
        if !self.assembly.hooks.has_offsets() {
            return torque;
        }
        let drive = self.stepper.settled(start.position, &motion);
        drive.map_or(torque, |drive| {
            let ([.., growth], force) = self.kinematics(start, &self.stepper.observe(&drive));
            torque + growth * force
        })
    }
}

impl<S: TimeStepper> Law<S> {
    /// Displacement of the transmission's errors at the start, its rate and its growth with the motor's angle
    /// ([`crate::effects::Changes::offset`]), and the force of the transmission there.
    fn kinematics(&self, start: &Start, at: &Observation) -> ([f64; 3], f64) {
        let origins = [start.position, start.position / self.travel];
        let seen = Seen::of(at, origins, start.time, 0.0, 0.0);
        let force = seen.transmission_force;
        let screw = seen.screw(start.time, seen.motor_angle, force);
        (self.assembly.hooks.offset_at(&screw), force)
    }
}
