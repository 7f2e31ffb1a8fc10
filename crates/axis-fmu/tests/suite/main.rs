//! Tests of units.

mod compensated;
mod machines;
mod orders;
mod package;
mod parameters;
mod plants;
mod runs;
mod states;

use std::path::{Path, PathBuf};

use axis_fmu::Unit;

/// Axis file of the project.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../data/axes")
        .join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(file(name)).unwrap()
}

fn unit(name: &str) -> Unit {
    Unit::new(name, &text(name)).unwrap()
}

/// A unit in step mode at the stroke's start.
fn ready(name: &str) -> Unit {
    let mut unit = unit(name);
    unit.enter_initialization(0.0, None).unwrap();
    unit.exit_initialization().unwrap();
    unit
}

/// Value reference of a variable.
fn at(unit: &Unit, name: &str) -> u32 {
    let found = unit.variables().named(name);
    found.unwrap_or_else(|| panic!("{name}")).reference
}

fn get(unit: &mut Unit, name: &str) -> f64 {
    let reference = at(unit, name);
    unit.get(reference).unwrap()
}

fn set(unit: &mut Unit, name: &str, value: f64) {
    let reference = at(unit, name);
    unit.set(reference, value).unwrap();
}
