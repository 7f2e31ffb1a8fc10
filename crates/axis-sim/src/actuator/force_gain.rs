//! `force-gain`: force in proportion to the drive's command, at once.
//!
//! As the EMPS benchmark has it: A. Janot, M. Gautier, M. Brunot, "Data Set and
//! Reference Models of EMPS", Workshop on Nonlinear System Identification
//! Benchmarks, Eindhoven 2019.

use std::sync::Arc;

use super::{Actuating, Actuator, Effort, MotorMotion, Surroundings};
use crate::cycle::Measured;
use crate::part::units::{FORCE_GAIN, VOLTAGE};
use crate::part::{PartError, PartKind, Role, quantity};

pub(super) static KIND: PartKind<dyn Actuator> = PartKind {
    name: "force-gain",
    summary: "force in proportion to a drive command in V, without delay",
    keys: &[
        quantity("force_gain", &FORCE_GAIN, 1e-6, 1e9).role(Role::TorqueConstant),
        quantity("command_limit", &VOLTAGE, 1e-3, 1e6),
    ],
    known: &[],
    build: |v| {
        Ok(Arc::new(ForceGain {
            gain: v.number("force_gain")?,
            limit: v.number("command_limit")?,
        }))
    },
};

#[derive(Clone, Copy, Debug)]
struct ForceGain {
    /// At the load, N/V.
    gain: f64,
    limit: f64,
}

impl Actuator for ForceGain {
    fn effort(&self) -> Effort {
        Effort::Voltage
    }

    fn limit(&self) -> f64 {
        self.limit
    }

    fn torque_constant(&self, travel: f64) -> f64 {
        self.gain * travel
    }

    fn start(&self, on: &Surroundings) -> Result<Box<dyn Actuating>, PartError> {
        Ok(Box::new(State {
            gain: self.gain,
            limit: self.limit,
            travel: on.travel_per_radian,
            command: 0.0,
        }))
    }
}

#[derive(Clone, Copy, Debug)]
struct State {
    gain: f64,
    limit: f64,
    travel: f64,
    command: f64,
}

impl Actuating for State {
    fn settle(&mut self, torque: f64, _: f64) -> f64 {
        self.command = torque / (self.gain * self.travel);
        self.command
    }

    fn command(&mut self, effort: f64, _: &Measured) {
        self.command = effort.clamp(-self.limit, self.limit);
    }

    fn torque(&mut self, _: &MotorMotion, _: f64) -> f64 {
        self.gain * self.command * self.travel
    }

    fn copy(&self) -> Box<dyn Actuating> {
        Box::new(*self)
    }
}
