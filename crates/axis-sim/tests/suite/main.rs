//! One test binary: the axis file, the closed loop against the numbers of an
//! independent program, the axis's own vibration, single cycles, replays, and
//! values that nobody should give.

mod bad_files;
mod closed_loop;
mod effects;
mod files;
mod fingerprint;
mod golden;
mod hostile;
mod obvious;
mod one_cycle;
mod outcome;
mod published;
mod recorder;
mod replay;
mod rigid;
mod vibration;

use std::path::PathBuf;

use axis_sim::part::Part;
use axis_sim::{Axis, ClosedLoop, Cycle};
use compensator::NoCompensation;

/// The printed parameters.
const PRINTED: &str = "liu2025.toml";
/// The stand-in for the machine: ten times the viscous friction.
const MACHINE: &str = "liu2025-machine.toml";

/// The other kind of machine.
const RIGID: &str = "emps.toml";

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
