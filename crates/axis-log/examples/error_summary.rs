//! Tracking error of a log, read from a CSV file or made here:
//! `cargo run -p axis-log --example error_summary [-- FILE]`.

use std::error::Error;
use std::time::Instant;

use axis_log::{Channel, Log, metrics::ErrorSummary, read_csv, write_csv_to};

fn main() -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let log = match std::env::args().nth(1) {
        Some(path) => read_csv(path, &["position_ref_m", "position_m"])?,
        None => made_up()?,
    };
    println!("{} samples in {:?}", log.len(), start.elapsed());
    for channel in log.channels() {
        println!("  {} [{}]", channel.name, channel.unit);
    }
    let error = ErrorSummary::between(log.channel("position_ref_m")?, log.channel("position_m")?)?;
    println!(
        "tracking error: max {:.3} µm, mean {:.3} µm, rms {:.3} µm",
        error.max * 1e6,
        error.mean * 1e6,
        error.rms * 1e6
    );
    let (start, mut text) = (Instant::now(), Vec::new());
    write_csv_to(&mut text, &log)?;
    println!("as CSV: {} bytes in {:?}", text.len(), start.elapsed());
    Ok(())
}

/// A sine that lags its reference by one 10 kHz cycle.
fn made_up() -> Result<Log, Box<dyn Error>> {
    let time: Vec<f64> = (0..20_000).map(|k| f64::from(k) * 1e-4).collect();
    let sine = |delay: f64| {
        let at = |t: &f64| 0.01 * (std::f64::consts::TAU * (t - delay)).sin();
        time.iter().map(at).collect::<Vec<f64>>()
    };
    Ok(Log::new(vec![
        Channel::new("t_s", time.clone())?,
        Channel::new("position_ref_m", sine(0.0))?,
        Channel::new("position_m", sine(1e-4))?,
    ])?)
}
