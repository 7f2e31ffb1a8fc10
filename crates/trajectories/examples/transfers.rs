//! Plans the transfers that standard input lists, a line each: velocity and acceleration at the start (position 0);
//! position, velocity and acceleration wanted; least and greatest velocity, least and greatest acceleration, jerk;
//! least duration. Prints duration and end position, velocity, acceleration just before the end, or `-` if refused.
//! `tests/transfers_against_ruckig.py` compares them with those of ruckig. With the argument `f32`, in `f32`.

use std::error::Error;
use std::io::{BufRead, BufWriter, Write};

use trajectories::{Motion, Real, Setpoint, TrajectoryError, Transfer, TransferLimits, VelocityLimits};

fn plan<T: Real>(numbers: &[f64; 11]) -> Result<[f64; 4], TrajectoryError> {
    let [v0, a0, p1, v1, a1, back, fast, least, greatest, jerk, lasting] = numbers.map(T::of);
    let limits = TransferLimits::new(back, fast, VelocityLimits::new(least, greatest, jerk)?)?;
    let state = |position, velocity, acceleration| Setpoint {
        position,
        velocity,
        acceleration,
        jerk: T::ZERO,
    };
    let (start, target) = (state(T::ZERO, v0, a0), state(p1, v1, a1));
    let transfer = Transfer::lasting(&start, &target, &limits, lasting)?;
    let duration = transfer.duration();
    let end = transfer.at(duration * (T::ONE - T::EPSILON));
    Ok([duration, end.position, end.velocity, end.acceleration].map(|x| x.to_f64()))
}

fn main() -> Result<(), Box<dyn Error>> {
    let single = std::env::args().nth(1).as_deref() == Some("f32");
    let mut out = BufWriter::new(std::io::stdout().lock());
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let numbers: [f64; 11] = numbers?
            .try_into()
            .map_err(|_| format!("eleven numbers are needed in a line, not {line:?}"))?;
        let planned = if single {
            plan::<f32>(&numbers)
        } else {
            plan::<f64>(&numbers)
        };
        match planned {
            Ok([t, p, v, a]) => writeln!(out, "{t:e} {p:e} {v:e} {a:e}")?,
            Err(_) => writeln!(out, "-")?,
        }
    }
    Ok(out.flush()?)
}
