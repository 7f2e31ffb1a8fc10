//! The machine as a motion begins.

use std::fmt;
use std::sync::Arc;

use feed_dynamics::{DriveError, TimeStepper};

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
        let torque = self.stepper.settled_torque(start.position, &motion);
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
        state.seen = Seen::of(&at, origins, start.time, torque, motion.load);
        let (angle, force) = (state.seen.motor_angle, state.seen.transmission_force);
        let screw = state.seen.screw(start.time, angle, force);
        let [offset, _] = state.law.assembly.hooks.offset_at(&screw);
        state.offset_origin = offset;
        Ok(Box::new(state))
    }

    fn torque(&self, start: &Start) -> f64 {
        let motion = self.settled(start);
        self.stepper.settled_torque(start.position, &motion)
    }
}
