//! The machine between two samples: actuator, mechanism, friction and loads.

use std::fmt;
use std::sync::Arc;

use feed_dynamics::{DriveError, NutErrors, Observation, Settled, TimeStepper};
use lugre::LuGre;

use crate::actuator::{Actuating, MotorMotion};
use crate::effects::{Hooks, Memory, ScrewState, Steepness, TableState, TableStep};
use crate::friction::Friction;
use crate::load::Load;

/// A machine that motions can be started on.
pub trait Plant: fmt::Debug + Send + Sync {
    /// The machine at rest or in even motion, everything settled.
    ///
    /// # Errors
    /// [`DriveError::OffScrew`]; [`DriveError::Parameter`] for a motion that is
    /// not finite.
    fn start(self: Arc<Self>, start: &Start) -> Result<Box<dyn Running>, DriveError>;

    /// Motor torque that keeps the settled motion of `start` up, N·m, by all
    /// forces that act in it.
    fn torque(&self, start: &Start) -> f64;
}

/// A machine in motion.
pub trait Running: fmt::Debug + Send + Sync {
    /// One control cycle. Where it carries the load over the end of the mechanism's
    /// reach, the transmission stays at that end: a cycle is too short for more than
    /// some 10 µm, and the loop looks at the next sample where the load is.
    ///
    /// # Errors
    /// [`DriveError::LoadNotFound`] where no friction goes with the load's motion
    /// at the end of a step; [`DriveError::Parameter`] where an effect shifts the
    /// transmission by no number. Time and what is seen are then those at its start.
    fn advance(&mut self, actuator: &mut dyn Actuating) -> Result<(), DriveError>;

    /// What can be seen of it.
    fn seen(&self) -> &Seen;

    /// Lets a force from outside act on the load from now on, N or N·m, positive against
    /// positive motion, beside friction and loads: constant until it is set again, 0 at the
    /// start.
    fn set_outer_load(&mut self, force: f64);

    /// A copy.
    fn copy(&self) -> Box<dyn Running>;

    /// Kinetic and strain energy of the mechanism, J.
    fn energy(&self) -> f64;

    /// Friction at the load as it acts now, N or N·m, and the share of its
    /// Coulomb deflection that the bristles have.
    fn friction(&self) -> [f64; 2];
}

/// Position and speed that a machine starts with, and what it was left with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// Position of the load, m or rad.
    pub position: f64,
    /// Its speed, m/s or rad/s.
    pub speed: f64,
    /// Its acceleration, m/s² or rad/s².
    pub acceleration: f64,
    /// Time since the motion began, s.
    pub time: f64,
    /// At rest, share of the Coulomb deflection that the bristles were left with,
    /// −1 to 1: an axis that came forward and stopped is held back by up to 1.
    pub friction: f64,
    /// Whether loads that stand from before on act at once, held by drive and bristles.
    /// Otherwise those of effects come up over 20 ms where the start is at rest.
    pub held: bool,
}

impl Start {
    /// At rest and relaxed.
    pub fn at(position: f64) -> Self {
        Self {
            position,
            ..Self::default()
        }
    }
}

/// What can be seen of a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// Since the motion began, s.
    pub time: f64,
    /// Position of the load, m or rad.
    pub position: f64,
    /// Its way since the motion began, m or rad.
    pub displacement: f64,
    /// Its speed, m/s or rad/s.
    pub speed: f64,
    /// Angle of the motor, rad: absolute, so that what repeats with the turn has
    /// one phase on one machine.
    pub motor_angle: f64,
    /// Speed of the motor, rad/s.
    pub motor_speed: f64,
    /// Force of the transmission on the load, N or N·m.
    pub transmission_force: f64,
    /// Torque of the motor at the end of the last step, N·m.
    pub torque: f64,
    /// Force on the load, friction and loads, N or N·m, against positive motion.
    pub load: f64,
}

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
    fn steepness(&self, h: f64, travel: f64) -> f64 {
        let (friction, lever) = (&self.friction, self.friction.lever(travel));
        let own = friction.law.steepness(h) / (lever * lever);
        let others = self.beside_friction();
        let bristle = friction.unit.steepness(h) / lever;
        // The position at the end of a step changes by at most h times what the speed does.
        own + others.speed + h * others.position + bristle * others.bristle
    }
}

/// The machine on one stepper.
#[derive(Debug)]
struct Law<S> {
    assembly: Assembly,
    stepper: S,
    /// r, m/rad or rad/rad.
    travel: f64,
    /// Load travel per unit of the friction's coordinate.
    lever: f64,
    /// Whether a force looks at the unit bristle.
    moves_bristle: bool,
    /// Whether one looks at the force of the transmission.
    feels_transmission: bool,
}

/// The machine's inner state, which no controller sees.
struct State<S: TimeStepper> {
    law: Arc<Law<S>>,
    drive: S::State,
    /// Where the load and the motor were when the motion began.
    origin: f64,
    motor_origin: f64,
    /// Displacement of the transmission's kinematic errors there.
    offset_origin: f64,
    /// Bristle deflection z, in the friction's coordinate.
    bristle: f64,
    /// That of the unit element.
    unit_bristle: f64,
    /// What forces with a memory remember.
    memory: Memory,
    /// Way that the load has travelled since the motion began, m or rad.
    travelled: f64,
    /// Force from outside, N or N·m.
    outer_load: f64,
    /// Change of the transmission's force over the last step, N or N·m.
    force_change: f64,
    /// Motor acceleration over the last step, rad/s².
    motor_acceleration: f64,
    /// Whether standing loads act from the start on.
    pressed: bool,
    seen: Seen,
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

/// Deflection of the bristles at the Coulomb level, in the law's coordinate.
fn coulomb_bristle(law: &LuGre) -> f64 {
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

/// Time over which a standing load comes up, s.
const STANDING_LOAD_RISE: f64 = 0.02;

impl<S: TimeStepper> Law<S> {
    /// Whether all loads act at the start: in a motion that goes on, and at a rest under them.
    fn is_loaded(start: &Start) -> bool {
        start.held || start.speed != 0.0 || start.acceleration != 0.0
    }

    /// A speed of the load in the friction's coordinate, or a force there at the load.
    #[inline]
    fn by_lever(&self, value: f64) -> f64 {
        // Mostly the load's own coordinate; the step would wait for the division.
        if self.lever == 1.0 {
            value
        } else {
            value / self.lever
        }
    }

    /// Bristle deflections, in the friction's coordinate: the law's and the unit
    /// element's.
    fn bristles(&self, start: &Start) -> [f64; 2] {
        let (law, unit) = (&self.assembly.friction.law, &self.assembly.friction.unit);
        let speed = start.speed / self.lever;
        if speed != 0.0 {
            return [law.steady_bristle(speed), unit.steady_bristle(speed)];
        }
        let share = start.friction.clamp(-1.0, 1.0);
        [law, unit].map(|law| share * coulomb_bristle(law))
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
            pressed: if Self::is_loaded(start) { 1.0 } else { 0.0 },
            transmitted,
            travelled: 0.0,
        }
    }

    fn settled(&self, start: &Start) -> Settled {
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
            let force = self.stepper.observe(&drive).nut_force;
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
        let own = friction.torque(bristle, start.speed / self.lever) / self.lever;
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
    fn loads_at(&self, table: &TableState) -> f64 {
        let loads = &self.assembly.loads;
        loads.iter().map(|load| load.force(table)).sum()
    }

    /// Errors of the transmission's kinematics at the end of a step, where the motor will
    /// be `at`; `origin` is their displacement when the motion began.
    fn errors(&self, at: &ScrewState, origin: f64) -> Result<NutErrors, DriveError> {
        let [offset, rate] = self.assembly.hooks.offset_at(at);
        NutErrors::new(offset - origin, rate, self.assembly.backlash)
    }
}

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
            unit_bristle,
            memory: self.assembly.hooks.memories().settled(start).0,
            travelled: 0.0,
            outer_load: 0.0,
            force_change: 0.0,
            motor_acceleration: start.acceleration / self.travel,
            pressed: Self::is_loaded(start),
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

impl Seen {
    /// What is seen of a drive whose load and motor began at `origins`.
    fn of(at: &Observation, origins: [f64; 2], time: f64, torque: f64, load: f64) -> Self {
        Self {
            time,
            position: origins[0] + at.displacement,
            displacement: at.displacement,
            speed: at.speed,
            motor_angle: origins[1] + at.motor_angle,
            motor_speed: at.motor_speed,
            transmission_force: at.nut_force,
            torque,
            load,
        }
    }

    /// The transmission at `time`, where the motor will be at `angle` and its force be
    /// `transmitted`.
    fn screw(&self, time: f64, angle: f64, transmitted: f64) -> ScrewState {
        ScrewState {
            time,
            angle,
            rate: self.motor_speed,
            position: self.position,
            speed: self.speed,
            transmitted,
        }
    }
}

impl<S> Running for State<S>
where
    S: TimeStepper + fmt::Debug + Send + Sync + 'static,
    S::State: fmt::Debug + Send + Sync + 'static,
{
    fn advance(&mut self, actuator: &mut dyn Actuating) -> Result<(), DriveError> {
        let law = &*self.law;
        let (stepper, assembly) = (&law.stepper, &law.assembly);
        let (friction, hooks) = (&assembly.friction, &assembly.hooks);
        let h = stepper.step_length();
        let has_loads = hooks.has_loads() || !assembly.loads.is_empty();
        let rise = if self.pressed {
            0.0
        } else {
            STANDING_LOAD_RISE
        };
        let mut errors = NutErrors::new(0.0, 0.0, assembly.backlash)?;
        for _ in 0..assembly.substeps {
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
            if hooks.has_offsets() {
                let force = start.transmission_force + self.force_change;
                errors = law.errors(&start.screw(time, angle, force), self.offset_origin)?;
            }
            let (z0, u0, w0) = (self.bristle, self.unit_bristle, law.by_lever(start.speed));
            let (origin, travelled, memory) = (self.origin, self.travelled, &mut self.memory);
            let outer_load = self.outer_load;
            let pressed = (time / rise).min(1.0);
            let (mut z1, mut u1, mut end_load) = (z0, u0, 0.0);
            let report = stepper.step_through(&mut self.drive, torque, &errors, |table| {
                let w1 = law.by_lever(table.speed);
                let (z, own) = friction.law.step_torque(z0, w0, w1, h);
                z1 = z;
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
                        pressed,
                        transmitted: start.transmission_force,
                        travelled,
                    };
                    load += hooks.loads_at(&at) + law.loads_at(&at);
                    if !hooks.memories().is_empty() {
                        let step = TableStep {
                            length: h,
                            way: table.displacement - start.displacement,
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
                return Err(DriveError::LoadNotFound {
                    rounds: report.load.rounds,
                    residual: report.load.residual,
                });
            }
            self.bristle = z1;
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
        let law = &self.law.assembly.friction.law;
        let force = law.torque(self.bristle, self.seen.speed / self.law.lever) / self.law.lever;
        [force, self.bristle / coulomb_bristle(law)]
    }
}
