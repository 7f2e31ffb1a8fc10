//! Motions that options name: trajectories of the axis file, motion programs.

use std::path::Path;
use std::sync::Arc;

use axis_pipeline::strategies::SharedMotion;
use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, MoveSpec, SixDigits};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use trajectories::Program;

use super::excitation;
use crate::context::{Context, from_toml, read_text};
use crate::exit::wrong_use;

/// The trajectories of an axis, by their numbers.
pub(super) fn listed(axis: &Axis) -> String {
    if axis.trajectories.is_empty() {
        return "no [[trajectory]]: add one, or give a motion program".to_owned();
    }
    let (unit, scale) = match axis.freedom() {
        Freedom::Linear => ("mm", 1e3),
        Freedom::Rotary => ("°", 180.0 / std::f64::consts::PI),
    };
    let one = |(i, spec): (usize, &MoveSpec)| {
        // Of a conversion, not of the file: 0.3 m is 300 mm.
        let shown = |value: f64| SixDigits((1e9 * scale * value).round() / 1e9);
        let (by, speed) = (shown(spec.displacement), shown(spec.limits.velocity()));
        format!("{} (by {by} {unit} at up to {speed} {unit}/s)", i + 1)
    };
    let all: Vec<String> = axis.trajectories.iter().enumerate().map(one).collect();
    match all.len() {
        1 => format!("trajectory {}", all[0]),
        _ => format!("trajectories {}", all.join(", ")),
    }
}

/// The motion of a trajectory's number, asked for by an option.
pub(super) fn trajectory(option: &str, number: usize, context: &Context) -> Result<SharedMotion> {
    let spec = number
        .checked_sub(1)
        .and_then(|index| context.axis.trajectories.get(index))
        .ok_or_else(|| {
            wrong_use(format!(
                "{option} {number}: there is no such trajectory; the axis file has {}",
                listed(&context.axis)
            ))
        })?;
    Ok(Arc::new(context.axis.plan(spec).into_diagnostic()?))
}

/// Reads a motion program for an axis, in whose unit it must be.
pub(super) fn program_on(file: &Path, axis: &Axis) -> Result<Program> {
    taken(file, program(file)?, axis)
}

/// A motion program, if its unit is the axis'.
fn taken(file: &Path, program: Program, axis: &Axis) -> Result<Program> {
    match axis.takes(&program) {
        Ok(()) => Ok(program),
        Err(why) => Err(miette!("{}: {why}", file.display())),
    }
}

/// Reads a motion program that may excite the axis, and what it adds to the command in each cycle.
pub(super) fn excited_program(file: &Path, axis: &Axis) -> Result<(Program, Option<Vec<f64>>)> {
    let text = read_text(file)?;
    let (rest, asked) = excitation::split(&text).wrap_err_with(|| no_program(file))?;
    let program = from_toml(&rest).wrap_err_with(|| no_program(file))?;
    let program = taken(file, program, axis)?;
    let samples = asked.map(|asked| asked.samples(axis, &program)).transpose();
    let samples = samples.wrap_err_with(|| format!("{}: [excitation]", file.display()))?;
    Ok((program, samples))
}

/// Reads a motion program.
pub fn program(file: &Path) -> Result<Program> {
    from_toml(&read_text(file)?).wrap_err_with(|| no_program(file))
}

fn no_program(file: &Path) -> String {
    format!("{} is not a motion program", file.display())
}
