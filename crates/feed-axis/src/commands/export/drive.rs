//! `export drive`: what of the correction an ordinary drive or CNC can be given.

use std::fmt::{self, Write};
use std::path::{Path, PathBuf};

use axis_pipeline::ErrorUnit;
use axis_pipeline::drive_terms::{self, DriveParameter, Loss, Term, TermTable};
use axis_sim::SixDigits;
use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::Serialize;

use crate::context::{DEFAULT_AXIS, other_control, read_axis};
use crate::file_set::FileSet;
use crate::out_file::Force;
use crate::output::{Worded, print};

const TERMS: &str = "drive.json";
const OVER_POSITION: &str = "drive.csv";
const OVER_TURN: &str = "drive-turn.csv";

/// Options of `export drive`.
#[derive(Args)]
pub struct Options {
    /// Axis file: the model from which the terms are computed
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    axis: PathBuf,
    /// Axis file of the machine on which the terms are compared with the full correction,
    /// simulated [default: the one that the
    /// axis file names, or the axis itself]
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Folder for drive.json, drive.csv (over the position) and, if the axis has cogging or
    /// periodic lead errors, drive-turn.csv (over the motor's turn)
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    force: Force,
}

/// What drive.json holds.
#[derive(Serialize)]
struct Export<'a> {
    axis: &'a str,
    axis_fingerprint: &'a str,
    /// What stands for the machine. Simulated, never measured.
    machine: &'a str,
    machine_fingerprint: &'a str,
    /// Keys of the controller that the machine's file has otherwise.
    control_differences: Vec<String>,
    version: &'a str,
    /// Where the position loop is closed.
    position_from: &'a str,
    terms: Vec<Term>,
    tables: Vec<&'a str>,
    loss_unit: ErrorUnit,
    loss: &'a [Loss],
    /// Why there is no loss; `None` if there is no such reason.
    loss_missing: Option<String>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let names = [OVER_POSITION, OVER_TURN, TERMS];
    options.force.spare_in(&options.out, &names)?;
    let axis = read_axis(&options.axis)?;
    let named = axis.experiment.as_ref().map(|e| e.machine.clone());
    let machine = match options.machine.clone().or(named) {
        Some(file) => read_axis(&file)?,
        None => axis.clone(),
    };
    let of_axis = || format!("no drive terms of {}", options.axis.display());
    let of = drive_terms::of_axis(&axis).into_diagnostic();
    let of = of.wrap_err_with(of_axis)?;
    let errors = axis.position_errors().into_diagnostic();
    let errors = errors.wrap_err_with(of_axis)?;
    let mut files = FileSet::new(&options.out, &names)?;
    let mut tables = vec![OVER_POSITION];
    let position = drive_terms::over_position(&axis, &of, &errors);
    files.put(OVER_POSITION, text_of(&position).as_bytes())?;
    if let Some(table) = drive_terms::over_turn(&axis, &errors) {
        files.put(OVER_TURN, text_of(&table).as_bytes())?;
        tables.push(OVER_TURN);
    }
    let losses = drive_terms::losses(&axis, &machine);
    let (loss, missing) = match &losses {
        Ok(loss) if loss.is_empty() => {
            (&[][..], Some("the axis file has no [[trajectory]]".into()))
        }
        Ok(loss) => (&loss[..], None),
        Err(error) => (&[][..], Some(error.to_string())),
    };
    let export = Export {
        axis: &axis.name,
        axis_fingerprint: &axis.fingerprint,
        machine: &machine.name,
        machine_fingerprint: &machine.fingerprint,
        control_differences: other_control(&axis, &machine),
        version: env!("CARGO_PKG_VERSION"),
        position_from: if of.from_motor() { "motor" } else { "load" },
        terms: drive_terms::terms(&axis, &of),
        tables,
        loss_unit: ErrorUnit::of(&axis),
        loss,
        loss_missing: missing,
    };
    let bytes = crate::json::pretty(&export).into_diagnostic()?;
    files.put(TERMS, &bytes)?;
    files.publish()?;
    let text = words(&export, &options.out).into_diagnostic()?;
    print(
        "export-drive",
        &Worded {
            text,
            value: export,
        },
    )?;
    // The terms stand without it; that it is missing is told.
    let failed = || format!("no loss on {}; the terms are written", machine.name);
    losses.map(|_| ()).into_diagnostic().wrap_err_with(failed)
}

/// A table as CSV.
fn text_of(table: &TermTable) -> String {
    let mut text = table.headings.join(",") + "\n";
    for row in &table.rows {
        let cells: Vec<String> = row.iter().map(f64::to_string).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

/// Where a term is entered, if a maker's parameter for it is known; with the value where it is another than in the
/// term's unit for drives.
pub fn entered(term: &Term) -> Option<String> {
    let one = |p: &DriveParameter| {
        let is_other = |value: &f64| (value / term.drive_value - 1.0).abs() > 1e-9;
        let value = p.value.filter(is_other).map_or(String::new(), |value| {
            format!(" ({} {})", SixDigits(value), p.unit.unwrap_or_default())
        });
        format!("{} {}{value}", p.drive, p.parameter)
    };
    let all: Vec<String> = term.parameters.iter().map(one).collect();
    (!all.is_empty()).then(|| all.join(", "))
}

/// The export as people read it.
fn words(export: &Export<'_>, out: &Path) -> std::result::Result<String, fmt::Error> {
    let mut text = format!("drive terms of {}\n", export.axis);
    for term in &export.terms {
        writeln!(
            text,
            "  {:<32} {:>12} {}",
            term.name,
            SixDigits(term.drive_value).to_string(),
            term.drive_unit
        )?;
        if let Some(line) = entered(term) {
            writeln!(text, "      {line}")?;
        }
    }
    for difference in &export.control_differences {
        writeln!(text, "warning: {difference}")?;
    }
    let unit = &export.loss_unit;
    writeln!(
        text,
        "tracking error on {} (simulated), max / mean in {unit}",
        export.machine
    )?;
    if let Some(why) = &export.loss_missing {
        writeln!(text, "  none: {why}")?;
    } else {
        writeln!(
            text,
            "  trajectory      none              drive terms         plan"
        )?;
    }
    for loss in export.loss {
        let [a, b, c] = [&loss.none, &loss.drive_terms, &loss.plan];
        writeln!(
            text,
            "  {:>10} {:>8.3} / {:<7.4} {:>8.3} / {:<7.4} {:>8.4} / {:.5}",
            loss.trajectory, a.max, a.mean, b.max, b.mean, c.max, c.mean
        )?;
    }
    let files = [&[TERMS], &export.tables[..]].concat().join(", ");
    write!(text, "written to {}: {files}", out.display())?;
    Ok(text)
}
