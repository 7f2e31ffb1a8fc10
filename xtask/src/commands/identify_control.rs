//! `identify-control`: structure, gains and delay of an unknown controller, from logs.

use std::path::PathBuf;

use axis_sim::Axis;
use axis_sim::control::{CONTROLS, units_of_gain};
use axis_sim::part::Key;
use clap::Args;
use discrepancy::controller::{Estimate, closed_loop, estimate};
use discrepancy::intake::check_distinct;
use miette::{IntoDiagnostic, Result, miette};
use toml_edit::{DocumentMut, Item, Table, Value};

use super::discover::read_all;
use crate::context::read_text;
use crate::output::{say, write_whole};

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Axis file, with or without [control]
    #[arg(long, value_name = "FILE")]
    axis: PathBuf,
    /// Logs to fit to, with reference, position and command
    #[arg(long, value_name = "LOG", num_args = 1.., required = true)]
    fit: Vec<PathBuf>,
    /// Logs to choose the structure by; never fitted to
    #[arg(long, value_name = "LOG", num_args = 1.., required = true)]
    check: Vec<PathBuf>,
    /// Axis file to write, with the gains in [control]
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Control frequency, Hz; must be given where the axis file has no [control]
    #[arg(long, value_name = "HZ")]
    frequency_hz: Option<f64>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let mut machine = Axis::read(&options.axis)?;
    let mut notes = Vec::new();
    let fit = read_all(&options.fit, &machine, &mut notes)?;
    let check = read_all(&options.check, &machine, &mut notes)?;
    check_distinct(&fit, &check).into_diagnostic()?;
    notes.iter().try_for_each(say)?;
    if let Some(frequency) = frequency(options, &machine)? {
        machine.period = 1.0 / frequency;
    }
    let found = estimate(&machine, &fit, &check).into_diagnostic()?;
    tell(&found, &machine)?;
    match closed_loop(&machine, &found, &fit) {
        Ok(replayed) => {
            say("\nby closed-loop replay, which rests on the machine's model (not written):")?;
            for gain in &replayed.gains {
                say(line(&machine, &found, gain.key, gain.value, gain.ci95))?;
            }
        }
        Err(why) => say(format!("\nno closed-loop replay with these gains: {why}"))?,
    }
    let text = written(&read_text(&options.axis)?, &machine, &found)?;
    // What is written can be read.
    Axis::parse(&options.out.display().to_string(), &text)?;
    write_whole(&options.out, text.as_bytes())?;
    say(format!("\n{}", options.out.display()))
}

/// The control frequency that was asked for, Hz.
fn frequency(options: &Options, machine: &Axis) -> Result<Option<f64>> {
    match (options.frequency_hz, machine.has_control()) {
        (None, false) => Err(miette!(
            "{} has no [control], so nothing says how often the controller runs; valid: --frequency-hz, such as --frequency-hz 1000",
            options.axis.display()
        )),
        (Some(hz), _) if !(1.0..=1e6).contains(&hz) => {
            Err(miette!("--frequency-hz is {hz}; valid: 1 to 1e6"))
        }
        (asked, _) => Ok(asked),
    }
}

fn tell(found: &Estimate, machine: &Axis) -> Result<()> {
    let mut tried = found.tried.iter();
    if let Some(best) = tried.next() {
        say(format!("controller: {}", best.name))?;
    }
    for gain in &found.gains {
        say(line(machine, found, gain.key, gain.value, gain.ci95))?;
    }
    let (delay, [low, high]) = found.delay;
    say(format!(
        "  delay of the logged command = {:.4} ms   95 %: {:.4} to {:.4}",
        1e3 * delay,
        1e3 * low,
        1e3 * high
    ))?;
    let [fit, check] = found.explained.map(|share| 100.0 * share);
    let way = if found.instrumented { "with instruments" } else { "by least squares" };
    say(format!(
        "command explained below {:.0} Hz: {fit:.4} % fitted, {check:.4} % on check logs; {way}",
        found.cutoff
    ))?;
    let least = 1.0 - found.explained[1];
    for other in tried {
        say(match other.left {
            Some(left) => format!(
                "  {} leaves {:.4} % on check logs, {:.3} times as much",
                other.name,
                100.0 * left,
                left / least
            ),
            None => format!("  {} could not be fitted", other.name),
        })?;
    }
    Ok(())
}

/// Key with unit, and the unit's factor to SI, as the file has or takes it.
fn spelling(machine: &Axis, found: &Estimate, key: &str) -> (String, f64) {
    let control = &found.control;
    let Some(known) = control.kind().keys.iter().find(|k| k.name() == key) else {
        return (key.to_owned(), 1.0);
    };
    let own = control.values().unit(key);
    let effort = machine.actuator.effort();
    let units = units_of_gain(&**control, known, effort, &*machine.mechanism);
    let unit = units.iter().find(|(unit, _)| *unit == own).or(units.first());
    match unit {
        Some((unit, factor)) => (format!("{key}_{unit}"), *factor),
        None => (key.to_owned(), 1.0),
    }
}

fn line(machine: &Axis, found: &Estimate, key: &str, value: f64, ci95: [f64; 2]) -> String {
    let (name, factor) = spelling(machine, found, key);
    let [low, high] = ci95.map(|end| end / factor);
    format!("  {name} = {:.6}   95 %: {low:.6} to {high:.6}", value / factor)
}

/// The axis file's text with the controller in its [control]; all else as it was.
fn written(text: &str, machine: &Axis, found: &Estimate) -> Result<String> {
    let mut document: DocumentMut = text.parse().into_diagnostic()?;
    let has_sections = document.contains_key("mechanism");
    let kind = found.control.kind().name;
    let is_new = kind != machine.control.kind().name;
    if is_new && !has_sections {
        return Err(miette!(
            "the controller is {kind}, and a file of schema 1 has its own kind; valid: the axis file in schema 2"
        ));
    }
    let entry = document.entry("control").or_insert_with(|| Item::Table(Table::new()));
    let table = entry.as_table_mut().ok_or_else(|| miette!("control is no table; valid: [control]"))?;
    if is_new {
        let old = CONTROLS.iter().flat_map(|control| control.keys);
        for key in old.flat_map(spellings) {
            table.remove(&key);
        }
        set(table, "kind", kind.into());
    }
    let frequency = ["frequency_hz", "frequency_khz"].iter().any(|key| table.contains_key(key));
    if !frequency {
        set(table, "frequency_hz", digits(1.0 / machine.period).into());
    }
    for (key, word) in &found.words {
        set(table, key, (*word).into());
    }
    for gain in &found.gains {
        let (name, factor) = spelling(machine, found, gain.key);
        set(table, &name, digits(gain.value / factor).into());
    }
    if has_sections && !document.contains_key("simulation") {
        let mut table = Table::new();
        set(&mut table, "step_us", digits(1e6 * machine.period.min(5e-5)).into());
        document.insert("simulation", Item::Table(table));
    }
    Ok(document.to_string())
}

fn spellings(key: &Key) -> Vec<String> {
    let units = key.units().iter().map(|(unit, _)| format!("{}_{unit}", key.name()));
    units.chain([key.name().to_owned()]).collect()
}

/// Sets a value, a comment behind it kept.
fn set(table: &mut Table, key: &str, mut value: Value) {
    if let Some(old) = table.get(key).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    table.insert(key, Item::Value(value));
}

/// Seven digits of a number.
fn digits(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}
