//! `log convert`: a log in channels and SI units, whatever file it comes from.

use std::fmt;
use std::path::{Path, PathBuf};

use axis_log::intake::{Done, Options as Intake, PreparedLog, files, prepare};
use axis_log::quality::clock;
use axis_log::{Log, Mapping, TIME_CHANNEL, WriteProblem, columns, write};
use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Serialize;

use super::{LACKS_TIME, lacks_time, valid_rate};
use crate::context::read_axis;
use crate::exit::wrong_use;
use crate::out_file;
use crate::output::print;
use crate::{program, shell};

/// Options of `log convert`.
#[derive(Args)]
pub struct Options {
    /// Log, as `log inspect` reads it; several files of one log with + between
    #[arg(value_name = "FILE")]
    log: PathBuf,
    /// Axis file, whose `[log]` maps columns
    #[arg(long, value_name = "FILE")]
    axis: Option<PathBuf>,
    /// Sampling rate of the log, Hz [default: that of its slowest file]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    rate: Option<f64>,
    /// Where to write the log: .csv, .parquet or .mat (version 5)
    #[arg(long, value_name = "OUT", value_parser = out_file::file())]
    out: PathBuf,
}

/// What was written.
#[derive(Serialize)]
struct Converted<'a> {
    log: String,
    out: &'a Path,
    samples: usize,
    rate_hz: f64,
    /// The channels with their units, the time first.
    channels: Vec<Named>,
    /// Columns that no line of the mapping names, and whose names end in no unit.
    left_out: Vec<String>,
    /// Channels with samples that have no value, which stay NaN.
    without_value: Vec<Holes>,
    /// What was done to the samples.
    done: Vec<String>,
}

/// Samples of a channel without a value.
#[derive(Serialize)]
struct Holes {
    channel: String,
    samples: usize,
}

/// A channel.
#[derive(Serialize)]
struct Named {
    name: String,
    unit: String,
}

impl fmt::Display for Converted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for done in &self.done {
            writeln!(f, "{done}")?;
        }
        if !self.left_out.is_empty() {
            let names = self.left_out.join(", ");
            writeln!(f, "left out, as no [[log.column]] names them: {names}")?;
        }
        let names: Vec<&str> = self.channels.iter().map(|c| c.name.as_str()).collect();
        writeln!(
            f,
            "{}: {} samples at {:.4} Hz; {}",
            self.out.display(),
            self.samples,
            self.rate_hz,
            names.join(", ")
        )
    }
}

/// Runs the command.
pub fn convert(options: &Options) -> Result<()> {
    valid_rate(options.rate)?;
    let axis = options.axis.as_deref().map(read_axis).transpose()?;
    let paths = files(&options.log);
    not_over_the_log(&options.out, &paths)?;
    let none = Mapping::default();
    let mapping = axis.as_ref().map_or(&none, |a| &a.log);
    let exact: Vec<&str> = axis_sim::commanded_channels().collect();
    let intake = Intake {
        exact: &exact,
        rate_hz: options.rate,
        ..Intake::default()
    };
    let name = options.log.display().to_string();
    let PreparedLog { log, done } =
        prepare(&paths, mapping, &[], intake).map_err(|e| match lacks_time(&e) {
            true => miette!("{name}: {LACKS_TIME}"),
            false => miette!("{e}"),
        })?;
    let left_out = left_out(&paths, mapping, |name| log.has(name))?;
    if log.channels().len() < 2 {
        return Err(miette!(
            "{name}: no column is a channel ({}); map them by [[log.column]] in an axis file and \
             give it with --axis: `{} log inspect {}` proposes the lines",
            left_out.join(", "),
            program::name(),
            shell::word(&name)
        ));
    }
    write(&options.out, &log)
        .map_err(|e| match e.problem {
            WriteProblem::Extension { .. } => wrong_use(format!("--out {e}")),
            _ => miette!(e),
        })
        .wrap_err_with(|| format!("cannot write the log {}", options.out.display()))?;
    let named = |c: &axis_log::Channel| Named {
        name: c.name.clone(),
        unit: c.unit.clone(),
    };
    let converted = Converted {
        log: name,
        out: &options.out,
        samples: log.len(),
        rate_hz: clock(&log).map_or(0.0, |clock| 1.0 / clock.period),
        channels: log.channels().iter().map(named).collect(),
        left_out,
        without_value: log
            .channels()
            .iter()
            .filter_map(|c| holes(&log, &c.name))
            .collect(),
        done: done.iter().map(said).collect(),
    };
    print("log", &converted)
}

/// The samples of a channel that have no value; none where all have one.
fn holes(log: &Log, channel: &str) -> Option<Holes> {
    let samples: usize = log.missing(channel).iter().map(|run| run.len()).sum();
    (samples > 0).then(|| Holes {
        channel: channel.to_owned(),
        samples,
    })
}

/// What was done, of a log that is written and not used: what has no value is not bridged.
fn said(done: &Done) -> String {
    match done {
        Done::Bridged {
            channel,
            samples,
            longest,
            at,
        } => format!(
            "{channel}: {samples} sample(s) without a value, at most {longest} in a row (from t = {at:.4} s); NaN stands there"
        ),
        other => other.to_string(),
    }
}

/// Refuses to write over what is read: a measurement cannot be made again.
fn not_over_the_log(out: &Path, logs: &[PathBuf]) -> Result<()> {
    let there = |path: &Path| path.canonicalize().ok();
    let is_read = |log: &PathBuf| there(out).is_some_and(|out| there(log) == Some(out));
    match logs.iter().any(is_read) {
        true => Err(wrong_use(format!(
            "--out {}: this is the log that is read; give another file",
            out.display()
        ))),
        false => Ok(()),
    }
}

/// Columns of the files that are not in the log.
fn left_out(
    paths: &[PathBuf],
    mapping: &Mapping,
    is_channel: impl Fn(&str) -> bool,
) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for path in paths {
        for column in columns(path).into_diagnostic()?.columns {
            let mapped = mapping.columns.iter().any(|map| map.source == column.name);
            if !mapped && !is_channel(&column.name) && column.name != TIME_CHANNEL {
                names.push(column.name);
            }
        }
    }
    Ok(names)
}
