//! One test binary: axis files of all kinds of parts, the closed loop against the
//! numbers of an independent program and against slow, obvious integrations, the
//! axis's own vibration, sensors, energy, single cycles, replays, and values that
//! nobody should give.

mod adaptation;
mod axis_files;
mod bad_files;
mod balance;
mod balance_noise;
mod balance_transmission;
mod balance_wind_up;
mod belt;
mod closed_loop;
mod controls;
mod current_delay;
mod current_offset;
mod datasheet;
mod effect_laws;
mod effects;
mod energy;
mod feedback;
mod files;
mod fingerprint;
mod friction_kinds;
mod golden;
mod hostile;
mod limits;
#[path = "../../../../tests/needs.rs"]
mod needs;
mod obvious;
mod one_cycle;
mod other_effects;
mod outcome;
mod plain;
mod plain_loops;
mod plan_model;
mod published;
mod rating;
mod recorder;
mod refusals;
mod replay;
mod rigid;
mod sensors;
mod slow_speed_loop;
mod starts;
mod thermal;
mod vibration;
mod weakening;

use std::path::PathBuf;

use axis_sim::part::Part;
use axis_sim::{Axis, ClosedLoop, Cycle};
use compensator::NoCompensation;
use trajectories::{Motion, Setpoint};

/// The printed parameters.
const PRINTED: &str = "liu2025.toml";
/// The stand-in for the machine: ten times the viscous friction.
const MACHINE: &str = "liu2025-machine.toml";

/// The other kind of machine.
const RIGID: &str = "emps.toml";

/// One axis of each other mechanism.
const OTHERS: [&str; 7] = [
    "rack.toml",
    "belt.toml",
    "joint.toml",
    "rotary-table.toml",
    "linear-motor.toml",
    "linear-stage.toml",
    "screw-datasheet.toml",
];

fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../data/axes")
        .join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(data(name)).unwrap()
}

fn axis(name: &str) -> Axis {
    Axis::read(&data(name)).unwrap()
}

/// A number that a part was made from, SI.
fn number<P: ?Sized>(part: &Part<P>, key: &'static str) -> f64 {
    part.values().number(key).unwrap()
}

/// The part with other numbers.
fn change<P: ?Sized>(part: &mut Part<P>, numbers: &[(&'static str, f64)]) {
    part.change(|values| numbers.iter().for_each(|(key, to)| values.set(key, *to)))
        .unwrap();
}

/// Cycles of trajectory `id` (from 1) without compensation.
fn follow(closed_loop: &ClosedLoop, id: usize) -> Vec<Cycle> {
    let axis = closed_loop.axis();
    let motion = axis.plan(&axis.trajectories[id - 1]).unwrap();
    let mut cycles = Vec::new();
    closed_loop
        .run(&motion, &mut NoCompensation, |cycle| cycles.push(*cycle))
        .completed()
        .unwrap();
    cycles
}

/// Maximum and mean of |S_ref − S|, µm.
fn errors_um(cycles: &[Cycle]) -> [f64; 2] {
    let errors = cycles.iter().map(|c| 1e6 * c.error().abs());
    let most = errors.clone().fold(0.0, f64::max);
    [most, errors.sum::<f64>() / cycles.len() as f64]
}

/// The axis of a file's text with changes, each of which must be in it.
fn changed(name: &str, changes: &[(&str, &str)]) -> Axis {
    let mut content = text(name);
    for (from, to) in changes {
        assert!(content.contains(from), "`{from}` is not in {name}");
        content = content.replacen(from, to, 1);
    }
    Axis::parse(name, &content).unwrap()
}

/// Rest at a place, for a time.
struct Dwell {
    at: f64,
    duration: f64,
}

impl Motion for Dwell {
    fn duration(&self) -> f64 {
        self.duration
    }
    fn at(&self, _: f64) -> Setpoint {
        Setpoint::at_rest(self.at)
    }
}

/// Every number of a cycle, to the bit.
fn bits(c: &Cycle) -> [u64; 21] {
    [
        c.time,
        c.reference.position,
        c.reference.velocity,
        c.reference.acceleration,
        c.position,
        c.load_speed,
        c.motor_angle,
        c.motor_speed,
        c.current.d,
        c.current.q,
        c.torque,
        c.measured.position,
        c.measured.motor_angle,
        c.measured.motor_speed,
        c.measured.current.q,
        c.command.speed_ref,
        c.command.effort,
        c.command.voltage.d,
        c.command.voltage.q,
        c.correction.position,
        c.correction.command,
    ]
    .map(f64::to_bits)
}
