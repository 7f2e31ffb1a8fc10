//! Plans the transfers that standard input lists, a line each: velocity and acceleration at the start (position 0);
//! position, velocity and acceleration wanted; least and greatest velocity, least and greatest acceleration, jerk;
//! least duration. Prints duration and end position, velocity, acceleration just before the end, or `-` if refused.
//! `tests/transfers_against_ruckig.py` compares them with those of ruckig. With the argument `f32`, in `f32`; with
//! `together`, every three lines are axes that start and end together; with `straight`, on a line, of which the
//! duration alone is printed.

use std::error::Error;
use std::io::{BufRead, BufWriter, Write};

use trajectories::{
    Axes, AxisTask, Motion, Real, Setpoint, TrajectoryError, Transfer, TransferLimits,
    VelocityLimits,
};

fn task<T: Real>(numbers: &[f64; 11]) -> Result<AxisTask<T>, TrajectoryError> {
    let [v0, a0, p1, v1, a1, back, fast, least, greatest, jerk, _] = numbers.map(T::of);
    let limits = TransferLimits::new(back, fast, VelocityLimits::new(least, greatest, jerk)?)?;
    let state = |position, velocity, acceleration| Setpoint {
        position,
        velocity,
        acceleration,
        jerk: T::ZERO,
    };
    Ok(AxisTask {
        start: state(T::ZERO, v0, a0),
        target: state(p1, v1, a1),
        limits,
    })
}

fn together(lines: &[[f64; 11]], straight: bool) -> Result<Option<f64>, Box<dyn Error>> {
    let tasks = [task(&lines[0])?, task(&lines[1])?, task(&lines[2])?];
    if straight {
        return Ok(Axes::straight(&tasks)?.map(|axes| axes.duration()));
    }
    Ok(Some(Axes::together(&tasks)?.duration()))
}

fn plan<T: Real>(numbers: &[f64; 11]) -> Result<[f64; 4], TrajectoryError> {
    let AxisTask {
        start,
        target,
        limits,
    } = task(numbers)?;
    let lasting = T::of(numbers[10]);
    let transfer = Transfer::lasting(&start, &target, &limits, lasting)?;
    let duration = transfer.duration();
    let end = transfer.at(duration * (T::ONE - T::EPSILON));
    Ok([duration, end.position, end.velocity, end.acceleration].map(|x| x.to_f64()))
}

fn main() -> Result<(), Box<dyn Error>> {
    let kind = std::env::args().nth(1).unwrap_or_default();
    let mut lines = Vec::new();
    let mut out = BufWriter::new(std::io::stdout().lock());
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let numbers: [f64; 11] = numbers?
            .try_into()
            .map_err(|_| format!("eleven numbers are needed in a line, not {line:?}"))?;
        if kind == "together" || kind == "straight" {
            lines.push(numbers);
            if lines.len() == 3 {
                match together(&lines, kind == "straight") {
                    Ok(Some(duration)) => writeln!(out, "{duration:e}")?,
                    _ => writeln!(out, "-")?,
                }
                lines.clear();
            }
            continue;
        }
        let planned = if kind == "f32" {
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
