//! Plans one move of each kind and a small program, and prints what they reach.
//!
//! `cargo run -p trajectories --example moves`

use trajectories::{Limits, Motion, Program, SCurve, Sine, Step, TrajectoryError};

fn main() -> Result<(), TrajectoryError> {
    let limits = Limits::new(0.1, 0.225, 1.2)?;
    println!("limits: 100 mm/s, 225 mm/s², 1200 mm/s³\n");
    println!("distance mm   duration s   peak mm/s   peak mm/s²   cruise s");
    for distance in [1e-6, 1e-3, 0.01, 0.04, 0.1, 0.3] {
        let curve = SCurve::plan(0.6, 0.6 + distance, &limits)?;
        let cruise = curve.cruise().map_or(0.0, |(begin, end)| end - begin);
        println!(
            "{:11.3} {:12.6} {:11.4} {:12.4} {:10.4}",
            distance * 1e3,
            curve.duration(),
            curve.peak_velocity() * 1e3,
            curve.peak_acceleration() * 1e3,
            cruise,
        );
    }

    let sine = Sine {
        amplitude: 1e-3,
        frequency: 5.0,
        cycles: 5,
    };
    let steps = vec![
        Step::Move { to: 0.9, limits },
        Step::Dwell { duration: 0.25 },
        Step::Sine(sine),
        Step::MoveBy { by: -0.3, limits },
    ];
    let program = Program::new(0.6, steps)?;
    println!("\nprogram of {:.4} s", program.duration());
    for (step, begin) in program.steps().iter().zip(program.step_times()) {
        println!("  {begin:8.4} s  {}", step.kind());
    }
    println!("\n    t s   position mm   velocity mm/s   acceleration mm/s²");
    for i in 0..=12 {
        let t = program.duration() * f64::from(i) / 12.0;
        let s = program.at(t);
        println!(
            "{t:7.3} {:13.6} {:15.6} {:20.6}",
            s.position * 1e3,
            s.velocity * 1e3,
            s.acceleration * 1e3
        );
    }
    println!("\nbounds: {:#?}", program.extremes());
    Ok(())
}
