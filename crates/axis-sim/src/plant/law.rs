//! Mechanism, friction and loads put together, and settled.

use std::fmt;
use std::sync::Arc;

use feed_dynamics::{DriveError, NutErrors, Settled, TimeStepper};
use lugre::LuGre;

use super::{Plant, Start};
use crate::effects::{Hooks, ScrewState, Steepness, TableState};
use crate::friction::{ContactState, Friction};
use crate::load::Load;

/// What is put around a mechanism to make a machine of it.
#[derive(Debug)]
pub struct Assembly {
    pub(crate) friction: Friction,
    pub(crate) loads: Vec<Arc<dyn Load>>,
    pub(crate) hooks: Hooks,
    pub(crate) backlash: f64,
    pub(crate) substeps: u32,
}

impl Assembly {
    /// The machine whose mechanism is solved by `stepper`.
    pub fn on<S>(self, stepper: S) -> Arc<dyn Plant>
    where
        S: TimeStepper + fmt::Debug + Send + Sync + 'static,
        S::State: fmt::Debug + Send + Sync + 'static,
    {
        let travel = stepper.travel_per_radian();
        let steepness = self.steepness(stepper.step_length(), travel);
        Arc::new(Law {
            lever: self.friction.lever(travel),
            moves_bristle: self.beside_friction().bristle != 0.0,
            feels_transmission: self.beside_friction().transmitted != 0.0,
            stepper: stepper.with_steepest_load(steepness),
            assembly: self,
            travel,
        })
    }

    /// How the forces on the load beside its friction depend on its motion, at most.
    fn beside_friction(&self) -> Steepness {
        let loads = self.loads.iter().map(|load| load.steepness());
        loads.fold(self.hooks.steepness(), Steepness::and)
    }

    /// Most by which the force on the load changes with its speed at the end of a step of
    /// `h` seconds, N·s/m, where the load moves by `travel` a radian.
    pub(super) fn steepness(&self, h: f64, travel: f64) -> f64 {
        let (friction, lever) = (&self.friction, self.friction.lever(travel));
        let own = match &friction.contact {
            // Not known of the other laws.
            Some(_) => f64::INFINITY,
            None => friction.law.steepness(h) / (lever * lever),
        };
        let others = self.beside_friction();
        let bristle = friction.unit.steepness(h) / lever;
        // The position at the end of a step changes by at most h times what the speed does.
        own + others.speed + h * others.position + bristle * others.bristle
    }
}

/// The machine on one stepper.
#[derive(Debug)]
pub(super) struct Law<S> {
    pub(super) assembly: Assembly,
    pub(super) stepper: S,
    /// r, m/rad or rad/rad.
    pub(super) travel: f64,
    /// Load travel per unit of the friction's coordinate.
    pub(super) lever: f64,
    /// Whether a force looks at the unit bristle.
    pub(super) moves_bristle: bool,
    /// Whether one looks at the force of the transmission.
    pub(super) feels_transmission: bool,
}

/// Deflection of the bristles at the Coulomb level, in the law's coordinate.
pub(super) fn coulomb_bristle(law: &LuGre) -> f64 {
    let p = law.parameters();
    if p.coulomb > 0.0 {
        p.coulomb / p.stiffness
    } else {
        0.0
    }
}

/// Rounds in which a settled load that grows with the force that moves it is searched
/// for: 60 halve what is off to the last bit.
const SETTLING_ROUNDS: usize = 60;

impl<S: TimeStepper> Law<S> {
    /// Whether all loads act at the start: in a motion that goes on, and at a rest under them.
    pub(super) fn is_loaded(start: &Start) -> bool {
        start.held || start.speed != 0.0 || start.acceleration != 0.0
    }

    /// A speed of the load in the friction's coordinate, or a force there at the load.
    #[inline]
    pub(super) fn by_lever(&self, value: f64) -> f64 {
        // Mostly the load's own coordinate; the step would wait for the division.
        if self.lever == 1.0 {
            value
        } else {
            value / self.lever
        }
    }

    /// Bristle deflections, in the friction's coordinate: the law's and the unit
    /// element's.
    pub(super) fn bristles(&self, start: &Start) -> [f64; 2] {
        let (law, unit) = (&self.assembly.friction.law, &self.assembly.friction.unit);
        let speed = start.speed / self.lever;
        if speed != 0.0 {
            return [law.steady_bristle(speed), unit.steady_bristle(speed)];
        }
        let share = start.friction.clamp(-1.0, 1.0);
        [law, unit].map(|law| share * coulomb_bristle(law))
    }

    /// What a law that is not LuGre remembers at the start.
    pub(super) fn contact(&self, start: &Start) -> Option<ContactState> {
        let share = start.friction.clamp(-1.0, 1.0);
        let contact = self.assembly.friction.contact.as_ref();
        contact.map(|law| law.settled(start.speed / self.lever, share))
    }

    /// The table as loads see it at the start, under that force of the transmission.
    fn table(start: &Start, transmitted: f64) -> TableState {
        TableState {
            time: start.time,
            position: start.position,
            speed: start.speed,
            bristle: match start.speed {
                0.0 => start.friction.clamp(-1.0, 1.0),
                speed => speed.signum(),
            },
            loaded: if Self::is_loaded(start) { 1.0 } else { 0.0 },
            transmitted,
            travelled: 0.0,
        }
    }

    pub(super) fn settled(&self, start: &Start) -> Settled {
        let mut motion = self.settled_under(start, 0.0);
        if !(self.feels_transmission && Self::is_loaded(start)) {
            return motion;
        }
        // A load that grows by a share of the force that moves it: each round shrinks what
        // is off by that share.
        for _ in 0..SETTLING_ROUNDS {
            let Ok(drive) = self.stepper.settled(start.position, &motion) else {
                break;
            };
            let force = self.stepper.observe(&drive).transmission_force;
            let next = self.settled_under(start, force);
            let done = (next.load - motion.load).abs() <= f64::EPSILON * next.load.abs();
            motion = next;
            if done {
                break;
            }
        }
        motion
    }

    /// The settled motion if the transmission's force were `transmitted`.
    fn settled_under(&self, start: &Start, transmitted: f64) -> Settled {
        let friction = &self.assembly.friction.law;
        let [bristle, _] = self.bristles(start);
        let speed = start.speed / self.lever;
        let own = match (&self.assembly.friction.contact, self.contact(start)) {
            (Some(law), Some(state)) => law.force(&state, speed),
            _ => friction.torque(bristle, speed),
        } / self.lever;
        let table = Self::table(start, transmitted);
        let mut load = own + self.loads_at(&table);
        if Self::is_loaded(start) {
            let hooks = &self.assembly.hooks;
            load += hooks.loads_at(&table);
            if !hooks.memories().is_empty() {
                load += hooks.memories().settled(start).1;
            }
        }
        Settled {
            speed: start.speed,
            acceleration: start.acceleration,
            load,
        }
    }

    /// The axis' own loads.
    pub(super) fn loads_at(&self, table: &TableState) -> f64 {
        let loads = &self.assembly.loads;
        loads.iter().map(|load| load.force(table)).sum()
    }

    /// Errors of the transmission's kinematics at the end of a step, where the motor will
    /// be `at`, and the torque with which its force reacts on the motor by them, N·m; `origin` is
    /// their displacement when the motion began.
    pub(super) fn errors(
        &self,
        at: &ScrewState,
        origin: f64,
    ) -> Result<(NutErrors, f64), DriveError> {
        let [offset, rate, growth] = self.assembly.hooks.offset_at(at);
        let errors = NutErrors::new(offset - origin, rate, self.assembly.backlash)?;
        Ok((errors, -growth * at.transmitted))
    }
}
