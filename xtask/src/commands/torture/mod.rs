//! `torture`: damaged and made-up inputs, and killed, doubled and starved runs.

mod grammar;
mod kinds;
mod message;
mod mutate;
mod random;
mod stages;
mod watch;
mod worker;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use miette::{IntoDiagnostic, Result, miette};

use feed_axis::output::say;

/// Options of `torture`.
#[derive(Args)]
pub struct Options {
    /// Seed of every input and every kill
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// When to stop, in minutes: half for inputs, half for stages
    #[arg(long, value_name = "M", default_value_t = 10.0)]
    minutes: f64,
    /// How many inputs to try, if the time is enough
    #[arg(long, value_name = "COUNT", default_value_t = u64::MAX)]
    inputs: u64,
    /// How many runs to kill, if the time is enough; with 0, stages are left alone
    #[arg(long, value_name = "COUNT", default_value_t = u64::MAX)]
    kills: u64,
    /// Disturb one run by each kind of disturbance but kills, and not at every stage and size
    #[arg(long)]
    once: bool,
    /// Number of the first input: with --inputs 1, a single one again
    #[arg(long, value_name = "N", default_value_t = 0)]
    from: u64,
    /// Folder for inputs that showed a fault, and for work
    #[arg(long, value_name = "DIR", default_value = "runs/torture")]
    out: PathBuf,
    /// Judge inputs here, in this process
    #[arg(long, hide = true)]
    worker: bool,
}

/// Runs the command. Any fault is an error.
pub fn command(options: &Options) -> Result<()> {
    if options.worker {
        return worker::run(options);
    }
    if !(options.minutes.is_finite() && (0.0..=1e5).contains(&options.minutes)) {
        return Err(miette!("--minutes {}: give 0 to 100000", options.minutes));
    }
    std::fs::create_dir_all(&options.out).into_diagnostic()?;
    let half = Duration::from_secs_f64(30.0 * options.minutes);
    let start = Instant::now();
    let mut faults = 0;
    if options.inputs > 0 {
        // Without stages the inputs have all the time.
        let share = if options.kills == 0 { 2 * half } else { half };
        faults += watch::inputs(options, start + share)?;
    }
    if options.kills > 0 {
        faults += stages::torture(options, start + 2 * half)?;
    }
    if faults > 0 {
        return Err(miette!("{faults} faults; see {}", options.out.display()));
    }
    say("no faults")
}

/// A table with its columns as wide as they must be.
fn tell(rows: &[[String; 5]]) -> Result<()> {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: [usize; 5] = std::array::from_fn(|column| width(column).unwrap_or(0));
    for row in rows {
        let cells = row.iter().zip(widths).enumerate();
        let cells: Vec<String> = cells
            .map(|(i, (cell, w))| {
                if i == 0 {
                    format!("{cell:<w$}")
                } else {
                    format!("{cell:>w$}")
                }
            })
            .collect();
        say(cells.join("  ").trim_end())?;
    }
    Ok(())
}
