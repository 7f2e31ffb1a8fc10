//! The machine in motion.

use std::fmt;
use std::sync::Arc;

use feed_dynamics::{NutErrors, TableMotion, TimeStepper};

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
        let mut errors = NutErrors::new(0.0, 0.0, law.assembly.backlash)?;
        for _ in 0..steps {
            let drive = self.drive_torque(law, stepper.step_length(), actuator, &mut errors)?;
            self.step(law, stepper, &drive, &errors)?;
        }
        Ok(())
    }

    /// What the actuator gives over a step of `h` seconds, at the mean motor speed of the step, and the
    /// transmission's kinematic errors (`errors`) at its end.
    #[inline]
    fn drive_torque(
        &self,
        law: &Law<S>,
        h: f64,
        actuator: &mut dyn Actuating,
        errors: &mut NutErrors,
    ) -> Result<DriveTorque, AdvanceError> {
        let (start, hooks) = (&self.seen, &law.assembly.hooks);
        let mean_speed = start.motor_speed + 0.5 * h * self.motor_acceleration;
        let own = actuator.torque(
            &MotorMotion {
                angle: start.motor_angle,
                speed: mean_speed,
            },
            h,
        );
        let angle = start.motor_angle + h * mean_speed;
        let motor = hooks.torque_at(angle, own);
        let mut at_drive = motor;
        if hooks.has_offsets() {
            let force = start.transmission_force + self.force_change;
            let at = start.screw(start.time + h, angle, force);
            let (there, reaction) = law.errors(&at, self.offset_origin)?;
            *errors = there;
            at_drive += reaction;
        }
        Ok(DriveTorque { motor, at_drive })
    }

    /// One step of the mechanics; the friction follows the load's speed at the end of the step.
    #[inline]
    fn step(
        &mut self,
        law: &Law<S>,
        stepper: &S,
        torque: &DriveTorque,
        errors: &NutErrors,
    ) -> Result<(), AdvanceError> {
        let (start, h) = (self.seen, stepper.step_length());
        let time = start.time + h;
        let rise = if self.loaded { 0.0 } else { STANDING_LOAD_RISE };
        let hooks = &law.assembly.hooks;
        let load_of = LoadAtEnd {
            law,
            h,
            start,
            start_speed: law.by_lever(start.speed),
            contact: self.contact,
            bristle: self.bristle,
            unit_bristle: self.unit_bristle,
            origin: self.origin,
            travelled: self.travelled,
            outer: self.outer_load,
            loaded: (time / rise).min(1.0),
            has_loads: hooks.has_loads() || !law.assembly.loads.is_empty(),
        };
        let memory = &mut self.memory;
        let mut end = load_of.untried();
        let report = stepper.step_through(&mut self.drive, torque.at_drive, errors, |table| {
            end = load_of.tried(&table, memory);
            end.force
        });
        if !report.load.converged {
            return Err(AdvanceError::LoadNotFound {
                rounds: report.load.rounds,
                residual: report.load.residual,
            });
        }
        self.bristle = end.bristle;
        self.contact = end.contact;
        self.unit_bristle = end.unit_bristle;
        self.seen = Seen::of(
            &stepper.observe(&self.drive),
            [self.origin, self.motor_origin],
            time,
            torque.motor,
            end.force,
        );
        self.motor_acceleration = (self.seen.motor_speed - start.motor_speed) / h;
        if load_of.has_loads {
            self.memory.accept();
            self.travelled += (self.seen.displacement - start.displacement).abs();
        }
        self.force_change = self.seen.transmission_force - start.transmission_force;
        Ok(())
    }
}

/// Torque of the motor, and with it what the transmission's errors add at the drive, N·m or N.
struct DriveTorque {
    motor: f64,
    at_drive: f64,
}

/// The force on the load at the end of a step, as a function of the motion there.
struct LoadAtEnd<'a, S> {
    law: &'a Law<S>,
    /// Length of the step, s.
    h: f64,
    start: Seen,
    /// Speed at the start, in the friction's coordinate; so are the bristles there.
    start_speed: f64,
    contact: Option<ContactState>,
    bristle: f64,
    unit_bristle: f64,
    origin: f64,
    travelled: f64,
    outer: f64,
    /// Share of the constant loads that acts.
    loaded: f64,
    has_loads: bool,
}

/// That force at one motion of the load, and what friction remembers if the step ends so.
struct TriedLoad {
    force: f64,
    bristle: f64,
    unit_bristle: f64,
    contact: Option<ContactState>,
}

impl<S: TimeStepper> LoadAtEnd<'_, S> {
    /// What friction remembers at the start.
    fn untried(&self) -> TriedLoad {
        TriedLoad {
            force: 0.0,
            bristle: self.bristle,
            unit_bristle: self.unit_bristle,
            contact: self.contact,
        }
    }

    #[inline]
    fn tried(&self, table: &TableMotion, memory: &mut Memory) -> TriedLoad {
        let (law, h) = (self.law, self.h);
        let (friction, hooks) = (&law.assembly.friction, &law.assembly.hooks);
        let speeds = [self.start_speed, law.by_lever(table.speed)];
        let mut end = self.untried();
        let own = match (&friction.contact, self.contact) {
            (Some(law), Some(state)) => {
                let (state, own) = law.step(&state, speeds, h);
                end.contact = Some(state);
                own
            }
            _ => {
                let (z, own) = friction
                    .law
                    .step_torque(self.bristle, speeds[0], speeds[1], h);
                end.bristle = z;
                own
            }
        };
        end.force = law.by_lever(own) + self.outer;
        if !self.has_loads {
            return end;
        }
        let mut bristle = 0.0;
        if law.moves_bristle {
            end.unit_bristle = friction
                .unit
                .step(self.unit_bristle, speeds[0], speeds[1], h);
            bristle = friction.unit.torque(end.unit_bristle, speeds[1]);
        }
        let start = &self.start;
        let at = TableState {
            time: start.time + h,
            position: self.origin + table.displacement,
            speed: table.speed,
            bristle,
            loaded: self.loaded,
            transmitted: start.transmission_force,
            travelled: self.travelled,
        };
        end.force += hooks.loads_at(&at) + law.loads_at(&at);
        if !hooks.memories().is_empty() {
            let step = TableStep {
                length: h,
                travel: table.displacement - start.displacement,
                speed_before: start.speed,
                speed: table.speed,
            };
            end.force += hooks.memories().step(&step, memory);
        }
        end
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
