//! Plans the changes of velocity that standard input lists, a line each: velocity, acceleration,
//! wanted velocity, least and greatest acceleration, jerk. Prints duration and end position of each from
//! position 0. `tests/against_ruckig.py` compares them with those of ruckig.

use std::error::Error;
use std::io::{BufRead, BufWriter, Write};

use trajectories::{Setpoint, VelocityChange, VelocityLimits};

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let [velocity, acceleration, wanted, least, greatest, jerk] = numbers?[..] else {
            return Err(format!("six numbers are needed in a line, not {line:?}").into());
        };
        let limits = VelocityLimits::new(least, greatest, jerk)?;
        let start = Setpoint {
            position: 0.0,
            velocity,
            acceleration,
            jerk: 0.0,
        };
        let change = VelocityChange::plan(&start, wanted, &limits)?;
        writeln!(out, "{:e} {:e}", change.duration(), change.end().position)?;
    }
    Ok(out.flush()?)
}
