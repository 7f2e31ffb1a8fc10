//! The closed loop of an axis: one page for every kind of part.

use std::sync::Arc;

use compensator::{Compensator, Reference, Sample};
use feed_dynamics::DriveError;
use trajectories::{Motion, Setpoint};

use crate::actuator::Actuating;
use crate::axis::{Axis, LoadSensor};
use crate::control::{Controller, Situation, absent};
use crate::cycle::{Command, Cycle, Measured, Outcome, Stop, StopReason};
use crate::effects::Hooks;
use crate::error::SetupError;
use crate::mechanism::Way;
use crate::part::PartError;
use crate::plant::{Assembly, Plant, Running, Start};
use crate::sensor::Sensing;
use crate::work::{MOST_STEPS, check_period, cycles_of, substeps};

/// Rounds in which the torque is found that a motor at rest must be given beside what it adds
/// by itself: a ripple of a tenth shrinks what is off tenfold in each.
const MOTOR_ROUNDS: usize = 16;

/// The closed loop of an axis, prepared once for any number of runs.
#[derive(Clone, Debug)]
pub struct ClosedLoop {
    axis: Axis,
    hooks: Hooks,
    plant: Arc<dyn Plant>,
    sampling: Sampling,
    /// Seed of the sensors' noise, where they have some.
    noise: Option<u64>,
}

/// What each sample of an axis takes to know, asked of its parts once.
#[derive(Clone, Copy, Debug)]
struct Sampling {
    /// Load travel per radian of the motor, m/rad or rad/rad.
    travel: f64,
    /// Whether the motor's angle can be seen by itself.
    has_motor_encoder: bool,
    derives_speed: bool,
}

/// A run between two cycles: everything that the next one depends on.
///
/// A copy is a snapshot. What a run has left (bristles, integrators, currents)
/// is what the next motion of the same axis begins with.
#[derive(Debug)]
pub struct LoopState {
    plant: Box<dyn Running>,
    actuator: Box<dyn Actuating>,
    controller: Box<dyn Controller>,
    load_sensor: Option<Box<dyn Sensing>>,
    motor_sensor: Option<Box<dyn Sensing>>,
    /// Motor angle that its sensor showed last.
    last_angle: f64,
    /// Position where the motor's angle would be 0, wound up as at the start: an axis
    /// without a sensor at the load is homed where it stands.
    home: f64,
    last_effort: f64,
    cycles: u64,
}

impl Clone for LoopState {
    fn clone(&self) -> Self {
        let copy = |sensor: &Option<Box<dyn Sensing>>| sensor.as_ref().map(|s| s.copy());
        Self {
            plant: self.plant.copy(),
            actuator: self.actuator.copy(),
            controller: self.controller.copy(),
            load_sensor: copy(&self.load_sensor),
            motor_sensor: copy(&self.motor_sensor),
            ..*self
        }
    }
}

/// Machine and actuator at rest or in even motion, and the command that takes.
type Settled = (Box<dyn Running>, Box<dyn Actuating>, f64);

impl LoopState {
    /// Machine, as it is now.
    pub fn plant(&self) -> &dyn Running {
        &*self.plant
    }

    /// Actuator, as it is now.
    pub fn actuator(&self) -> &dyn Actuating {
        &*self.actuator
    }

    /// Lets a force from outside act on the load from the next cycle on, N or N·m, positive
    /// against positive motion, beside friction and loads: constant until it is set again, 0
    /// at the start.
    pub fn set_outer_load(&mut self, force: f64) {
        self.plant.set_outer_load(force);
    }

    /// The same state at time 0, for the next motion.
    #[must_use]
    pub fn at_rest(mut self) -> Self {
        self.cycles = 0;
        self
    }
}

impl ClosedLoop {
    /// Prepares the axis as its file says.
    ///
    /// # Errors
    /// [`SetupError`] where parts do not fit together, an effect carries a
    /// parameter out of its range, or the control period is outside 1 µs to 10 ms.
    pub fn new(axis: &Axis) -> Result<Self, SetupError> {
        Self::disturbed(axis, |_| ())
    }

    /// Prepares the axis in its mechanism's exact way, whatever the file says, in
    /// steps of at most `step` seconds.
    ///
    /// # Errors
    /// As [`ClosedLoop::new`].
    pub fn exact(axis: &Axis, step: f64) -> Result<Self, SetupError> {
        let mut axis = axis.clone();
        axis.simulation.way = Way::Exact;
        axis.simulation.step = axis.simulation.step.min(step);
        Self::new(&axis)
    }

    /// The loop with another seed of the sensors' noise; it is 0 otherwise.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.noise = Some(seed);
        self
    }

    /// The loop with sensors that have neither noise nor steps: what a log is compared
    /// with, as both of them differ from run to run.
    #[must_use]
    pub fn without_noise(mut self) -> Self {
        self.noise = None;
        self
    }

    /// As [`ClosedLoop::new`], with hooks beside those of the effects.
    pub(crate) fn disturbed(
        axis: &Axis,
        disturb: impl FnOnce(&mut Hooks),
    ) -> Result<Self, SetupError> {
        check_period(axis.period)?;
        if !axis.has_control() {
            return Err(PartError::together(absent::WHAT, absent::VALID).into());
        }
        let (axis, mut hooks) = axis.with_effects()?;
        disturb(&mut hooks);
        let substeps = substeps(&axis);
        let assembly = Assembly {
            friction: *axis.friction.share(),
            loads: axis.loads.iter().map(|load| load.share()).collect(),
            hooks: hooks.clone(),
            backlash: axis.mechanism.backlash(),
            substeps,
        };
        let step = axis.period / f64::from(substeps);
        let way = axis.simulation.way;
        let plant = axis.mechanism.plant(way, step, assembly)?;
        // Refused here, so that no run can be.
        axis.actuator.start(&axis.surroundings())?;
        axis.control.start(&axis.surroundings())?;
        Ok(Self {
            sampling: Sampling {
                travel: axis.travel_per_radian(),
                has_motor_encoder: axis.mechanism.has_motor_encoder(),
                derives_speed: axis.derives_speed(),
            },
            plant,
            axis,
            hooks,
            noise: Some(0),
        })
    }

    /// The axis, its effects' changes of parameters made.
    pub fn axis(&self) -> &Axis {
        &self.axis
    }

    /// Sampling instants of a run along `motion`, those at its start and its
    /// end included: as many cycles as [`ClosedLoop::run`] shows where it comes
    /// to its end.
    pub fn cycles(&self, motion: &(impl Motion + ?Sized)) -> u64 {
        cycles_of(motion.duration(), self.axis.period) as u64
    }

    /// Internal steps of such a run: what its computing time is proportional
    /// to. Above [`MOST_STEPS`] it is refused ([`StopReason::TooLong`]).
    pub fn steps(&self, motion: &(impl Motion + ?Sized)) -> f64 {
        let cycles = cycles_of(motion.duration(), self.axis.period);
        cycles * f64::from(substeps(&self.axis))
    }

    /// Time by which the load's channel is late in logs, s.
    pub(crate) fn clock_offset(&self) -> f64 {
        self.hooks.clock_offset
    }

    /// The axis settled: at rest under its loads, or in even motion where `start` has
    /// a speed. Integrators and currents hold what that takes.
    ///
    /// # Errors
    /// [`SetupError`] where the load cannot be there.
    pub fn start(&self, start: &Start) -> Result<LoopState, SetupError> {
        let (axis, on) = (&self.axis, self.axis.surroundings());
        let (plant, actuator, effort) = self.settled(start)?;
        let seen = *plant.seen();

        let sensing = |sensor: &crate::part::Part<dyn crate::sensor::Sensor>, stream, at, speed| {
            let mut sensing = sensor.start(
                axis.period,
                self.noise.map(|seed| seed.wrapping_mul(2) + stream),
            );
            sensing.settle(at, speed);
            sensing
        };
        let motor_sensor = axis.sensors.motor.as_ref();
        let mut state = LoopState {
            load_sensor: match &axis.sensors.load {
                LoadSensor::Fitted(s) => Some(sensing(s, 0, seen.position, seen.speed)),
                _ => None,
            },
            motor_sensor: motor_sensor.map(|s| sensing(s, 1, seen.motor_angle, seen.motor_speed)),
            last_angle: 0.0,
            home: 0.0,
            last_effort: effort,
            cycles: 0,
            plant,
            actuator,
            controller: axis.control.start(&on)?,
        };
        let mut motor = state.motor_sensor.as_ref().map(|sensor| sensor.copy());
        let shown = motor.as_mut().map_or(seen.motor_angle, |sensor| {
            sensor.settle(seen.motor_angle, 0.0);
            sensor.read(seen.motor_angle)
        });
        state.home = seen.position - axis.travel_per_radian() * shown;
        state.last_angle = self.angle_before(&state);
        let measured = self.measure(&mut state.clone(), |_| ());
        state.controller.settle(effort, &measured, seen.speed);
        Ok(state)
    }

    /// Machine and actuator settled, and the command that takes, as the sensors show it.
    fn settled(&self, start: &Start) -> Result<Settled, SetupError> {
        let plant = self.plant.clone().start(start)?;
        let mut actuator = self.axis.actuator.start(&self.axis.surroundings())?;
        let seen = *plant.seen();
        let torque = self.plant.torque(start);
        if !start.held {
            let effort = actuator.settle(torque, seen.motor_speed);
            return Ok((plant, actuator, effort));
        }
        // What the motor adds by itself, the drive need not give.
        let mut own = torque;
        for _ in 0..MOTOR_ROUNDS {
            own += torque - self.hooks.torque_at(seen.motor_angle, own);
        }
        let effort = actuator.settle(own, seen.motor_speed);
        if !self.axis.actuator.has_currents() {
            return Ok((plant, actuator, effort));
        }
        // The current loop is at rest where the current that is read is the one asked for.
        let read = self.hooks.sensors.show(Measured {
            current: actuator.electrical().current,
            ..Measured::default()
        });
        Ok((plant, actuator, read.current.q))
    }

    /// A rest at `position` in which everything that acts, effects too, has been held for
    /// long, by the drive with the command `effort` (in the actuator's unit, as read) and by
    /// the bristles with what is missing. `None` where the drive holds what the axis' own
    /// loads ask for, as at a start of its own.
    ///
    /// The bristles hold a share −1 to 1 of what they can: where more is missing, nothing
    /// would have held it.
    ///
    /// # Errors
    /// [`SetupError`] where the load cannot be there.
    pub fn holding(&self, position: f64, effort: Option<f64>) -> Result<Start, SetupError> {
        let with = |friction: f64| Start {
            friction,
            held: true,
            ..Start::at(position)
        };
        let command = |start: &Start| Ok::<f64, SetupError>(self.settled(start)?.2);
        let effort = match effort {
            Some(effort) => effort,
            None => command(&Start::at(position))?,
        };
        // Bristles at rest are springs, so that the command is a straight line over the share.
        let free = command(&with(0.0))?;
        let share = (effort - free) / (command(&with(1.0))? - free);
        Ok(with(if share.is_finite() {
            share.clamp(-1.0, 1.0)
        } else {
            0.0
        }))
    }

    /// The command with which the drive holds the axis at rest at `position` from a start of
    /// its own, bristles free, as read: in the actuator's unit.
    ///
    /// # Errors
    /// [`SetupError`] where the load cannot be there.
    pub fn resting_effort(&self, position: f64) -> Result<f64, SetupError> {
        Ok(self.settled(&Start::at(position))?.2)
    }

    /// The load's way in one cycle from settled motion with a command of the actuator
    /// (its own controllers see its true state), m or rad.
    pub(crate) fn one_cycle(&self, start: &Start, effort: f64) -> Result<f64, SetupError> {
        let mut plant = self.plant.clone().start(start)?;
        let mut actuator = self.axis.actuator.start(&self.axis.surroundings())?;
        let seen = *plant.seen();
        actuator.settle(self.plant.torque(start), seen.motor_speed);
        let measured = Measured {
            position: seen.position,
            motor_angle: seen.motor_angle,
            motor_speed: seen.motor_speed,
            current: actuator.electrical().current,
        };
        actuator.command(effort, &measured);
        plant.advance(&mut *actuator)?;
        Ok(plant.seen().displacement)
    }

    /// The motor's angle as its sensor shows it, or as the load's does, which reads `load`,
    /// where motor and load are one. None where nothing shows it but the motor itself.
    fn angle_shown(&self, state: &mut LoopState, load: Option<f64>, angle: f64) -> Option<f64> {
        match (&mut state.motor_sensor, load) {
            (Some(sensor), _) => Some(sensor.read(angle)),
            (None, Some(load)) if !self.sampling.has_motor_encoder => {
                Some(load / self.sampling.travel)
            }
            _ => None,
        }
    }

    /// What it showed a cycle before the start, so that no step of its resolution counts
    /// as speed.
    fn angle_before(&self, state: &LoopState) -> f64 {
        let mut before = state.clone();
        let (seen, period) = (state.plant.seen(), self.axis.period);
        let position = seen.position - period * seen.speed;
        let angle = seen.motor_angle - period * seen.motor_speed;
        let load = before.load_sensor.as_mut().map(|sensor| {
            sensor.settle(position, seen.speed);
            sensor.read(position)
        });
        if let Some(sensor) = &mut before.motor_sensor {
            sensor.settle(angle, seen.motor_speed);
        }
        self.angle_shown(&mut before, load, angle).unwrap_or(angle)
    }

    /// What the sensors show now, `sense` being shown their own readings before anything is
    /// derived from them.
    fn measure(&self, state: &mut LoopState, mut sense: impl FnMut(&mut Measured)) -> Measured {
        let travel = self.sampling.travel;
        let seen = *state.plant.seen();
        let load = state.load_sensor.as_mut().map(|s| s.read(seen.position));
        let motor = state
            .motor_sensor
            .as_mut()
            .map(|s| s.read(seen.motor_angle));
        let mut measured = self.hooks.sensors.show(Measured {
            position: load.unwrap_or(seen.position),
            motor_angle: motor.unwrap_or(seen.motor_angle),
            motor_speed: seen.motor_speed,
            current: state.actuator.electrical().current,
        });
        sense(&mut measured);
        // A drive knows the motor's speed from the angle that its sensor shows, or from
        // the load's where motor and load are one.
        if motor.is_none() && load.is_some() && !self.sampling.has_motor_encoder {
            measured.motor_angle = measured.position / travel;
        }
        if self.sampling.derives_speed {
            measured.motor_speed = (measured.motor_angle - state.last_angle) / self.axis.period;
            state.last_angle = measured.motor_angle;
        }
        if matches!(self.axis.sensors.load, LoadSensor::Missing) {
            measured.position = state.home + measured.motor_angle * travel;
        }
        measured
    }

    /// One control cycle: sample, correct, control, and let the machine run on until the
    /// next sample. `reference` is the set point now, `next` the one a cycle ahead.
    ///
    /// The caller owns time: a co-simulation, a second axis or a real-time loop calls
    /// this once a control period.
    ///
    /// # Errors
    /// [`crate::RunStopped`] where the run must be given up; `state` is then of no use.
    pub fn step(
        &self,
        state: &mut LoopState,
        [reference, next]: [&Setpoint; 2],
        compensator: &mut (impl Compensator + ?Sized),
        sense: impl FnMut(&mut Measured),
    ) -> Result<Cycle, crate::RunStopped> {
        let mut cycle = Cycle::default();
        self.decide(state, [reference, next], compensator, sense, &mut cycle)?;
        self.advance(state, &cycle)?;
        Ok(cycle)
    }

    /// Sample, correct and control; what comes of it is `cycle`, whatever it was before.
    fn decide(
        &self,
        state: &mut LoopState,
        [reference, next]: [&Setpoint; 2],
        compensator: &mut (impl Compensator + ?Sized),
        sense: impl FnMut(&mut Measured),
        cycle: &mut Cycle,
    ) -> Result<(), crate::RunStopped> {
        // Sample.
        let measured = self.measure(state, sense);
        let seen = *state.plant.seen();
        let current = state.actuator.electrical().current;

        // Correct.
        let correction = compensator.correct(&Sample {
            reference: reference_of(reference),
            next_reference: reference_of(next),
            position: measured.position,
            motor_angle: measured.motor_angle,
            motor_speed: measured.motor_speed,
            iq: measured.current.q,
            iq_command: state.last_effort,
        });

        // Control: position and speed, then the actuator's own.
        let demand = state.controller.cycle(&Situation {
            reference,
            measured: &measured,
            correction: &correction,
        });
        state.actuator.command(demand.effort, &measured);
        let electrical = state.actuator.electrical();

        *cycle = Cycle {
            time: state.cycles as f64 * self.axis.period,
            reference: *reference,
            position: seen.position,
            load_speed: seen.speed,
            motor_angle: seen.motor_angle,
            motor_speed: seen.motor_speed,
            current,
            torque: seen.torque,
            measured,
            command: Command {
                speed_ref: demand.speed_ref,
                effort: demand.effort,
                voltage: electrical.voltage,
                saturated: demand.saturated || electrical.saturated,
            },
            correction,
        };
        match self.stop_reason(cycle) {
            Some(reason) => Err(self.stopped(reason, cycle)),
            None => Ok(()),
        }
    }

    /// Lets the machine run on, the actuator's command held.
    fn advance(&self, state: &mut LoopState, cycle: &Cycle) -> Result<(), crate::RunStopped> {
        if let Err(error) = state.plant.advance(&mut *state.actuator) {
            let seen = state.plant.seen();
            let at = Cycle {
                time: seen.time,
                position: seen.position,
                motor_speed: seen.motor_speed,
                torque: seen.torque,
                current: state.actuator.electrical().current,
                ..*cycle
            };
            return Err(self.stopped(reason_of(&error, &at), &at));
        }
        state.cycles += 1;
        state.last_effort = cycle.command.effort;
        Ok(())
    }

    /// Follows `motion` from rest at its start, and shows every cycle at a
    /// sampling instant from 0 to the motion's end to `observe`.
    pub fn run(
        &self,
        motion: &(impl Motion + ?Sized),
        compensator: &mut (impl Compensator + ?Sized),
        observe: impl FnMut(&Cycle),
    ) -> Outcome {
        self.run_sensed(motion, compensator, |_| (), observe)
    }

    /// As [`ClosedLoop::run`], with other sensors: `sense` is shown what those of the axis
    /// read in each cycle (the motor's true speed, where that is derived from its angle
    /// afterwards), and makes of it what the drive gets to read (noise, quantisation).
    pub fn run_sensed(
        &self,
        motion: &(impl Motion + ?Sized),
        compensator: &mut (impl Compensator + ?Sized),
        sense: impl FnMut(&mut Measured),
        observe: impl FnMut(&Cycle),
    ) -> Outcome {
        let reference = motion.at(0.0);
        match self.start(&Start::at(reference.position)) {
            Ok(mut state) => self.run_from(&mut state, motion, compensator, sense, observe),
            Err(error) => {
                let at = Cycle {
                    position: reference.position,
                    reference,
                    ..Cycle::default()
                };
                let reason = match &error {
                    SetupError::Drive(error) => reason_of(error, &at),
                    _ => StopReason::NotFinite,
                };
                self.given_up(reason, &at)
            }
        }
    }

    /// As [`ClosedLoop::run_sensed`], from the state that the axis was left in, and
    /// leaves it in the state at the motion's end.
    pub fn run_from(
        &self,
        state: &mut LoopState,
        motion: &(impl Motion + ?Sized),
        compensator: &mut (impl Compensator + ?Sized),
        mut sense: impl FnMut(&mut Measured),
        mut observe: impl FnMut(&Cycle),
    ) -> Outcome {
        let period = self.axis.period;
        let mut reference = motion.at(0.0);
        let steps = self.steps(motion);
        if steps > MOST_STEPS {
            let at = Cycle {
                position: state.plant.seen().position,
                reference,
                ..Cycle::default()
            };
            return self.given_up(StopReason::TooLong(steps), &at);
        }
        compensator.reset();
        let mut cycle = Cycle::default();
        for k in 0..self.cycles(motion) {
            let next = motion.at((k + 1) as f64 * period);
            let now = &mut cycle;
            let decided = self.decide(state, [&reference, &next], compensator, &mut sense, now);
            let advanced = decided.and_then(|()| {
                observe(&cycle);
                self.advance(state, &cycle)
            });
            if let Err(stopped) = advanced {
                return Outcome::Stopped {
                    time: stopped.time,
                    reason: stopped.reason,
                    at: stopped.at,
                };
            }
            reference = next;
        }
        Outcome::Completed
    }

    fn stop_reason(&self, cycle: &Cycle) -> Option<StopReason> {
        let (stroke, axis) = (&self.axis.stroke, &self.axis);
        let current = cycle.current.d + cycle.current.q + cycle.command.effort;
        let state = cycle.position + cycle.motor_speed + current;
        if !state.is_finite() {
            Some(StopReason::NotFinite)
        } else if cycle.error().abs() > axis.following_error_limit {
            let limit = axis.following_error_limit;
            Some(StopReason::FollowingError(limit, axis.freedom()))
        } else if !(stroke.minimum..=stroke.maximum).contains(&cycle.position)
            || (axis.mechanism.reach()).is_some_and(|reach| !reach.contains(cycle.position))
        {
            Some(StopReason::LeftStroke)
        } else {
            None
        }
    }

    fn stopped(&self, reason: StopReason, at: &Cycle) -> crate::RunStopped {
        crate::RunStopped {
            time: at.time,
            reason,
            at: Stop {
                position: at.position,
                error: at.error(),
                motor_speed: at.motor_speed,
                torque: at.torque,
                freedom: self.axis.freedom(),
            },
        }
    }

    fn given_up(&self, reason: StopReason, at: &Cycle) -> Outcome {
        let crate::RunStopped { time, reason, at } = self.stopped(reason, at);
        Outcome::Stopped { time, reason, at }
    }
}

/// Why a run cannot go on after `error`, which has left it in the state `at`.
fn reason_of(error: &DriveError, at: &Cycle) -> StopReason {
    let state = at.position + at.motor_speed + at.current.d + at.current.q;
    match error {
        DriveError::LoadNotFound { residual, .. } if (state + residual).is_finite() => {
            StopReason::LoadNotFound
        }
        DriveError::OffScrew { .. } if state.is_finite() => StopReason::LeftStroke,
        _ => StopReason::NotFinite,
    }
}

fn reference_of(setpoint: &Setpoint) -> Reference {
    Reference {
        position: setpoint.position,
        velocity: setpoint.velocity,
        acceleration: setpoint.acceleration,
    }
}
