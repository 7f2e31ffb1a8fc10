//! Outputs: what the machine does at the communication point, and what the drive saw last.

use axis_sim::mechanism::Freedom;
use axis_sim::plant::Seen;
use axis_sim::{Axis, Cycle, LogChannel, LoopState, channels};

use crate::kind::UnitKind;

/// Where an output is read.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    /// The machine, now, times a number.
    Machine(fn(&Seen) -> f64, f64),
    /// The motor's currents, now.
    Current(fn(&LoopState) -> f64),
    /// What the drive sampled and commanded in its last cycle.
    Drive(fn(&Cycle) -> f64),
    /// The tool of a machine, now, along an axis.
    Tool,
}

impl Source {
    /// Of a closed loop: where its machine is, and its drive's last cycle.
    pub fn of_loop(&self, shown: &LoopState, cycle: &Cycle) -> f64 {
        match self {
            Self::Machine(read, times) => times * read(shown.plant().seen()),
            Self::Current(read) => read(shown),
            Self::Drive(read) => read(cycle),
            Self::Tool => f64::NAN,
        }
    }
}

/// How an output is read.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    pub(crate) source: Source,
    /// Of which drive of the unit, from 0; of the tool, along which axis.
    pub(crate) of: usize,
}

impl Output {
    /// Whether it changes with control cycles alone, and not in between.
    pub fn is_sampled(&self) -> bool {
        matches!(self.source, Source::Drive(_))
    }
}

/// An output: name, unit, meaning, and where it is read.
pub(crate) struct Column {
    pub name: String,
    pub unit: &'static str,
    pub meaning: &'static str,
    pub source: Source,
}

/// Name, unit, meaning, how it is read of `S`.
type Line<S> = (&'static str, &'static str, &'static str, fn(&S) -> f64);

#[rustfmt::skip]
const LINEAR: &[Line<Seen>] = &[
    ("position_m", "m", "position of the load", |s| s.position),
    ("speed_m_s", "m/s", "speed of the load", |s| s.speed),
    ("transmission_force_n", "N", "force of the transmission on the load", |s| s.transmission_force),
    ("resistance_n", "N", "friction and loads, positive against positive motion", |s| s.load),
];

#[rustfmt::skip]
const ROTARY: &[Line<Seen>] = &[
    ("position_rad", "rad", "position of the load", |s| s.position),
    ("speed_rad_s", "rad/s", "speed of the load", |s| s.speed),
    ("transmission_torque_n_m", "N·m", "torque of the transmission on the load", |s| s.transmission_force),
    ("resistance_n_m", "N·m", "friction and loads, positive against positive motion", |s| s.load),
];

#[rustfmt::skip]
const MOTOR: &[Line<Seen>] = &[
    ("motor_angle_rad", "rad", "angle of the motor", |s| s.motor_angle),
    ("motor_speed_rad_s", "rad/s", "speed of the motor", |s| s.motor_speed),
    ("motor_torque_n_m", "N·m", "torque of the motor", |s| s.torque),
];

#[rustfmt::skip]
const FORCE: &[Line<Seen>] = &[
    ("motor_force_n", "N", "force of the motor on the load", |s| s.torque),
];

#[rustfmt::skip]
const CURRENTS: &[Line<LoopState>] = &[
    ("iq_a", "A", "q current of the motor", |s| s.actuator().electrical().current.q),
    ("id_a", "A", "d current of the motor", |s| s.actuator().electrical().current.d),
];

/// The outputs of an axis; of a plant, only those of the mechanics.
pub(crate) fn outputs(axis: &Axis, kind: UnitKind) -> Vec<Column> {
    let load = match axis.freedom() {
        Freedom::Linear => LINEAR,
        Freedom::Rotary => ROTARY,
    };
    // A torque T at a motor that moves the load by r a radian is the force T/r on it.
    let (motor, per_torque) = match is_force(axis) {
        true => (FORCE, 1.0 / axis.travel_per_radian()),
        false => (MOTOR, 1.0),
    };
    let machine = |name: &str, unit, meaning, source| Column {
        name: format!("machine.{name}"),
        unit,
        meaning,
        source,
    };
    let mut all = Vec::new();
    for (lines, times) in [(load, 1.0), (motor, per_torque)] {
        for (name, unit, meaning, read) in lines {
            all.push(machine(name, unit, meaning, Source::Machine(*read, times)));
        }
    }
    if kind == UnitKind::Plant {
        return all;
    }
    for (name, unit, meaning, read) in CURRENTS {
        if axis.actuator.has_currents() {
            all.push(machine(name, unit, meaning, Source::Current(*read)));
        }
    }
    // A compensated axis follows its references late.
    let is_told = |c: &LogChannel| kind == UnitKind::Compensated || !is_reference(c);
    let drive = channels(axis).into_iter().filter(is_told);
    all.extend(drive.map(|channel| {
        let [name, unit] = channel.of_freedom(axis.freedom());
        Column {
            name: format!("drive.{name}"),
            unit,
            meaning: "in the drive's last control cycle, as in a log",
            source: Source::Drive(channel.read),
        }
    }));
    all
}

/// Whether motor and load are one and move along a line, be it by the lead of a screw: what
/// the motor gives is told as the force on the load.
pub(crate) fn is_force(axis: &Axis) -> bool {
    axis.freedom() == Freedom::Linear && !axis.mechanism.has_motor_encoder()
}

/// Whether a channel only repeats an input.
fn is_reference(channel: &LogChannel) -> bool {
    channel.part == axis_sim::ChannelPart::Given && channel.linear[0] != "t_s"
}
