//! The C code gives what the Rust code gives.

use std::path::Path;

use crate::support::program::{compare, compilers, stack, write, write_one};
use crate::support::{Outcome, laws, samples};
use axis_pipeline::strategies::Predictors;
use axis_sim::Axis;
use compensator::GuardLimits;
use controller_export::c::{CSource, Precision};
use controller_export::{EXPORTED, ExportedController};

const BOTH: [Precision; 2] = [Precision::F64, Precision::F32];

/// Cycles of a comparison: a million for the strategies that together have every part.
fn cycles(name: &str) -> usize {
    match name {
        "network_lugre" | "transfer_function_lugre" | "feedback" => 1_000_000,
        _ => 100_000,
    }
}

/// Whether what compilers make of a case has Rust's bits in all cycles.
fn same_bits(
    folder: &Path,
    name: &str,
    cycles: usize,
    source: &CSource,
    compilers: &[&str],
) -> Outcome<()> {
    for compiler in compilers {
        let c = compare(folder, compiler, name, &[])?;
        println!("{name:<24}{compiler:<6} {c:?} {:?}", source.memory);
        assert_eq!((c.cycles, c.statuses), (cycles, 0), "{name}: {c:?}");
        assert_eq!(c.equal, cycles, "{name}: {c:?}");
        assert_eq!(c.state, source.memory.state, "{name}: {c:?}");
    }
    Ok(())
}

/// A strategy in both precisions over cycles in which it is switched, trips and begins anew.
fn c_is_rust(names: &[&str]) -> Outcome<()> {
    if compilers().is_empty() {
        crate::needs::skipped("program", "gcc|clang");
        return Ok(());
    }
    let predictors = laws::predictors(&samples::axis()?)?;
    for name in names {
        for precision in BOTH {
            let folder = tempfile::tempdir()?;
            let source = write(folder.path(), &predictors, name, precision, cycles(name))?;
            same_bits(folder.path(), name, cycles(name), &source, &compilers())?;
        }
    }
    Ok(())
}

/// A step takes at least its greatest array of the stack, and what the header says of the stack is
/// no number that a build could exceed.
#[test]
fn the_stack_is_measured_and_not_promised() -> Outcome<()> {
    let predictors = laws::predictors(&samples::axis()?)?;
    for &name in EXPORTED {
        for precision in BOTH {
            let folder = tempfile::tempdir()?;
            let source = write(folder.path(), &predictors, name, precision, 2000)?;
            let header = &source.header.text;
            let mut lines = header.lines();
            let said = lines
                .find(|line| line.contains("stack"))
                .ok_or("no word of the stack")?;
            assert!(!said.contains(|c: char| c.is_ascii_digit()), "{said}");
            for compiler in compilers() {
                let painted = stack(folder.path(), compiler, name)?;
                println!(
                    "{name:<24}{compiler:<6} {painted} bytes of stack, {:?}",
                    source.memory
                );
                assert!(painted >= source.memory.greatest_array, "{name}: {painted}");
                assert!(painted < 16384, "{name}: {painted}");
            }
        }
    }
    Ok(())
}

const PLANS: [&str; 2] = ["plan", "feedback"];

#[test]
fn predicted_errors_and_friction_are_those_of_rust() -> Outcome<()> {
    let names = EXPORTED.iter().copied();
    let names: Vec<&str> = names.filter(|name| !PLANS.contains(name)).collect();
    assert_eq!(names.len(), 6);
    c_is_rust(&names)
}

#[test]
fn plans_are_those_of_rust() -> Outcome<()> {
    c_is_rust(&PLANS)
}

/// Axes with other actuators, delays, transmissions and sensors, by one compiler. Feedback where a
/// design takes little time.
#[test]
fn plans_of_other_axes_are_those_of_rust() -> Outcome<()> {
    let limits = GuardLimits {
        position: 1.0,
        effort: 1e4,
        surprise: 1e9,
        ..laws::LIMITS
    };
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes");
    let compilers = compilers();
    if compilers.is_empty() {
        crate::needs::skipped("program", "gcc|clang");
        return Ok(());
    }
    let (mut compared, mut seen) = (0, Vec::new());
    let mut axes = Vec::new();
    for file in std::fs::read_dir(folder)? {
        let path = file?.path();
        if path.is_file() {
            axes.push(Axis::read(&path)?);
        }
    }
    // Voltages that are late by whole periods, and by a part of one.
    for delay in ["1.5", "2.25"] {
        let text = std::fs::read_to_string(format!("{folder}/linear-motor.toml"))?;
        let late = format!("current_delay_periods = {delay} ");
        let late = text.replace("current_delay_periods = 0 ", &late);
        assert_ne!(late, text);
        axes.push(Axis::parse("late.toml", &late)?);
    }
    for axis in axes {
        let predictors = Predictors::of(&axis);
        let feedback = ["emps", "rotary-table"].contains(&&*axis.name);
        for name in &PLANS[..1 + usize::from(feedback)] {
            let controller = match ExportedController::of(&predictors, name, limits) {
                Ok(controller) => controller,
                Err(refused) => {
                    println!("{}, {name}: {refused}", axis.name);
                    continue;
                }
            };
            for precision in BOTH {
                let folder = tempfile::tempdir()?;
                let path = folder.path();
                let source = write_one(path, &predictors, &controller, precision, (20_000, false))?;
                print!("{:<16}{:<8}", axis.name, precision.name());
                same_bits(path, name, 20_000, &source, &compilers[..1])?;
                compared += 1;
                let text = &source.source.text;
                let parts = [
                    "#define LATE 0u",
                    " GAIN = ",
                    " VOLTAGE = ",
                    "SAMPLED_PART =",
                ];
                seen.push(parts.map(|part| text.contains(part)));
            }
        }
    }
    assert!(compared >= 16, "{compared}");
    // Commands that come late and that do not, both actuators.
    let with = |part: usize, there: bool| seen.iter().any(|parts| parts[part] == there);
    assert!(with(0, true) && with(0, false), "{seen:?}");
    assert!(with(1, true) && with(2, true), "{seen:?}");
    // A sample between two.
    assert!(seen.iter().any(|parts| parts[3]), "{seen:?}");
    Ok(())
}
