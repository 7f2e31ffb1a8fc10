//! `discover` of logs of hours: growth, and friction that falls with warmth, as states of the thermal network.

use std::path::{Path, PathBuf};

use axis_log::Log;
use axis_pipeline::heat::{SlowLog, SlowLogOptions, explain, is_slow};
use axis_pipeline::strategies::SharedMotion;
use axis_sim::{Axis, SixDigits};
use clap::Args;
use miette::{IntoDiagnostic, Result, miette};

use super::discover_files::{AXIS, DISCOVERY, NEXT, REPORT};
use super::discover_heat::{Logs, discovered};
use super::discover_words::{Files, Found};
use super::heat_program::shared_programs;
use super::heat_slow::{ProbeAgainst, ProbeZero, of_log, slow_log};
use super::moved_file::moved;
use crate::context::read_text;
use crate::exit::wrong_use;
use crate::file_set::FileSet;
use crate::output::{note, print, ready};
use crate::page::discovery as discovery_page;
use crate::progress::spinner;
use crate::set_key::{SetKey, with_keys};

/// Options for logs of hours.
#[derive(Args)]
#[group(id = "slow-discovery-options")]
pub(super) struct Options {
    /// Of logs of hours: motion programs that their channel duty_1 counts from 1, each repeated
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with = "summary")]
    duties: Vec<PathBuf>,
    /// Of logs of hours without a channel air_degc: temperature of the air, °C
    #[arg(
        long,
        value_name = "DEG_C",
        default_value_t = 20.0,
        allow_negative_numbers = true
    )]
    air: f64,
    /// Of logs of hours: what a probe reads the screw's growth against
    #[arg(long, value_enum, default_value_t = ProbeAgainst::Bearing)]
    probe_against: ProbeAgainst,
    /// Of logs of hours: what readings of a probe count from
    #[arg(long, value_enum, default_value_t = ProbeZero::Begin)]
    probe_zero: ProbeZero,
}

/// What the command is about.
pub(super) struct Given<'a> {
    pub machine: &'a Axis,
    pub file: &'a Path,
    pub fit: &'a [PathBuf],
    pub check: &'a [PathBuf],
    /// Options that logs of hours have no use for, and whether each is there.
    pub others: [(&'static str, bool); 4],
    pub out: &'a Path,
}

/// Whether the first of the logs is one of hours. A log that cannot be read as a table is none, and is refused where it
/// is read with all that recordings need.
pub(super) fn asked(machine: &Axis, fit: &[PathBuf]) -> bool {
    let first = fit.first().filter(|path| path.is_file());
    first.is_some_and(|path| slow_log(machine, path).is_ok_and(|log| is_slow(&log)))
}

/// Refuses what logs of motion have no use for.
pub(super) fn refuse(options: &Options) -> Result<()> {
    match options.duties.is_empty() {
        true => Ok(()),
        false => Err(wrong_use(
            "--duties is for logs of hours (slower than 10 Hz, or with a channel duty_1), and the first log of --fit is none; valid: a search without it",
        )),
    }
}

/// Runs the search.
pub(super) fn command(given: &Given<'_>, options: &Options) -> Result<()> {
    if let Some((name, _)) = given.others.iter().find(|(_, is_there)| *is_there) {
        return Err(wrong_use(format!(
            "{name} is for logs of motion, and {} is a log of hours; valid for it: --fit, --check, --duties, --air, --probe-against, --probe-zero, --out",
            given.fit[0].display()
        )));
    }
    let machine = given.machine;
    if machine.thermal_keys_stated() == 0 {
        return Err(miette!(
            "{} is slower than 10 Hz or has a channel duty_1: of a log of hours only heat can be read, by the axis' thermal network, and {} has no [thermal]; valid: for loops a log of 100 Hz and more, for forces (a torque balance) of 20 Hz and more; for heat a table [thermal] with what is known of it, at least reference_temperature_deg_c (at which friction has the file's values), and best nut_viscous_share, nut_dry_share, nut_to_table_w_per_k, viscous_fall_percent_per_k, front_bearing_to_bed_w_per_k: keys that are not there are assumed",
            given.fit[0].display(),
            given.file.display()
        ));
    }
    let duties: Vec<SharedMotion> = shared_programs(machine, &options.duties)?;
    let reading = SlowLogOptions {
        duties: &duties,
        air: options.air,
        probe: options.probe_against.of(),
        zero: options.probe_zero.of(),
        ..SlowLogOptions::default()
    };
    let read = |paths: &[PathBuf]| -> Result<Vec<Log>> {
        paths.iter().map(|path| read_slow(machine, path)).collect()
    };
    let (fit, check) = (read(given.fit)?, read(given.check)?);
    let slow = |logs: &'_ [Log], paths: &[PathBuf]| -> Result<Vec<SlowLog<'_>>> {
        let one = |(log, path): (&'_ Log, &PathBuf)| {
            let slow = SlowLog::new(machine, log, &reading);
            of_log(path, slow.into_diagnostic())
        };
        logs.iter().zip(paths).map(one).collect()
    };
    let (fit, check) = (slow(&fit, given.fit)?, slow(&check, given.check)?);
    note("compared with the thermal network: growth, power of the friction, temperatures");
    let progress = spinner();
    progress.set_message("growth and warming friction, each with and without");
    let found = explain(machine, &fit, &check).into_diagnostic()?;
    progress.finish_and_clear();
    let logs = Logs {
        fit: names(given.fit),
        check: names(given.check),
    };
    let discovered = discovered(machine, &found, &logs);
    discovered.discovery.notes.iter().for_each(note);
    write(given, &found, &discovered)
}

fn names(paths: &[PathBuf]) -> Vec<String> {
    paths
        .iter()
        .map(|path| path.display().to_string())
        .collect()
}

/// A log of hours.
fn read_slow(machine: &Axis, path: &Path) -> Result<Log> {
    let log = slow_log(machine, path)?;
    match is_slow(&log) {
        true => Ok(log),
        false => Err(miette!(
            "{} is a log of motion (10 Hz and faster), and others of this search are logs of hours; valid: a search for each kind",
            path.display()
        )),
    }
}

fn write(
    given: &Given<'_>,
    found: &axis_thermal::HeatExplained,
    discovered: &discrepancy::Discovered,
) -> Result<()> {
    let out = given.out;
    ready(out)?;
    let text = moved(&read_text(given.file)?, given.file, out)?;
    let keys = match discovered.discovery.effects.is_empty() {
        true => Vec::new(),
        false => given.machine.thermal_keys_of(&found.parameters),
    };
    let keys = keys
        .iter()
        .map(|(key, value)| format!("thermal.{key}={}", SixDigits(*value)));
    let keys: Vec<String> = keys.collect();
    let set: std::result::Result<Vec<SetKey>, String> =
        keys.iter().map(|key| key.parse()).collect();
    let text = with_keys(&text, &set.map_err(miette::Report::msg)?)?;
    Axis::parse(&out.join(AXIS).display().to_string(), &text)?;
    let mut files = FileSet::new(out, &[DISCOVERY, AXIS, NEXT, REPORT])?;
    let json = crate::json::pretty(&discovered.discovery).into_diagnostic()?;
    files.put(DISCOVERY, &json)?;
    files.put(AXIS, text.as_bytes())?;
    files.put(REPORT, discovery_page::page(discovered)?.as_bytes())?;
    files.publish()?;
    print(
        "discover",
        &Found {
            discovery: &discovered.discovery,
            added: keys.join("\n"),
            files: Files::of(out, false),
        },
    )
}
