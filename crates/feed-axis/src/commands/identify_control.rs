//! `identify-control`: structure, gains and delay of an unknown controller, from logs.

use std::path::{Path, PathBuf};

use axis_sim::{Axis, FREQUENCIES, SixDigits};
use clap::Args;
use discrepancy::controller::{
    ClosedLoopGains, ControllerEstimate, Gain, Undetermined, closed_loop, estimate,
};
use discrepancy::logs::check_distinct;
use miette::{IntoDiagnostic, Result, miette};
use serde::Serialize;

use super::control_table::{limits, spelling, tolerance, with_control};
use super::discover::read_all;
use super::moved_file::moved;
use crate::context::{read_axis, read_text};
use crate::exit::wrong_use;
use crate::out_file;
use crate::output::{Worded, note, print, ready, write_whole};

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Axis file, with or without `[control]`
    #[arg(long, value_name = "FILE")]
    axis: PathBuf,
    /// Logs to fit to, with reference, position and command
    #[arg(long, value_name = "LOG", num_args = 1.., required = true)]
    fit: Vec<PathBuf>,
    /// Logs to choose the structure by; never fitted to
    #[arg(long, value_name = "LOG", num_args = 1.., required = true)]
    check: Vec<PathBuf>,
    /// Axis file to write, with the gains in `[control]` and their intervals in `[tolerances]`
    #[arg(long, value_name = "FILE", value_parser = out_file::file())]
    out: PathBuf,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
    /// Control frequency, Hz; required if the axis file has no `[control]`
    #[arg(long, value_name = "HZ")]
    frequency_hz: Option<f64>,
    /// Leave out the fit by closed-loop replay, which is shown for comparison and never written
    #[arg(long)]
    no_replay: bool,
}

/// Longest internal step of a file that had no `[simulation]`, s.
const STEP: f64 = 5e-5;

/// Share of the command that a controller which is there gives, as discovery asks it of named
/// effects.
const EXPLAINED: f64 = 0.9;

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    out_file::spare(&options.out, options.force)?;
    let mut machine = read_axis(&options.axis)?;
    let frequency = frequency(options, &machine)?;
    // Said before anything is computed: a file with such a `[control]` could not be read.
    let period = frequency.map_or(machine.period, f64::recip);
    machine.actuator.runs_at(period).map_err(|e| {
        let (file, what, valid) = (options.axis.display(), &e.what, &e.valid);
        miette!("{file}: the controller {what}; valid: {valid}")
    })?;
    let mut notes = Vec::new();
    let fit = read_all(&options.fit, &machine, &mut notes)?;
    let check = read_all(&options.check, &machine, &mut notes)?;
    check_distinct(&fit, &check).into_diagnostic()?;
    notes.iter().for_each(note);
    if frequency.is_some() {
        machine.period = period;
        machine.simulation.step = machine.simulation.step.min(STEP);
    }
    let found = estimate(&machine, &fit, &check).into_diagnostic()?;
    let mut text = words(&found, &machine);
    let replayed = match options.no_replay {
        true => None,
        false => Some(closed_loop(&machine, &found, &fit)),
    };
    match &replayed {
        Some(Ok(replayed)) => text += &replayed_words(replayed, &found, &machine),
        Some(Err(why)) => {
            text += &format!("\nno closed-loop replay with these gains: {why}\n");
        }
        None => {}
    }
    let replayed = replayed.and_then(std::result::Result::ok);
    let written = write(options, &machine, &found, frequency);
    if written.is_ok() {
        text += &format!("\n{}", options.out.display());
    }
    let gains = |gains: &[Gain]| -> Vec<GainFound> {
        gains
            .iter()
            .map(|gain| GainFound::of(&machine, &found, gain))
            .collect()
    };
    let value = Identified {
        controller: found.tried.first().map(|best| best.name.to_string()),
        gains: gains(&found.gains),
        command_delay_s: Interval::of(&found.delay),
        explained_fit: found.explained[0],
        explained_check: found.explained[1],
        gains_by_replay: replayed.map(|replayed| gains(&replayed.gains)),
        not_determined: doubts(&found, &machine),
        not_told_apart: not_told_apart(&found),
        notes,
        axis_file: written.is_ok().then_some(options.out.as_path()),
    };
    // What was found is shown whether a file of it could be written or not.
    print("identify-control", &Worded { text, value })?;
    written
}

/// Writes the axis file; none that could not be read.
fn write(
    options: &Options,
    machine: &Axis,
    found: &ControllerEstimate,
    frequency: Option<f64>,
) -> Result<()> {
    let folder = match options.out.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    ready(&folder)?;
    let file = moved(&read_text(&options.axis)?, &options.axis, &folder)?;
    let file = with_control(&file, machine, found, frequency)?;
    Axis::parse(&options.out.display().to_string(), &file)?;
    write_whole(&options.out, file.as_bytes())
}

/// The control frequency that was asked for, Hz.
fn frequency(options: &Options, machine: &Axis) -> Result<Option<f64>> {
    match (options.frequency_hz, machine.has_control()) {
        (None, false) => Err(miette!(
            "{} has no [control], so nothing says how often the controller runs; valid: --frequency-hz, such as --frequency-hz 1000 (the limit of the command is the actuator's, in [actuator])",
            options.axis.display()
        )),
        (Some(hz), _) if !(FREQUENCIES[0]..=FREQUENCIES[1]).contains(&hz) => {
            let [least, most] = FREQUENCIES.map(SixDigits);
            Err(wrong_use(format!(
                "--frequency-hz is {hz}; valid: {least} to {most}, which an axis file takes, as the drive's documents have it"
            )))
        }
        (asked, _) => Ok(asked),
    }
}

/// What `--format json` says.
#[derive(Serialize)]
struct Identified<'a> {
    /// Structure, in words.
    controller: Option<String>,
    gains: Vec<GainFound>,
    command_delay_s: Interval,
    /// Share of the command that is explained, on the logs that were fitted to.
    explained_fit: f64,
    /// The same, on the logs to choose by.
    explained_check: f64,
    /// By closed-loop replay, which rests on the machine's model.
    gains_by_replay: Option<Vec<GainFound>>,
    /// Gains that these logs do not determine, and why, in words.
    not_determined: Vec<String>,
    /// Structures that these logs do not tell from the one that was chosen.
    not_told_apart: Vec<String>,
    notes: Vec<String>,
    /// None if it could not be written.
    axis_file: Option<&'a Path>,
}

/// A gain as the axis file has it: its key ends in the unit.
#[derive(Serialize)]
struct GainFound {
    key: String,
    #[serde(flatten)]
    value: Interval,
}

/// A value with its interval.
#[derive(Serialize)]
struct Interval {
    value: f64,
    ci95: [f64; 2],
}

impl Interval {
    fn of(gain: &Gain) -> Self {
        Self {
            value: gain.value,
            ci95: gain.ci95,
        }
    }
}

impl GainFound {
    fn of(machine: &Axis, found: &ControllerEstimate, gain: &Gain) -> Self {
        let (key, factor) = spelling(machine, &found.control, gain.key);
        let value = Interval {
            value: gain.value / factor,
            ci95: gain.ci95.map(|end| end / factor),
        };
        Self { key, value }
    }
}

/// Gains that logs do not determine, and why.
fn doubts(found: &ControllerEstimate, machine: &Axis) -> Vec<String> {
    let one = |(key, why): &(&'static str, Undetermined)| match why {
        Undetermined::AtEdge(room) => {
            let (name, factor) = spelling(machine, &found.control, key);
            let [low, high] = room.map(|edge| SixDigits(edge / factor));
            let whose = match limits(&found.control, key) {
                Some(limits) if limits.iter().any(|edge| room.contains(edge)) => {
                    "of what an axis file takes"
                }
                _ => "of what is searched",
            };
            format!("{name}, which ends at the edge {whose}, {low} to {high}")
        }
        Undetermined::HoldsZero => {
            let (name, _) = spelling(machine, &found.control, key);
            format!("{name}, of which the 95 % interval holds 0")
        }
    };
    found.undetermined.iter().map(one).collect()
}

/// Structures that logs do not tell from the chosen one.
fn not_told_apart(found: &ControllerEstimate) -> Vec<String> {
    let others = found.tried.iter().skip(1).filter(|t| !t.is_told_apart);
    others.map(|t| t.name.clone()).collect()
}

/// The estimate as people read it.
fn words(found: &ControllerEstimate, machine: &Axis) -> String {
    let mut lines = Vec::new();
    let mut tried = found.tried.iter();
    if let Some(best) = tried.next() {
        lines.push(format!("controller: {}", best.name));
    }
    for gain in &found.gains {
        let tolerance = match tolerance(gain) {
            Some(tolerance) => format!("   tolerance {tolerance}"),
            None => String::new(),
        };
        lines.push(line(machine, found, gain) + &tolerance);
    }
    lines.push(late("delay of the logged command", &found.delay));
    let [fit, check] = found.explained.map(|share| 100.0 * share);
    let way = match found.instrumented {
        true => "with instruments",
        false => "by least squares",
    };
    lines.push(format!(
        "command explained: {fit:.6} % fitted, {check:.6} % on check logs; {way}"
    ));
    let doubts = doubts(found, machine).into_iter();
    lines.extend(doubts.map(|doubt| format!("  not determined by these logs: {doubt}")));
    let alike = not_told_apart(found);
    if !alike.is_empty() {
        lines.push(format!(
            "  not separated from it by these logs: {}. Faster motion, at several speeds, shows more",
            alike.join("; ")
        ));
    }
    if found.explained[1] < EXPLAINED {
        lines.push(format!(
            "  no structure gives the command of the check logs to {:.0} %: these are not the gains of that controller. Is the command the controller's own, its sign and unit right, the reference on time (delay_ms)? Otherwise leave the controller out (discover --balance)",
            100.0 * EXPLAINED
        ));
    }
    let least = found.tried.first().and_then(|best| best.left);
    for other in tried {
        lines.push(match (other.left, least) {
            (Some(left), Some(least)) => {
                let times = match left / least {
                    times if times >= 1e6 => "more than a million times".to_owned(),
                    times => format!("{times:.4} times"),
                };
                let name = &other.name;
                format!("  {name} leaves {left:.3e} of it on check logs, {times} as much")
            }
            _ => format!("  {} could not be fitted", other.name),
        });
    }
    lines.join("\n") + "\n"
}

fn replayed_words(
    replayed: &ClosedLoopGains,
    found: &ControllerEstimate,
    machine: &Axis,
) -> String {
    let head =
        "\nby closed-loop replay, which rests on the machine's model (not written):".to_owned();
    let mut lines = vec![head];
    let gains = replayed.gains.iter();
    lines.extend(gains.map(|gain| line(machine, found, gain)));
    let delay = replayed.command_delay.iter();
    lines.extend(delay.map(|delay| late("control-delay", delay)));
    lines.join("\n") + "\n"
}

fn line(machine: &Axis, found: &ControllerEstimate, gain: &Gain) -> String {
    let (name, factor) = spelling(machine, &found.control, gain.key);
    let value = gain.value / factor;
    let [low, high] = gain.ci95.map(|end| end / factor);
    format!("  {name} = {value:.6}   95 %: {low:.6} to {high:.6}")
}

fn late(what: &str, delay: &Gain) -> String {
    let [low, high] = delay.ci95.map(|end| 1e3 * end);
    let value = 1e3 * delay.value;
    format!("  {what} = {value:.4} ms   95 %: {low:.4} to {high:.4}")
}
