//! `identify-control`: structure, gains and delay of an unknown controller, from logs.

use std::path::PathBuf;

use axis_sim::Axis;
use clap::Args;
use discrepancy::controller::{ClosedLoopGains, Estimate, Gain, closed_loop, estimate};
use discrepancy::logs::check_distinct;
use miette::{IntoDiagnostic, Result, miette};

use super::control_table::{spelling, tolerance, with_control};
use super::discover::{moved, read_all};
use crate::context::read_text;
use crate::output::{ready, say, write_whole};

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
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Control frequency, Hz; must be given where the axis file has no `[control]`
    #[arg(long, value_name = "HZ")]
    frequency_hz: Option<f64>,
    /// Leave out the fit by closed-loop replay, which is shown beside and never written
    #[arg(long)]
    no_replay: bool,
}

/// Longest internal step of a file that had no `[simulation]`, s.
const STEP: f64 = 5e-5;

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let mut machine = Axis::read(&options.axis)?;
    let frequency = frequency(options, &machine)?;
    let mut notes = Vec::new();
    let fit = read_all(&options.fit, &machine, &mut notes)?;
    let check = read_all(&options.check, &machine, &mut notes)?;
    check_distinct(&fit, &check).into_diagnostic()?;
    notes.iter().try_for_each(say)?;
    if let Some(frequency) = frequency {
        machine.period = 1.0 / frequency;
        machine.simulation.step = machine.simulation.step.min(STEP);
    }
    let found = estimate(&machine, &fit, &check).into_diagnostic()?;
    tell(&found, &machine)?;
    if !options.no_replay {
        match closed_loop(&machine, &found, &fit) {
            Ok(replayed) => tell_replayed(&replayed, &found, &machine)?,
            Err(why) => say(format!("\nno closed-loop replay with these gains: {why}"))?,
        }
    }
    let folder = match options.out.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    ready(&folder)?;
    let text = moved(&read_text(&options.axis)?, &options.axis, &folder)?;
    let text = with_control(&text, &machine, &found)?;
    // What is written can be read.
    Axis::parse(&options.out.display().to_string(), &text)?;
    write_whole(&options.out, text.as_bytes())?;
    say(format!("\n{}", options.out.display()))
}

/// The control frequency that was asked for, Hz.
fn frequency(options: &Options, machine: &Axis) -> Result<Option<f64>> {
    match (options.frequency_hz, machine.has_control()) {
        (None, false) => Err(miette!(
            "{} has no [control], so nothing says how often the controller runs; valid: --frequency-hz, such as --frequency-hz 1000 (the limit of the command is the actuator's, in [actuator])",
            options.axis.display()
        )),
        (Some(hz), _) if !(1.0..=1e6).contains(&hz) => Err(miette!(
            "--frequency-hz is {hz}; valid: 1 to 1e6, as the drive's documents have it"
        )),
        (asked, _) => Ok(asked),
    }
}

fn tell(found: &Estimate, machine: &Axis) -> Result<()> {
    let mut tried = found.tried.iter();
    if let Some(best) = tried.next() {
        say(format!("controller: {}", best.name))?;
    }
    for gain in &found.gains {
        let tolerance = match tolerance(gain) {
            Some(tolerance) => format!("   tolerance {tolerance}"),
            None => String::new(),
        };
        say(line(machine, found, gain) + &tolerance)?;
    }
    say(late("delay of the logged command", &found.delay))?;
    let [fit, check] = found.explained.map(|share| 100.0 * share);
    let way = match found.instrumented {
        true => "with instruments",
        false => "by least squares",
    };
    say(format!(
        "command explained: {fit:.6} % fitted, {check:.6} % on check logs; {way}"
    ))?;
    let least = found.tried.first().and_then(|best| best.left);
    for other in tried {
        say(match (other.left, least) {
            (Some(left), Some(least)) => format!(
                "  {} leaves {:.3e} of it on check logs, {:.4} times as much",
                other.name,
                left,
                left / least
            ),
            _ => format!("  {} could not be fitted", other.name),
        })?;
    }
    Ok(())
}

fn tell_replayed(replayed: &ClosedLoopGains, found: &Estimate, machine: &Axis) -> Result<()> {
    say("\nby closed-loop replay, which rests on the machine's model (not written):")?;
    for gain in &replayed.gains {
        say(line(machine, found, gain))?;
    }
    match &replayed.command_delay {
        Some(delay) => say(late("control-delay", delay)),
        None => Ok(()),
    }
}

fn line(machine: &Axis, found: &Estimate, gain: &Gain) -> String {
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
