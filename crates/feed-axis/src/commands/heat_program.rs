//! The program that an axis repeats.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use axis_pipeline::strategies::SharedMotion;
use axis_sim::{Axis, SixDigits};
use miette::{Result, WrapErr};
use trajectories::{Motion, Program};

use super::motions::program_on;
use crate::exit::wrong_use;

/// A program that can be repeated: it ends where it begins, and stays in the stroke.
pub(super) fn repeated(file: &Path, axis: &Axis) -> Result<Program> {
    let program = program_on(file, axis)?;
    let (start, end) = (program.start(), program.end());
    if (end - start).abs() > 1e-9 || program.duration() <= 0.0 {
        let unit = axis.freedom().unit();
        return Err(wrong_use(format!(
            "--program: {} begins at {} {unit} and ends at {} {unit} after {} s; give one that takes \
             some time and ends where it begins, for it is repeated",
            file.display(),
            SixDigits(start),
            SixDigits(end),
            SixDigits(program.duration())
        )));
    }
    inside(&program, axis).wrap_err("--program")?;
    Ok(program)
}

/// Programs that the duties of slow logs count from 1.
pub(super) fn shared_programs(axis: &Axis, files: &[PathBuf]) -> Result<Vec<SharedMotion>> {
    let read = |file: &PathBuf| Ok(Arc::new(repeated(file, axis)?) as SharedMotion);
    files.iter().map(read).collect()
}

/// A program that leaves the stroke would heat places that the nut cannot be at.
fn inside(program: &Program, axis: &Axis) -> Result<()> {
    let (reached, stroke) = (program.extremes(), &axis.stroke);
    let slack = 1e-9;
    let from = reached.position_min >= stroke.minimum - slack;
    if from && reached.position_max <= stroke.maximum + slack {
        return Ok(());
    }
    Err(wrong_use(format!(
        "the program reaches from {} to {} {unit}; give one from {} to {} {unit}, the stroke",
        SixDigits(reached.position_min),
        SixDigits(reached.position_max),
        SixDigits(stroke.minimum),
        SixDigits(stroke.maximum),
        unit = axis.freedom().unit()
    )))
}
