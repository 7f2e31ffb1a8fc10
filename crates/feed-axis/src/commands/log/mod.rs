//! `log`: what a drive's log holds, how good it is, and what its mapping should be.

mod convert;
mod page;
mod words;

use std::path::{Path, PathBuf};

use axis_log::intake::{IntakeError, Options as Intake, PreparedLog, files, prepare};
use axis_log::quality::{
    ChannelQuality, Clock, Finding, Relation, RelationLaw, channel_quality, clock, cross_check,
    rate_of,
};
use axis_log::{
    FileSummary, Log, Mapping, MappingProposal, ReadError, ReadProblem, TIME_CHANNEL, columns,
    propose, read_log,
};
use axis_pipeline::heat::is_slow;
use axis_report::{Page, render};
use axis_sim::{Axis, commanded_channels};
use clap::{Args, Subcommand};
use discrepancy::logs::relations;
use miette::{IntoDiagnostic, Result, miette};

use super::discover::unused;
use crate::context::read_axis;
use crate::exit::wrong_use;
use crate::out_file;
use crate::output::{print, write_whole};

/// Options of `log`: those of `log inspect`, or with a folder for a page of each log.
#[derive(Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Options {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    logs: Logs,
    /// Folder for the page of each log
    #[arg(long, value_name = "DIR", default_value = "runs/logs")]
    out: PathBuf,
}

/// What is done with logs.
#[derive(Subcommand)]
enum Command {
    /// Channels, rates, gaps, units, levels and noise of logs, with --report a picture; changes nothing
    Inspect(Inspect),
    /// Write a log in channels and SI units as CSV, Parquet or MAT, from any file that is read
    Convert(convert::Options),
}

/// Which logs, and what is known of them.
// A group by itself: clap names groups after their type.
#[derive(Args)]
#[group(id = "logs-of-a-machine")]
struct Logs {
    /// Logs: CSV, Parquet, MAT v5, or a recording of TwinCAT Scope, SINUMERIK, LinuxCNC or moteus;
    /// several files of one log with + between
    #[arg(required = true, value_name = "FILE")]
    logs: Vec<PathBuf>,
    /// Axis file: its `[log]` maps columns, its parameters give the expected ratios between
    /// channels
    #[arg(long, value_name = "FILE")]
    axis: Option<PathBuf>,
    /// Sampling rate of the log, Hz [default: that of its slowest file]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    rate: Option<f64>,
}

/// Options of `log inspect`.
#[derive(Args)]
struct Inspect {
    #[command(flatten)]
    logs: Logs,
    /// Write one page of all logs: each channel over time, its gaps marked
    #[arg(long, value_name = "OUT.html", value_parser = out_file::page())]
    report: Option<PathBuf>,
}

/// What was asked for, and all that was found.
struct Seen {
    name: String,
    /// Each of its files, as it is before any mapping.
    files: Vec<(PathBuf, FileSummary)>,
    /// The log; of what is none yet, what it lacks.
    log: Result<SeenLog, String>,
    /// Of each file that has more than its channels.
    proposals: Vec<MappingProposal>,
}

/// A log as it was read.
struct SeenLog {
    log: Log,
    clock: Clock,
    done: Vec<String>,
    channels: Vec<ChannelQuality>,
    findings: Vec<Finding>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    match &options.command {
        Some(Command::Inspect(options)) => inspect(options),
        Some(Command::Convert(options)) => convert::convert(options),
        None => pages(options),
    }
}

fn inspect(options: &Inspect) -> Result<()> {
    let seen = look_at(&options.logs)?;
    if let Some(path) = &options.report {
        write_page(path, &page::of_all(&seen))?;
    }
    print("log", &words::Inspected::of(&seen, options.report.iter()))
}

/// As before there was `log inspect`: always a page, one for each log.
fn pages(options: &Options) -> Result<()> {
    let seen = look_at(&options.logs)?;
    let name = |path: &PathBuf| {
        let stem = |p: &PathBuf| p.file_stem().map(|s| s.to_string_lossy().into_owned());
        let stems: Vec<String> = files(path).iter().filter_map(stem).collect();
        options.out.join(stems.join("+") + ".html")
    };
    let paths: Vec<PathBuf> = options.logs.logs.iter().map(name).collect();
    for (seen, path) in seen.iter().zip(&paths) {
        write_page(path, &page::of_one(seen))?;
    }
    print("log", &words::Inspected::of(&seen, paths.iter()))
}

fn write_page(path: &Path, page: &Page) -> Result<()> {
    write_whole(path, render(page).into_diagnostic()?.as_bytes())
}

fn look_at(logs: &Logs) -> Result<Vec<Seen>> {
    valid_rate(logs.rate)?;
    let axis = logs.axis.as_deref().map(read_axis).transpose()?;
    let look = |path: &PathBuf| look(path, axis.as_ref(), logs.rate);
    logs.logs.iter().map(look).collect()
}

/// Refuses a rate that is none.
fn valid_rate(rate: Option<f64>) -> Result<()> {
    match rate.filter(|rate| !(rate.is_finite() && *rate > 0.0)) {
        Some(rate) => Err(wrong_use(format!(
            "--rate {rate}: give a number above 0, in Hz"
        ))),
        None => Ok(()),
    }
}

fn look(path: &Path, axis: Option<&Axis>, rate_hz: Option<f64>) -> Result<Seen> {
    let none = Mapping::default();
    let mapping = axis.map_or(&none, |a| &a.log);
    let exact: Vec<&str> = commanded_channels().collect();
    let options = Intake {
        exact: &exact,
        rate_hz,
        ..Intake::default()
    };
    let paths = files(path);
    let log = match prepare(&paths, mapping, &[], options) {
        Ok(prepared) => Ok(seen(path, prepared, mapping, axis)?),
        Err(error) if lacks_time(&error) => Err(LACKS_TIME.to_owned()),
        Err(_) if paths.iter().all(|path| is_of_hours(path, mapping)) => Err(OF_HOURS.to_owned()),
        Err(error) => return Err(miette!("{error}")),
    };
    let summary = |path: &PathBuf| Ok((path.clone(), columns(path).into_diagnostic()?));
    Ok(Seen {
        name: path.display().to_string(),
        files: paths.iter().map(summary).collect::<Result<_>>()?,
        log,
        proposals: proposals(&paths, mapping)?,
    })
}

/// What a file lacks that is read, and is no log.
const LACKS_TIME: &str = "no log yet, as it has no time: map a column to \"t_s\" in a [[log.column]] of the axis file, or give sample_rate_hz in its [log]";

/// What a log is whose rows may be far apart.
const OF_HOURS: &str = "a log of hours, for discover and heat --fit: its rows may be far apart, and are taken as they are";

fn is_of_hours(path: &Path, mapping: &Mapping) -> bool {
    read_log(path, mapping, &[]).is_ok_and(|log| is_slow(&log))
}

fn lacks_time(error: &IntakeError) -> bool {
    matches!(
        error,
        IntakeError::Read(ReadError {
            problem: ReadProblem::NoTime { .. },
            ..
        })
    )
}

/// All that a log tells.
fn seen(
    path: &Path,
    prepared: PreparedLog,
    mapping: &Mapping,
    axis: Option<&Axis>,
) -> Result<SeenLog> {
    let PreparedLog { log, done } = prepared;
    let clock = clock(&log).ok_or_else(|| {
        miette!(
            "{}: a single sample; at least two are needed",
            path.display()
        )
    })?;
    let relations = match axis {
        Some(axis) => relations(&log, axis),
        None => by_name(&log),
    };
    let against = |name: &str| {
        let with = relations.iter().find(|r| {
            r.channel == name
                && matches!(r.law, RelationLaw::Same | RelationLaw::Follows)
                && log.has(&r.from)
        });
        with.map(|r| r.from.as_str())
    };
    let names = log.channels()[1..].iter().map(|c| c.name.as_str());
    let channels = names.map(|name| channel_quality(&log, name, against(name)));
    let mut done: Vec<String> = done.iter().map(ToString::to_string).collect();
    done.extend(unused(mapping));
    done.extend(rate_words(&clock, &log));
    Ok(SeenLog {
        channels: channels.collect::<Result<_, _>>().into_diagnostic()?,
        findings: cross_check(&log, mapping, &relations),
        clock,
        done,
        log,
    })
}

/// Of a rate at which no log of motion is read.
fn rate_words(clock: &Clock, log: &Log) -> Option<String> {
    match rate_of(clock.period) {
        Ok(_) => None,
        Err(_) if is_slow(log) => Some(format!(
            "{:.4} Hz: a log of hours for discover and heat --fit",
            clock.period.recip()
        )),
        Err(why) => Some(format!("{why}; discover refuses it")),
    }
}

/// What the mapping of these files could have besides.
fn proposals(paths: &[PathBuf], mapping: &Mapping) -> Result<Vec<MappingProposal>> {
    let mut all = Vec::new();
    for path in paths {
        if let Some(mut proposal) = propose(path).into_diagnostic()? {
            let is_mapped = |name: &str| mapping.columns.iter().any(|map| map.source == name);
            // An axis of which something is mapped has been chosen.
            if proposal
                .columns
                .iter()
                .any(|column| is_mapped(&column.source))
            {
                proposal.other_axes.clear();
                proposal.axis = None;
            }
            proposal.columns.retain(|column| !is_mapped(&column.source));
            proposal.others.retain(|name| !is_mapped(name));
            // What is mapped needs no remark on its unit, and the rate is the log's.
            let of_mapped = |remark: &String| {
                let mut all = mapping.columns.iter();
                all.any(|map| remark.starts_with(&format!("{}: ", map.source)))
            };
            proposal.remarks.retain(|remark| !of_mapped(remark));
            if mapping
                .columns
                .iter()
                .any(|map| map.channel == TIME_CHANNEL)
            {
                proposal.rate_hz = None;
            }
            if !proposal.is_empty() {
                all.push(proposal);
            }
        }
    }
    Ok(all)
}

/// Relations that names and units alone tell.
fn by_name(log: &Log) -> Vec<Relation> {
    let one = RelationLaw::Integral { factor: 1.0 };
    let all = [
        Relation::new("position_m", "position_ref_m", RelationLaw::Same),
        Relation::new("position_rad", "position_ref_rad", RelationLaw::Same),
        Relation::new("position_m", "velocity_m_s", one),
        Relation::new("position_rad", "velocity_rad_s", one),
        Relation::new("motor_angle_rad", "motor_speed_rad_s", one),
        Relation::new("iq_a", "iq_ref_a", RelationLaw::Follows),
    ];
    let there = |r: &Relation| log.has(&r.channel) && log.has(&r.from);
    all.into_iter().filter(there).collect()
}
