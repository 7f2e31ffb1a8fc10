//! Channels that show the motor's torque.

use axis_log::Log;
use compensator::Drive;

use crate::actuator::Effort;
use crate::axis::Axis;
use crate::balance_error::BalanceError;
use crate::control::absent::{command_hold, torque_skew};

/// What a channel shows of the motor's torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shows {
    /// The torque at the motor, measured, N·m.
    Torque,
    /// The motor's force at the load, measured, N.
    Force,
    /// The current that makes it, measured, A.
    Current,
    /// The command in the actuator's own unit, held from sample to sample.
    Command,
}

/// A channel that shows the motor's torque.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TorqueChannel {
    /// Name with unit.
    pub name: &'static str,
    shows: Shows,
    of: fn(&Axis) -> bool,
}

/// All of them, what is nearest to the torque first.
const TORQUES: &[TorqueChannel] = &[
    TorqueChannel {
        name: "torque_n_m",
        shows: Shows::Torque,
        of: |_| true,
    },
    TorqueChannel {
        name: "force_n",
        shows: Shows::Force,
        of: |_| true,
    },
    TorqueChannel {
        name: "iq_a",
        shows: Shows::Current,
        of: |axis| axis.actuator.has_currents(),
    },
    TorqueChannel {
        name: "iq_ref_a",
        shows: Shows::Command,
        of: |axis| axis.actuator.effort() == Effort::Current,
    },
    TorqueChannel {
        name: "torque_ref_n_m",
        shows: Shows::Command,
        of: |axis| axis.actuator.effort() == Effort::Torque,
    },
    TorqueChannel {
        name: "force_ref_n",
        shows: Shows::Command,
        of: |axis| axis.actuator.effort() == Effort::Force,
    },
    TorqueChannel {
        name: "drive_command_v",
        shows: Shows::Command,
        of: |axis| axis.actuator.effort() == Effort::Voltage,
    },
];

/// Names of all of them.
pub(crate) fn torque_channels() -> impl Iterator<Item = &'static str> {
    TORQUES.iter().map(|channel| channel.name)
}

impl TorqueChannel {
    /// The first that all of these logs have.
    pub fn of(logs: &[&Log], axis: &Axis) -> Result<Self, BalanceError> {
        let fitting = || TORQUES.iter().filter(|channel| (channel.of)(axis));
        let everywhere = |c: &&TorqueChannel| logs.iter().all(|log| log.has(c.name));
        fitting().find(everywhere).copied().ok_or_else(|| {
            let needed: Vec<&str> = fitting().map(|channel| channel.name).collect();
            BalanceError::NoTorque {
                actuator: axis.actuator.kind().name.to_owned(),
                needed: needed.join(", "),
                available: logs.first().map_or(String::new(), |log| names(log)),
            }
        })
    }

    /// What it shows of 1 N·m at the motor.
    pub fn per_torque(&self, axis: &Axis) -> f64 {
        match self.shows {
            Shows::Torque => 1.0,
            Shows::Force => 1.0 / axis.travel_per_radian(),
            Shows::Current | Shows::Command => 1.0 / axis.torque_constant(),
        }
    }

    /// Whether it is what a controller asks for, or follows that at once.
    pub fn is_controlled(&self) -> bool {
        matches!(self.shows, Shows::Current | Shows::Command)
    }

    /// Whether the current's sensor has a say in it: a measured current, or a command that
    /// a current loop makes one of.
    pub fn is_current(&self, axis: &Axis) -> bool {
        match self.shows {
            Shows::Current => true,
            Shows::Command => axis.actuator.has_currents(),
            Shows::Torque | Shows::Force => false,
        }
    }

    /// Time by which it shows a torque before that acts, and time constant with which the
    /// torque follows, s; `period` is that of the log.
    ///
    /// A command acts from one sample to the next, so half a period late in the mean, and
    /// by the actuator's delay later still. What is measured is as early as its sample is.
    pub fn ahead(&self, axis: &Axis, period: f64) -> [f64; 2] {
        if self.shows != Shows::Command {
            return [torque_skew(&axis.control) * period, 0.0];
        }
        let held = match axis.has_control() {
            true => axis.period,
            false => command_hold(&axis.control) * period,
        };
        let (drive, delay) = axis.actuator.inverse(axis.travel_per_radian());
        let lag = match drive {
            Drive::Lag { bandwidth, .. } => 1.0 / bandwidth,
            Drive::FieldOriented { motor, q, .. } if q[0] > 0.0 => {
                motor.parameters().inductance_q / q[0]
            }
            _ => 0.0,
        };
        [0.5 * held + delay, lag]
    }
}

/// The channels of a log.
pub(crate) fn names(log: &Log) -> String {
    let names: Vec<&str> = log.channels().iter().map(|c| c.name.as_str()).collect();
    names.join(", ")
}
