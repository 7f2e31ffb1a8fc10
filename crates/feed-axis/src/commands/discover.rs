//! `discover`: what a model lacks, from logs or from a table of errors.

use std::path::{Path, PathBuf};

use axis_log::intake::{IntakeError, Options as Intake, files, prepare};
use axis_log::{Log, Mapping, ReadError, ReadProblem};
use axis_pipeline::ErrorUnit;
use axis_sim::effects::Scales;
use axis_sim::{Axis, commanded_channels, known_channels};
use clap::Args;
use discrepancy::logs::{NamedLog, admit, most_samples, needed_channels};
use discrepancy::summary::{MeasuredError, rank, tried};
use discrepancy::{Evidence, Settings};
use miette::{IntoDiagnostic, Report, Result, WrapErr, miette};

use super::discover_files::{AXIS, DISCOVERY, NEXT, REPORT};
use super::discover_slow;
use super::discover_words::{Files, Found, FoundInSummary, summary_words};
use super::motions::listed;
use super::moved_file::moved;
use crate::context::{DEFAULT_AXIS, read_axis, read_text};
use crate::exit::wrong_use;
use crate::file_set::FileSet;
use crate::output::{Worded, note, print, ready};
use crate::page::discovery as discovery_page;
use crate::program;
use crate::progress::{bar, spinner};
use crate::shell;

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Axis file: the model that the logs are compared with
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    axis: PathBuf,
    /// Logs to fit to: tables of text (CSV and the like), Parquet, MAT v5, or recordings of other
    /// programs, 100 Hz to 20 kHz, torque balances from 20 Hz; a log in several files as their paths with + between. Or logs of
    /// hours, slower than 10 Hz: growth and friction that falls with warmth are looked for in them
    #[arg(long, value_name = "LOG", num_args = 1.., required_unless_present = "summary")]
    fit: Vec<PathBuf>,
    /// Logs of other motion, to check on; never fitted to. Logs of hours may be without: then the last
    /// quarter of each is held out
    #[arg(long, value_name = "LOG", num_args = 1..)]
    check: Vec<PathBuf>,
    /// Logs for the reported figures, used for no choice. Without them the figures come from the
    /// last check log, or from the last part of a single one if it can be cut
    #[arg(long, value_name = "LOG", num_args = 1.., requires = "check")]
    test: Vec<PathBuf>,
    /// Instead of logs: CSV with the columns trajectory, experiment_max_um and
    /// experiment_mean_um (or max_um, mean_um; of an axis that turns, _urad), one row for each
    /// trajectory of the axis file
    #[arg(long, value_name = "TABLE", conflicts_with_all = ["fit", "check", "test", "accept", "reject"])]
    summary: Option<PathBuf>,
    /// Folder for discovery.json, report.html and axis.toml (with --summary: ranking.json and
    /// ranking.html) [default: runs/NAME/discover, NAME being that of the axis]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Search again with this effect in the model from the start (may be repeated)
    #[arg(long, value_name = "NAME")]
    accept: Vec<String>,
    /// Search again and never name this effect (may be repeated)
    #[arg(long, value_name = "NAME")]
    reject: Vec<String>,
    /// Compare by torque balance, as if the axis file had no `[control]`: the torque that the
    /// model needs for the measured motion, with the logged torque
    #[arg(long, conflicts_with = "summary")]
    balance: bool,
    /// Threads, 0 for all cores; results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    #[command(flatten)]
    slow: discover_slow::Options,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build_global();
    let mut machine = read_axis(&options.axis)?;
    if options.balance {
        machine = machine.without_control().into_diagnostic()?;
    }
    let default = || Path::new("runs").join(&machine.name).join("discover");
    let out = options.out.clone().unwrap_or_else(default);
    match &options.summary {
        Some(table) => from_summary(options, &machine, table, &out),
        None if discover_slow::asked(&machine, &options.fit) => {
            let given = discover_slow::Given {
                machine: &machine,
                file: &options.axis,
                fit: &options.fit,
                check: &options.check,
                others: [
                    ("--test", !options.test.is_empty()),
                    ("--accept", !options.accept.is_empty()),
                    ("--reject", !options.reject.is_empty()),
                    ("--balance", options.balance),
                ],
                out: &out,
            };
            discover_slow::command(&given, &options.slow)
        }
        None => {
            discover_slow::refuse(&options.slow)?;
            from_logs(options, &machine, &out)
        }
    }
}

fn from_logs(options: &Options, machine: &Axis, out: &Path) -> Result<()> {
    let settings = Settings {
        accepted: options.accept.clone(),
        rejected: options.reject.clone(),
        ..Settings::default()
    };
    settings.check(machine).into_diagnostic()?;
    if options.check.is_empty() {
        return Err(wrong_use(
            "--check is missing; valid: one log or more of other motion than that of --fit, on which the search is judged",
        ));
    }
    let mut notes = Vec::new();
    let mut logs = |paths: &[PathBuf]| read_all(paths, machine, &mut notes);
    let (fit, check) = (logs(&options.fit)?, logs(&options.check)?);
    let test = logs(&options.test)?;
    let evidence = Evidence::new(machine, fit, check, test).into_diagnostic()?;
    notes.iter().for_each(note);
    note(format!(
        "{}; channels compared: {}",
        evidence.fit.answer_of(machine),
        evidence.fit.channels.join(", ")
    ));

    ready(out)?;
    let text = moved(&read_text(&options.axis)?, &options.axis, out)?;
    let progress = spinner();
    let say = |what: &str| {
        tracing::debug!("{what}");
        progress.set_message(what.to_owned());
    };
    let (found, mut discovered) = (evidence.discover(machine, &settings, say))
        .into_diagnostic()
        .wrap_err("the axis, as its file describes it, cannot run these logs")?;
    discovered.discovery.notes.iter().for_each(note);
    notes.append(&mut discovered.discovery.notes);
    discovered.discovery.notes = notes;
    let discovery = &discovered.discovery;
    progress.finish_and_clear();

    let scales = Scales::of(machine);
    let entries = |number: fn(f64) -> String| -> String {
        let effects = found.effects_for_file();
        effects
            .map(|active| active.entry(&scales, number))
            .collect()
    };
    let mut files = FileSet::new(out, &[DISCOVERY, AXIS, NEXT, REPORT])?;
    let json = crate::json::pretty(discovery).into_diagnostic()?;
    files.put(DISCOVERY, &json)?;
    files.put(AXIS, (text + &entries(whole)).as_bytes())?;
    if let Some(next) = &discovery.next_experiment {
        let program = toml::to_string(&next.program).into_diagnostic()?;
        files.put(NEXT, program.as_bytes())?;
    }
    files.put(REPORT, discovery_page::page(&discovered)?.as_bytes())?;
    files.publish()?;
    let found = Found {
        discovery,
        added: entries(read),
        files: Files::of(out, discovery.next_experiment.is_some()),
    };
    print("discover", &found)
}

const RANKING: &str = "ranking.json";
const RANKING_REPORT: &str = "ranking.html";

/// Reads logs and looks at them; what was done to any goes to `notes`.
pub fn read_all(
    paths: &[PathBuf],
    machine: &Axis,
    notes: &mut Vec<String>,
) -> Result<Vec<NamedLog>> {
    let one = |path: &PathBuf| {
        let log = read_as_one(path, machine, &needed_channels(machine), notes)?;
        admit(path.display().to_string(), log, machine, notes).into_diagnostic()
    };
    paths.iter().map(one).collect()
}

/// One log of a file, or of several with `+` between them, with channels that it must have.
pub(super) fn read_as_one(
    path: &Path,
    machine: &Axis,
    needed: &[&str],
    notes: &mut Vec<String>,
) -> Result<Log> {
    let exact: Vec<&str> = commanded_channels().collect();
    let options = Intake {
        exact: &exact,
        rate_hz: None,
        most_samples: most_samples(machine),
    };
    read_with(path, machine, needed, options, notes)
}

/// The same, with what is to be done to it.
pub(super) fn read_with(
    path: &Path,
    machine: &Axis,
    needed: &[&str],
    options: Intake,
    notes: &mut Vec<String>,
) -> Result<Log> {
    let paths = files(path);
    let prepared =
        prepare(&paths, &machine.log, needed, options).map_err(|error| with_help(error, &paths))?;
    notes.extend(prepared.done.iter().map(ToString::to_string));
    for note in unused(&machine.log) {
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    Ok(prepared.log)
}

/// Channels of a mapping that mean nothing to any command.
pub(super) fn unused(mapping: &Mapping) -> impl Iterator<Item = String> {
    let known: Vec<&str> = known_channels().collect();
    let columns = mapping.columns.iter();
    columns.filter_map(move |column| {
        let is_known = known.contains(&column.channel.as_str());
        (!is_known).then(|| {
            format!(
                "the channel \"{}\" of the mapping (source \"{}\") is not used: known are {}",
                column.channel,
                column.source,
                known.join(", ")
            )
        })
    })
}

/// What helps where only a mapping is missing.
fn with_help(error: IntakeError, paths: &[PathBuf]) -> Report {
    let lacks_channel = matches!(
        &error,
        IntakeError::Read(ReadError {
            problem: ReadProblem::NoTime { .. } | ReadProblem::MissingColumn { .. },
            ..
        })
    );
    if !lacks_channel {
        return Report::from_err(error);
    }
    let paths: Vec<String> = paths.iter().map(|p| p.display().to_string()).collect();
    let (program, paths) = (program::name(), shell::word(&paths.join("+")));
    let help =
        format!("{program} log inspect {paths} shows the columns and what their mapping could be");
    miette!(help = help, "{error}")
}

/// A number for a file: all of it.
fn whole(value: f64) -> String {
    format!("{value:e}")
}

/// A number for people: six digits of it.
fn read(value: f64) -> String {
    format!("{value:.5e}")
}

fn from_summary(options: &Options, machine: &Axis, table: &Path, out: &Path) -> Result<()> {
    let axis = machine;
    if axis.trajectories.is_empty() {
        return Err(miette!(
            "{} lists no [[trajectory]]; a table of errors is compared with what the axis does on them",
            options.axis.display()
        ));
    }
    let measured = read_summary(table, axis)?;
    let mut files = FileSet::new(out, &[RANKING, RANKING_REPORT])?;
    let progress = bar("effects", tried(axis) as u64);
    let found = rank(axis, &measured, || progress.inc(1)).into_diagnostic()?;
    progress.finish_and_clear();
    let json = crate::json::pretty(&found).into_diagnostic()?;
    files.put(RANKING, &json)?;
    let html = discovery_page::summary_page(axis, &found)?;
    files.put(RANKING_REPORT, html.as_bytes())?;
    files.publish()?;
    let text = summary_words(axis, &found, measured.len());
    let report = out.join(RANKING_REPORT);
    let text = format!("{text}\n{}", report.display());
    let value = FoundInSummary {
        found: &found,
        report,
    };
    print("discover", &Worded { text, value })
}

/// Reads a table of measured errors: one row a trajectory, by its number on the axis.
pub fn read_summary(path: &Path, axis: &Axis) -> Result<Vec<MeasuredError>> {
    let text = read_text(path)?;
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().into_diagnostic()?.clone();
    let column = |names: [String; 2]| {
        let at = header
            .iter()
            .position(|h| names.iter().any(|name| name == h.trim()));
        at.ok_or_else(|| {
            let found: Vec<&str> = header.iter().collect();
            miette!(
                "{}: no column {}; it has {}",
                path.display(),
                names.join(" or "),
                found.join(", ")
            )
        })
    };
    let unit = ErrorUnit::of(axis).key();
    let in_unit = |name: &str| format!("{name}_{unit}");
    let [number, max, mean] = [
        column(["trajectory", "number"].map(str::to_owned))?,
        column(["experiment_max", "max"].map(in_unit))?,
        column(["experiment_mean", "mean"].map(in_unit))?,
    ];
    let mut rows = Vec::new();
    for (i, record) in reader.records().enumerate() {
        let record = record
            .into_diagnostic()
            .wrap_err_with(|| path.display().to_string())?;
        let value = |c: usize| -> Result<f64> {
            let text = record.get(c).unwrap_or("").trim();
            let number = text
                .parse::<f64>()
                .ok()
                // Above zero in metres or radians too.
                .filter(|v| v.is_finite() && 1e-6 * v > 0.0);
            number.ok_or_else(|| {
                miette!(
                    "{}, line {}: \"{text}\" is not a number above zero",
                    path.display(),
                    i + 2
                )
            })
        };
        let trajectory = value(number)?;
        if trajectory.fract() != 0.0 || trajectory > axis.trajectories.len() as f64 {
            return Err(miette!(
                "{}, line {}: there is no trajectory {trajectory}; the axis file has {}",
                path.display(),
                i + 2,
                listed(axis)
            ));
        }
        rows.push(MeasuredError {
            trajectory: trajectory as usize,
            max: 1e-6 * value(max)?,
            mean: 1e-6 * value(mean)?,
        });
    }
    if rows.is_empty() {
        return Err(miette!(
            "{} has no rows; give at least one trajectory",
            path.display()
        ));
    }
    Ok(rows)
}
