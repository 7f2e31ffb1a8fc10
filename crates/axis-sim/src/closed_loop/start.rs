//! How a run begins: settled, or held by drive and bristles.

use super::{ClosedLoop, LoopState};
use crate::actuator::Actuating;
use crate::axis::LoadSensor;
use crate::cycle::Measured;
use crate::error::SetupError;
use crate::plant::{Running, Start};

/// Rounds in which the torque is found that a motor at rest must be given beside what it adds
/// by itself: a ripple of a tenth shrinks what is off tenfold in each.
const MOTOR_ROUNDS: usize = 16;

/// Machine and actuator at rest or in even motion, and the command that takes.
type Settled = (Box<dyn Running>, Box<dyn Actuating>, f64);

impl ClosedLoop {
    /// The axis settled: at rest under its loads, or in even motion where `start` has
    /// a speed. Integrators and currents hold what that takes.
    ///
    /// # Errors
    /// [`SetupError`] if the load cannot be there.
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
            derived_speed: 0.0,
            speed_due: 0,
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

    /// Lets a run begin so many cycles after one in which all loops of the control ran.
    pub(crate) fn begin_after(&self, state: &mut LoopState, cycles: u32) {
        let every = self.sampling.speed_every;
        state.controller.begin_after(cycles);
        state.speed_due = (every - cycles % every) % every;
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
            motor_angle: seen.motor_angle,
            ..Measured::default()
        });
        Ok((plant, actuator, read.current.q))
    }

    /// A rest at `position` in which everything that acts, effects too, has been held for
    /// long, by the drive with the command `effort` (in the actuator's unit, as read) and by
    /// the bristles with what is missing. `None` if the drive holds what the axis' own
    /// loads ask for, as at a start of its own.
    ///
    /// The bristles hold a share −1 to 1 of what they can: where more is missing, nothing
    /// would have held it.
    ///
    /// # Errors
    /// [`SetupError`] if the load cannot be there.
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
    /// [`SetupError`] if the load cannot be there.
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

    /// What it showed when a speed was taken from it last before the start, so that no step of
    /// its resolution counts as speed.
    fn angle_before(&self, state: &LoopState) -> f64 {
        let mut before = state.clone();
        let (seen, period) = (state.plant.seen(), self.speed_period());
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
}
