//! `torque-source` and `force-source`: a drive whose current loop nobody sees.
//!
//! ```text
//! Ṫ = (T_command(t − delay) − T) 2π bandwidth,      |T| ≤ limit
//! ```

use std::f64::consts::TAU;
use std::sync::Arc;

use compensator::Drive;

use super::delay::DelayLine;
use super::{Actuating, Actuator, Effort, MotorMotion, Surroundings};
use crate::cycle::Measured;
use crate::part::units::{FORCE, FREQUENCY, TIME, TORQUE};
use crate::part::{Known, PartError, PartKind, Role, Values, number, quantity};

pub(super) static ROTARY: PartKind<dyn Actuator> = PartKind {
    name: "torque-source",
    summary: "torque that follows its command with a bandwidth, a delay and a limit",
    keys: &[
        quantity("torque_limit", &TORQUE, 1e-6, 1e7),
        BANDWIDTH,
        DELAY,
        GAIN,
    ],
    known: KNOWN,
    build: |v| build(v, v.number("torque_limit")?, Effort::Torque),
};

pub(super) static LINEAR: PartKind<dyn Actuator> = PartKind {
    name: "force-source",
    summary: "force that follows its command with a bandwidth, a delay and a limit",
    keys: &[
        quantity("force_limit", &FORCE, 1e-6, 1e8),
        BANDWIDTH,
        DELAY,
        GAIN,
    ],
    known: KNOWN,
    build: |v| build(v, v.number("force_limit")?, Effort::Force),
};

const BANDWIDTH: crate::part::Key = quantity("bandwidth", &FREQUENCY, 1.0, 1e6);
const DELAY: crate::part::Key = quantity("delay", &TIME, 0.0, 0.1)
    .or(0.0)
    .role(Role::CommandDelay);
/// Share of the command that comes out.
const GAIN: crate::part::Key = number("gain", 1e-3, 1e3).or(1.0).role(Role::TorqueConstant);

const KNOWN: &[Known] = &[
    Known::by("torque_constant", |v, by| {
        v.set("gain", v.or("gain", 1.0) * by)
    }),
    Known::key("bandwidth"),
];

#[derive(Clone, Copy, Debug)]
struct Source {
    effort: Effort,
    limit: f64,
    gain: f64,
    /// rad/s.
    bandwidth: f64,
    delay: f64,
}

fn build(v: &Values, limit: f64, effort: Effort) -> Result<Arc<dyn Actuator>, PartError> {
    Ok(Arc::new(Source {
        effort,
        limit,
        gain: v.or("gain", 1.0),
        bandwidth: TAU * v.number("bandwidth")?,
        delay: v.or("delay", 0.0),
    }))
}

impl Actuator for Source {
    fn effort(&self) -> Effort {
        self.effort
    }

    fn limit(&self) -> f64 {
        self.limit
    }

    /// A force at the motor's coordinate, which is the load's, is a torque there.
    fn torque_constant(&self, travel: f64) -> f64 {
        match self.effort {
            Effort::Force => self.gain * travel,
            _ => self.gain,
        }
    }

    fn inverse(&self, travel: f64) -> (Drive, f64) {
        let lag = Drive::Lag {
            gain: self.torque_constant(travel),
            bandwidth: self.bandwidth,
        };
        (lag, self.delay)
    }

    fn start(&self, on: &Surroundings) -> Result<Box<dyn Actuating>, PartError> {
        Ok(Box::new(State {
            constant: self.torque_constant(on.travel_per_radian),
            limit: self.limit,
            bandwidth: self.bandwidth,
            delay: DelayLine::new(self.delay / on.period),
            command: 0.0,
            made: 0.0,
            decay: [0.0, 1.0],
        }))
    }
}

#[derive(Clone, Debug)]
struct State {
    constant: f64,
    limit: f64,
    bandwidth: f64,
    delay: DelayLine,
    /// What acts now, late and limited, and what the source has made of it.
    command: f64,
    made: f64,
    /// Length of a step, and what is left after it of the lag behind the command.
    decay: [f64; 2],
}

/// What a step leaves of the lag behind a held command, `x` being the bandwidth (rad/s)
/// times the step.
///
/// The torque acts as straight lines between the ends of steps. With (2 − x)/(2 + x) these
/// lines have the impulse of the exact lag, so the source is late by just its time constant;
/// through the points e^(−x) of the exact lag they would have x²/12 too much of it: 1 nm on
/// a rack at x = 0.13. Steps longer than the time constant leave no straight line worth
/// the name, and take the points.
fn lag(x: f64) -> f64 {
    if x <= 1.0 {
        (2.0 - x) / (2.0 + x)
    } else {
        (-x).exp()
    }
}

impl Actuating for State {
    fn settle(&mut self, torque: f64, _: f64) -> f64 {
        self.command = torque / self.constant;
        self.made = self.command;
        self.delay.settle(self.command);
        self.command
    }

    fn command(&mut self, effort: f64, _: &Measured) {
        self.command = self.delay.push(effort.clamp(-self.limit, self.limit));
    }

    fn torque(&mut self, _: &MotorMotion, h: f64) -> f64 {
        if self.decay[0] != h {
            self.decay = [h, lag(self.bandwidth * h)];
        }
        self.made = self.command + self.decay[1] * (self.made - self.command);
        self.constant * self.made
    }

    fn copy(&self) -> Box<dyn Actuating> {
        Box::new(self.clone())
    }
}
