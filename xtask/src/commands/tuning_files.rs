//! `tuning --write`: the example axes with tuned gains, as files, and their errors before and after.

use std::fmt::Write;
use std::path::PathBuf;

use axis_sim::Axis;
use drive_loop::{LoopError, MoveFigures, TuneSettings, Tuning};
use feed_axis::commands::tune::file_of;
use feed_axis::output::{Worded, note, print, ready, write_whole};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Serialize;

use super::tuning_options::{Options, three};

/// A tuned axis.
#[derive(Serialize)]
struct Row {
    axis: String,
    file: PathBuf,
    /// "m" or "rad".
    position_unit: String,
    /// Peak error of the first trajectory before and after, simulated with noise; none without a
    /// trajectory.
    peak_error: Option<[Option<f64>; 2]>,
    /// Mean error.
    mean_error: Option<[Option<f64>; 2]>,
    /// Maximum sensitivity before and after, of all cases.
    sensitivity: [Option<f64>; 2],
    /// Compliance from 1 to 300 Hz as a multiple of the file's.
    compliance_rms: f64,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(&options.axes)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read the folder {}", options.axes.display()))?
        .map(|entry| entry.map(|entry| entry.path()).into_diagnostic())
        .collect::<Result<_>>()?;
    files.retain(|file| file.extension().is_some_and(|end| end == "toml"));
    files.sort();
    ready(&options.out)?;
    let mut rows = Vec::new();
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        if options.asked(&name) {
            rows.extend(one(options, &file, &name)?);
        }
    }
    if rows.is_empty() {
        return Err(miette!(
            "no axis file to tune in {}; valid names: those of its files with a position controller",
            options.axes.display()
        ));
    }
    let text = table(&rows);
    print("tuning", &Worded { text, value: rows })
}

/// Tunes the axis of a file; none where it has no loops to tune.
fn one(options: &Options, file: &PathBuf, name: &str) -> Result<Option<Row>> {
    let axis = Axis::read(file)?;
    let tuned = match Tuning::of(&axis, &TuneSettings::default()) {
        Err(LoopError::Control { kind }) => {
            note(format!("{name}: left out, its control is {kind}"));
            return Ok(None);
        }
        tuned => tuned
            .into_diagnostic()
            .wrap_err_with(|| file.display().to_string())?,
    };
    let text = std::fs::read_to_string(file).into_diagnostic()?;
    let (text, _) = file_of(&text, file, &options.out, tuned.keys(&axis))?;
    let out = options.out.join(format!("{name}.toml"));
    write_whole(&out, text.as_bytes())?;
    note(format!("{} written", out.display()));
    let report = tuned.report;
    let first = report.moves.first();
    let of = |error: fn(&MoveFigures) -> Option<f64>| {
        first.map(|check| [error(&check.file), error(&check.tuned)])
    };
    Ok(Some(Row {
        axis: name.to_owned(),
        file: out,
        peak_error: of(|m| m.peak_error),
        mean_error: of(|m| m.mean_error),
        sensitivity: [report.file.sensitivity, report.tuned.sensitivity],
        compliance_rms: report.tuned.compliance_rms / report.file.compliance_rms,
        position_unit: report.position_unit,
    }))
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "| axis | peak error, file | tuned | mean error, file | tuned | maximum sensitivity, file | tuned | compliance × |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let error = |both: Option<[Option<f64>; 2]>, i: usize| {
            let Some(both) = both else {
                return "–".to_owned();
            };
            both[i].map_or("given up".to_owned(), |e| {
                format!("{} µ{}", three(1e6 * e), row.position_unit)
            })
        };
        let sensitivity =
            |i: usize| row.sensitivity[i].map_or("not stable".to_owned(), |s| format!("{s:.2}"));
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} |",
            row.axis,
            error(row.peak_error, 0),
            error(row.peak_error, 1),
            error(row.mean_error, 0),
            error(row.mean_error, 1),
            sensitivity(0),
            sensitivity(1),
            three(row.compliance_rms)
        );
    }
    text
}
