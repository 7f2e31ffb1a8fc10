//! What the drive gets to read.

use super::{ClosedLoop, LoopState};
use crate::axis::LoadSensor;
use crate::cycle::Measured;

/// What each sample of an axis takes to know, asked of its parts once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampling {
    /// Load travel per radian of the motor, m/rad or rad/rad.
    pub(super) travel: f64,
    /// Whether the motor's angle can be seen by itself.
    pub(super) has_motor_encoder: bool,
    pub(super) derives_speed: bool,
    /// Control periods from one execution of the speed loop to the next.
    pub(super) speed_every: u32,
}

impl ClosedLoop {
    /// What the sensors show now, `sense` being shown their own readings before anything is
    /// derived from them.
    pub(super) fn measure(
        &self,
        state: &mut LoopState,
        mut sense: impl FnMut(&mut Measured),
    ) -> Measured {
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
            // A speed loop that is slower than the control takes it once in each of its own
            // periods, over the whole of that, and has it until the next.
            if state.speed_due == 0 {
                let turned = measured.motor_angle - state.last_angle;
                state.derived_speed = turned / self.speed_period();
                state.last_angle = measured.motor_angle;
                state.speed_due = self.sampling.speed_every;
            }
            state.speed_due -= 1;
            measured.motor_speed = state.derived_speed;
        }
        if matches!(self.axis.sensors.load, LoadSensor::Missing) {
            measured.position = state.home + measured.motor_angle * travel;
        }
        measured
    }

    /// Time over which a speed is derived from angles, s.
    pub(super) fn speed_period(&self) -> f64 {
        f64::from(self.sampling.speed_every) * self.axis.period
    }

    /// The motor's angle as its sensor shows it, or as the load's does, which reads `load`,
    /// where motor and load are one. None if nothing shows it but the motor itself.
    pub(super) fn angle_shown(
        &self,
        state: &mut LoopState,
        load: Option<f64>,
        angle: f64,
    ) -> Option<f64> {
        match (&mut state.motor_sensor, load) {
            (Some(sensor), _) => Some(sensor.read(angle)),
            (None, Some(load)) if !self.sampling.has_motor_encoder => {
                Some(load / self.sampling.travel)
            }
            _ => None,
        }
    }
}
