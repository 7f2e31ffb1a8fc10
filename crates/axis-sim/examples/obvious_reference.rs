//! Makes `tests/reference/trajectory1.csv` anew: trajectory 1 of the paper's
//! axis by a slow, obvious simulation that shares no code with the crate.
//! With `--halved`, how much halving its step changes.
//!
//! `cargo run --release -p axis-sim --example obvious_reference`

#[path = "../tests/suite/obvious.rs"]
mod obvious;

use std::fmt::Write as _;

use obvious::{EVERY, HEADER, PERIOD, Row, STEPS, duration, simulate};

fn main() -> std::io::Result<()> {
    let cycles = (duration() / PERIOD).floor() as usize + 1;
    if std::env::args().any(|argument| argument == "--halved") {
        halved(cycles / 4);
        return Ok(());
    }
    let mut text = format!("{HEADER}\n");
    let (mut k, mut most, mut sum) = (0, 0.0_f64, 0.0);
    simulate(cycles, STEPS, |row| {
        if k % EVERY == 0 {
            text += &(obvious::line(row) + "\n");
        }
        k += 1;
        let error = (row.reference - row.position).abs();
        most = most.max(error);
        sum += error;
    });
    let mean = sum / cycles as f64;
    // Writing to a string cannot fail.
    let _ = writeln!(text, "# error_max_m,{most:.9e}\n# error_mean_m,{mean:.9e}");
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/reference/trajectory1.csv"
    );
    std::fs::write(file, text)
}

/// Greatest change of position, angle, speed and current with half the step.
fn halved(cycles: usize) {
    let run = |steps| {
        let mut rows: Vec<Row> = Vec::new();
        simulate(cycles, steps, |row| rows.push(*row));
        rows
    };
    let mut most = [0.0_f64; 4];
    for (a, b) in run(STEPS).iter().zip(&run(2 * STEPS)) {
        let apart = [
            a.position - b.position,
            a.motor_angle - b.motor_angle,
            a.motor_speed - b.motor_speed,
            a.iq - b.iq,
        ];
        for (most, apart) in most.iter_mut().zip(apart) {
            *most = most.max(apart.abs());
        }
    }
    println!("{cycles} cycles: m, rad, rad/s, A: {most:?}");
}
