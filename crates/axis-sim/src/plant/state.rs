//! The machine in motion.

use std::fmt;
use std::sync::Arc;

use feed_dynamics::{NutErrors, TimeStepper};

use super::law::{Law, coulomb_bristle};
use super::{AdvanceError, Running, Seen};
use crate::actuator::{Actuating, MotorMotion};
use crate::effects::{Memory, TableState, TableStep};
use crate::friction::ContactState;

/// Time over which a constant load comes up, s.
const STANDING_LOAD_RISE: f64 = 0.02;

/// The machine's inner state, which no controller sees.
pub(super) struct State<S: TimeStepper> {
    pub(super) law: Arc<Law<S>>,
    pub(super) drive: S::State,
    /// Where the load and the motor were when the motion began.
    pub(super) origin: f64,
    pub(super) motor_origin: f64,
    /// Displacement of the transmission's kinematic errors there.
    pub(super) offset_origin: f64,
    /// Bristle deflection z, in the friction's coordinate.
    pub(super) bristle: f64,
    /// What a law that is not LuGre remembers.
    pub(super) contact: Option<ContactState>,
    /// That of the unit element.
    pub(super) unit_bristle: f64,
    /// What forces with a memory remember.
    pub(super) memory: Memory,
    /// Way that the load has travelled since the motion began, m or rad.
    pub(super) travelled: f64,
    /// Force from outside, N or N·m.
    pub(super) outer_load: f64,
    /// Change of the transmission's force over the last step, N or N·m.
    pub(super) force_change: f64,
    /// Motor acceleration over the last step, rad/s².
    pub(super) motor_acceleration: f64,
    /// Whether constant loads act from the start on.
    pub(super) loaded: bool,
    pub(super) seen: Seen,
}

impl<S: TimeStepper> Clone for State<S> {
    fn clone(&self) -> Self {
        Self {
            law: self.law.clone(),
            drive: self.drive.clone(),
            memory: self.memory.clone(),
            ..*self
        }
    }
}

impl<S: TimeStepper> fmt::Debug for State<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.seen.fmt(f)
    }
}

impl<S: TimeStepper> State<S> {
    /// Runs on by `steps` steps of `stepper`, which is `law`'s or one of another length.
    fn run_on(
        &mut self,
        law: &Law<S>,
        stepper: &S,
        steps: u32,
        actuator: &mut dyn Actuating,
    ) -> Result<(), AdvanceError> {
        let assembly = &law.assembly;
        let (friction, hooks) = (&assembly.friction, &assembly.hooks);
        let h = stepper.step_length();
        let has_loads = hooks.has_loads() || !assembly.loads.is_empty();
        let rise = if self.loaded { 0.0 } else { STANDING_LOAD_RISE };
        let mut errors = NutErrors::new(0.0, 0.0, assembly.backlash)?;
        for _ in 0..steps {
            // The actuator, over the mean motor speed of the step.
            let start = self.seen;
            let mean_speed = start.motor_speed + 0.5 * h * self.motor_acceleration;
            let own = actuator.torque(
                &MotorMotion {
                    angle: start.motor_angle,
                    speed: mean_speed,
                },
                h,
            );
            let time = start.time + h;
            let angle = start.motor_angle + h * mean_speed;
            let torque = hooks.torque_at(angle, own);

            // Mechanics; the friction follows the load's speed at the end of the step.
            let mut at_drive = torque;
            if hooks.has_offsets() {
                let force = start.transmission_force + self.force_change;
                let at = start.screw(time, angle, force);
                let (there, reaction) = law.errors(&at, self.offset_origin)?;
                errors = there;
                at_drive += reaction;
            }
            let (z0, u0, w0) = (self.bristle, self.unit_bristle, law.by_lever(start.speed));
            let (origin, travelled, memory) = (self.origin, self.travelled, &mut self.memory);
            let outer_load = self.outer_load;
            let loaded = (time / rise).min(1.0);
            let (mut z1, mut u1, mut end_load) = (z0, u0, 0.0);
            let contact = self.contact;
            let mut next_contact = contact;
            let report = stepper.step_through(&mut self.drive, at_drive, &errors, |table| {
                let w1 = law.by_lever(table.speed);
                let own = match (&friction.contact, contact) {
                    (Some(law), Some(state)) => {
                        let (state, own) = law.step(&state, [w0, w1], h);
                        next_contact = Some(state);
                        own
                    }
                    _ => {
                        let (z, own) = friction.law.step_torque(z0, w0, w1, h);
                        z1 = z;
                        own
                    }
                };
                let mut load = law.by_lever(own) + outer_load;
                if has_loads {
                    let mut bristle = 0.0;
                    if law.moves_bristle {
                        u1 = friction.unit.step(u0, w0, w1, h);
                        bristle = friction.unit.torque(u1, w1);
                    }
                    let at = TableState {
                        time,
                        position: origin + table.displacement,
                        speed: table.speed,
                        bristle,
                        loaded,
                        transmitted: start.transmission_force,
                        travelled,
                    };
                    load += hooks.loads_at(&at) + law.loads_at(&at);
                    if !hooks.memories().is_empty() {
                        let step = TableStep {
                            length: h,
                            travel: table.displacement - start.displacement,
                            speed_before: start.speed,
                            speed: table.speed,
                        };
                        load += hooks.memories().step(&step, memory);
                    }
                }
                end_load = load;
                load
            });
            if !report.load.converged {
                return Err(AdvanceError::LoadNotFound {
                    rounds: report.load.rounds,
                    residual: report.load.residual,
                });
            }
            self.bristle = z1;
            self.contact = next_contact;
            self.unit_bristle = u1;
            let origins = [self.origin, self.motor_origin];
            self.seen = Seen::of(
                &stepper.observe(&self.drive),
                origins,
                time,
                torque,
                end_load,
            );
            self.motor_acceleration = (self.seen.motor_speed - start.motor_speed) / h;
            if has_loads {
                self.memory.accept();
                self.travelled += (self.seen.displacement - start.displacement).abs();
            }
            self.force_change = self.seen.transmission_force - start.transmission_force;
        }
        Ok(())
    }
}

impl<S> Running for State<S>
where
    S: TimeStepper + fmt::Debug + Send + Sync + 'static,
    S::State: fmt::Debug + Send + Sync + 'static,
{
    fn advance(&mut self, actuator: &mut dyn Actuating) -> Result<(), AdvanceError> {
        let law = self.law.clone();
        self.run_on(&law, &law.stepper, law.assembly.substeps, actuator)
    }

    fn advance_part(
        &mut self,
        share: f64,
        actuator: &mut dyn Actuating,
    ) -> Result<(), AdvanceError> {
        let law = self.law.clone();
        let (length, travel) = (law.stepper.step_length(), law.travel);
        let steps = share * f64::from(law.assembly.substeps);
        let count = (steps * (1.0 - 1e-9)).ceil().max(1.0);
        let length = length * steps / count;
        let stepper = law.stepper.of_length(length)?;
        let stepper = stepper.with_steepest_load(law.assembly.steepness(length, travel));
        self.run_on(&law, &stepper, count as u32, actuator)
    }

    fn seen(&self) -> &Seen {
        &self.seen
    }

    fn set_outer_load(&mut self, force: f64) {
        self.outer_load = force;
    }

    fn copy(&self) -> Box<dyn Running> {
        Box::new(self.clone())
    }

    fn energy(&self) -> f64 {
        self.law.stepper.energy(&self.drive)
    }

    fn friction(&self) -> [f64; 2] {
        let friction = &self.law.assembly.friction;
        let (law, speed) = (&friction.law, self.seen.speed / self.law.lever);
        let [force, share] = match (&friction.contact, &self.contact) {
            (Some(contact), Some(state)) => [contact.force(state, speed), contact.share(state)],
            _ => [
                law.torque(self.bristle, speed),
                self.bristle / coulomb_bristle(law),
            ],
        };
        [force / self.law.lever, share]
    }
}
