//! The channels of logs: one table.

use ChannelPart::{Commanded, Given, Made, Sensed, Shown};

use std::borrow::Cow;

use axis_log::{Log, LogError};

use crate::actuator::Effort;
use crate::axis::{Axis, LoadSensor};
use crate::cycle::Cycle;
use crate::freedom::Freedom;
use crate::torque_channel::torque_channels;

/// A channel of a log.
#[derive(Clone, Copy, Debug)]
pub struct LogChannel {
    /// Name with unit, and unit, where the load moves along a line.
    pub linear: [&'static str; 2],
    /// The same where it turns.
    pub rotary: [&'static str; 2],
    /// How it is read from a cycle.
    pub read: fn(&Cycle) -> f64,
    /// Whether an axis has it.
    pub of: fn(&Axis) -> bool,
    /// What it is to a comparison of a log with a simulation.
    pub part: ChannelPart,
}

/// What a channel is to a comparison of a log with a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelPart {
    /// Given: time, reference, what was added.
    Given,
    /// Compared; with noise of its own from a sensor.
    Sensed,
    /// Compared; made by the controller from what it was shown.
    Made,
    /// Neither; measured.
    Shown,
    /// Neither; a command.
    Commanded,
}

impl LogChannel {
    /// Its name on an axis.
    pub fn name(&self, axis: &Axis) -> &'static str {
        self.of_freedom(axis.freedom())[0]
    }

    /// Its name and unit where the load moves like this.
    pub fn of_freedom(&self, freedom: Freedom) -> [&'static str; 2] {
        match freedom {
            Freedom::Linear => self.linear,
            Freedom::Rotary => self.rotary,
        }
    }
}

/// A channel that is called the same whether the load moves along a line or turns.
const fn same(
    name: [&'static str; 2],
    of: fn(&Axis) -> bool,
    part: ChannelPart,
    read: fn(&Cycle) -> f64,
) -> LogChannel {
    LogChannel {
        linear: name,
        rotary: name,
        read,
        of,
        part,
    }
}

/// A channel at the load, in its unit.
const fn load(
    linear: [&'static str; 2],
    rotary: [&'static str; 2],
    part: ChannelPart,
    read: fn(&Cycle) -> f64,
) -> LogChannel {
    LogChannel {
        linear,
        rotary,
        read,
        of: |_| true,
        part,
    }
}

/// All channels, one line each.
#[rustfmt::skip]
pub const CHANNELS: &[LogChannel] = &[
    same(["t_s", "s"], |_| true, Given, |c| c.time),
    load(["position_ref_m", "m"], ["position_ref_rad", "rad"], Given, |c| c.reference.position),
    load(["velocity_ref_m_s", "m/s"], ["velocity_ref_rad_s", "rad/s"], Given, |c| c.reference.velocity),
    load(["acceleration_ref_m_s2", "m/s²"], ["acceleration_ref_rad_s2", "rad/s²"], Given, |c| c.reference.acceleration),
    load(["position_m", "m"], ["position_rad", "rad"], Sensed, |c| c.measured.position),
    same(["motor_angle_rad", "rad"], has_motor_encoder, Sensed, |c| c.measured.motor_angle),
    same(["motor_speed_rad_s", "rad/s"], has_motor_encoder, Shown, |c| c.measured.motor_speed),
    same(["speed_ref_rad_s", "rad/s"], has_motor_encoder, Commanded, |c| c.command.speed_ref),
    same(["iq_ref_a", "A"], has_currents, Made, |c| c.command.effort),
    same(["iq_a", "A"], has_currents, Sensed, |c| c.measured.current.q),
    same(["id_a", "A"], has_currents, Shown, |c| c.measured.current.d),
    same(["ud_v", "V"], has_currents, Made, |c| c.command.voltage.d),
    same(["uq_v", "V"], has_currents, Made, |c| c.command.voltage.q),
    same(["torque_ref_n_m", "N·m"], |a| a.actuator.effort() == Effort::Torque, Made, |c| c.command.effort),
    same(["force_ref_n", "N"], |a| a.actuator.effort() == Effort::Force, Made, |c| c.command.effort),
    same(["drive_command_v", "V"], |a| a.actuator.effort() == Effort::Voltage, Made, |c| c.command.effort),
    load(["correction_m", "m"], ["correction_rad", "rad"], Commanded, |c| c.correction.position),
    same(["iq_feedforward_a", "A"], has_currents, Commanded, |c| c.correction.command),
];

/// Channels of what an excitation added to the command, by the unit of that; a log has one of them where
/// there was one.
pub const EXCITATIONS: [(Effort, [&str; 2]); 4] = [
    (Effort::Current, ["excitation_a", "A"]),
    (Effort::Torque, ["excitation_n_m", "N·m"]),
    (Effort::Force, ["excitation_n", "N"]),
    (Effort::Voltage, ["drive_command_added_v", "V"]),
];

/// The channel of an excitation of this axis.
pub fn excitation_channel(axis: &Axis) -> LogChannel {
    let own = EXCITATIONS
        .iter()
        .find(|(effort, _)| *effort == axis.actuator.effort());
    let name = own.map_or(EXCITATIONS[0].1, |(_, name)| *name);
    same(name, |_| true, Given, |c| c.excitation)
}

/// What a log shows of an excitation, in the unit of the command; none where it has no such channel.
pub fn excitation_in(log: &Log) -> Option<&[f64]> {
    let mut names = EXCITATIONS.iter().map(|(_, [name, _])| *name);
    names.find_map(|name| log.channel(name).ok())
}

/// Channels that a log may have beside those of a simulation and those that show a torque.
const OF_LOGS: [&str; 2] = ["velocity_m_s", "velocity_rad_s"];

/// Names of all channels that are commands and not measured: references, what a controller asks for, what is added. Nothing in
/// them is an outlier.
pub fn commanded_channels() -> impl Iterator<Item = &'static str> {
    let commands = CHANNELS
        .iter()
        .filter(|c| matches!(c.part, Given | Made | Commanded));
    let names = commands.flat_map(|c| match c.linear == c.rotary {
        true => vec![c.linear[0]],
        false => vec![c.linear[0], c.rotary[0]],
    });
    names.chain(EXCITATIONS.iter().map(|(_, [name, _])| *name))
}

/// Names of all channels that mean something to the programs that read logs.
pub fn known_channels() -> impl Iterator<Item = &'static str> {
    let simulated = CHANNELS.iter().flat_map(|c| [c.linear[0], c.rotary[0]]);
    let excitations = EXCITATIONS.iter().map(|(_, [name, _])| *name);
    let of_logs = torque_channels().chain(OF_LOGS).chain(excitations);
    let mut names: Vec<&'static str> = simulated.chain(of_logs).collect();
    names.sort_unstable();
    names.dedup();
    names.into_iter()
}

fn has_motor_encoder(axis: &Axis) -> bool {
    axis.mechanism.has_motor_encoder()
}

fn has_currents(axis: &Axis) -> bool {
    axis.actuator.has_currents()
}

/// The load's position in a log, m or rad.
///
/// # Errors
/// [`LogError`] without `position_m` and `position_rad`.
pub fn position_in(log: &Log) -> Result<&[f64], LogError> {
    either(log, ["position_m", "position_rad"])
}

/// The motor's angle in a log.
const ANGLE: &str = "motor_angle_rad";

/// The channel of the load's position where a log of this axis must have it; `None` if the axis has no
/// sensor at the load, so that the motor's angle shows all there is ([`position_shown`]).
pub fn needed_position(axis: &Axis) -> Option<&'static str> {
    (!reads_load_from_motor(axis)).then(|| axis.position_channel())
}

fn reads_load_from_motor(axis: &Axis) -> bool {
    matches!(axis.sensors.load, LoadSensor::Missing) && has_motor_encoder(axis)
}

/// The load's position in a log as the drive of this axis has it, m or rad: its channel or, where there is
/// none and the axis has no sensor at the load, the motor's angle times the travel per radian, homed on
/// the first sample of the position reference where the log has one.
///
/// # Errors
/// [`LogError`] without either.
pub fn position_shown<'a>(log: &'a Log, axis: &Axis) -> Result<Cow<'a, [f64]>, LogError> {
    let own = position_in(log).map(Cow::Borrowed);
    let (Err(_), true, Ok(angle)) = (&own, reads_load_from_motor(axis), log.channel(ANGLE)) else {
        return own;
    };
    let travel = axis.travel_per_radian();
    let first = reference_in(log).ok().and_then(|r| r.first());
    let home = match (first, angle.first()) {
        (Some(reference), Some(angle)) => reference - travel * angle,
        _ => 0.0,
    };
    Ok(angle.iter().map(|angle| home + travel * angle).collect())
}

/// The position reference in a log, m or rad.
///
/// # Errors
/// [`LogError`] without `position_ref_m` and `position_ref_rad`.
pub fn reference_in(log: &Log) -> Result<&[f64], LogError> {
    either(log, ["position_ref_m", "position_ref_rad"])
}

fn either<'a>(log: &'a Log, [linear, rotary]: [&str; 2]) -> Result<&'a [f64], LogError> {
    log.channel(if log.has(rotary) { rotary } else { linear })
}

/// The channels that logs of this axis have.
pub fn channels(axis: &Axis) -> Vec<LogChannel> {
    CHANNELS.iter().filter(|c| (c.of)(axis)).copied().collect()
}
