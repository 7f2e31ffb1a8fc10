//! `bench`: the speed of every hot path beside something run in the same
//! process, so that the ratios hold on any machine.

mod axis;
mod designs;
mod mechanics;
mod network;
mod timing;

use std::path::PathBuf;

use axis_sim::Axis;
use clap::Args;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use feed_axis::output::{say, write_whole};

/// Options of `bench`.
#[derive(Args)]
pub struct Options {
    /// Axis file
    #[arg(long, value_name = "FILE", default_value = "data/axes/liu2025.toml")]
    axis: PathBuf,
    /// Where to write the rows as JSON: name, value, unit, ratio
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Threads of what runs on several
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=512))]
    threads: u16,
    /// Small sizes and few repetitions, to see that everything runs; the
    /// numbers say little
    #[arg(long)]
    quick: bool,
}

/// One measured number.
#[derive(Serialize)]
struct Row {
    /// What was measured, with its size.
    name: String,
    /// The least of several repetitions.
    value: f64,
    unit: &'static str,
    /// How many times better than what it is compared with.
    ratio: f64,
    /// What it is compared with.
    #[serde(skip)]
    against: &'static str,
}

/// How much to measure.
struct Plan {
    quick: bool,
    repetitions: usize,
    pool: rayon::ThreadPool,
    threads: usize,
}

impl Plan {
    /// A size in full, and in the small version.
    fn size(&self, full: usize, quick: usize) -> usize {
        if self.quick { quick } else { full }
    }
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let axis = Axis::read(&options.axis)?;
    let threads = usize::from(options.threads);
    let plan = Plan {
        quick: options.quick,
        repetitions: if options.quick { 2 } else { 12 },
        pool: pool(threads)?,
        threads,
    };
    let mut rows = Vec::new();
    rows.extend(axis::rows(&axis, &plan)?);
    rows.extend(network::rows(&plan)?);
    rows.extend(designs::rows(&plan)?);
    rows.extend(mechanics::rows(&plan)?);
    table(&rows)?;
    if let Some(file) = &options.json {
        let mut bytes = serde_json::to_vec_pretty(&rows).into_diagnostic()?;
        bytes.push(b'\n');
        write_whole(file, &bytes)?;
    }
    Ok(())
}

fn pool(threads: usize) -> Result<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .into_diagnostic()
}

fn table(rows: &[Row]) -> Result<()> {
    let wide = rows.iter().map(|row| row.name.len()).max().unwrap_or(0);
    for row in rows {
        say(format!(
            "{:wide$}  {:>10}  {:>8} × {}",
            row.name,
            timing::with_unit(row.value, row.unit),
            timing::digits(row.ratio),
            row.against,
        ))?;
    }
    say("Least of several repetitions; the last columns say how many times better than what.")
}
