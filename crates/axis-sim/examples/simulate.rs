//! Simulates one trajectory of an axis file, prints its tracking error and,
//! where a path is given, writes the log as CSV.
//!
//! `cargo run --release -p axis-sim --example simulate -- data/axes/liu2025.toml 1 log.csv`

use std::path::Path;
use std::process::ExitCode;

use axis_log::metrics::ErrorSummary;
use axis_sim::{Axis, ClosedLoop, Cycle, Recorder};
use compensator::NoCompensation;
use trajectories::Motion;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match simulate(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn simulate(arguments: &[String]) -> Result<(), Box<dyn std::error::Error>> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/axes/liu2025.toml");
    let axis = Axis::read(arguments.first().map_or(own.as_path(), Path::new))?;
    let id = arguments
        .get(1)
        .map_or(Ok(1), |text| text.parse::<usize>())
        .unwrap_or(0);
    let Some(spec) = axis.trajectories.get(id.wrapping_sub(1)) else {
        let count = axis.trajectories.len();
        return Err(format!("the second argument is a trajectory, 1 to {count}").into());
    };
    run(&axis, spec, arguments.get(2))
}

fn run(
    axis: &Axis,
    spec: &axis_sim::MoveSpec,
    csv: Option<&String>,
) -> Result<(), Box<dyn std::error::Error>> {
    let motion = axis.plan(spec)?;
    let mut recorder = Recorder::new(axis);
    let begin = std::time::Instant::now();
    ClosedLoop::new(axis)?
        .run(&motion, &mut NoCompensation, |cycle| recorder.push(cycle))
        .completed()?;
    let took = begin.elapsed().as_secs_f64();

    let errors: Vec<f64> = recorder.cycles().iter().map(Cycle::error).collect();
    let summary = ErrorSummary::of(&errors)?;
    println!("{}: {}", axis.name, axis.description);
    println!(
        "motion            {:8.4} s, {} cycles",
        motion.duration(),
        errors.len()
    );
    println!("tracking error    {:8.3} µm max", 1e6 * summary.max);
    println!("                  {:8.4} µm mean", 1e6 * summary.mean);
    println!("                  {:8.4} µm RMS", 1e6 * summary.rms);
    println!(
        "simulated in      {:8.1} ms, {:.0} × real time",
        1e3 * took,
        motion.duration() / took
    );
    if let Some(path) = csv {
        axis_log::write_csv(path, &recorder.log()?)?;
        println!("log               {path}");
    }
    Ok(())
}
