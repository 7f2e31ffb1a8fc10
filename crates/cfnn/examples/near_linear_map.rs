//! A map that is almost linear, with a small sharp feature: what is left
//! after the best linear map, and after training, on samples not seen.
//!
//! `cargo run --release -p cfnn --example near_linear_map [epochs [sizes...]]`
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use std::time::Instant;

use cfnn::train::{Dataset, Initialisation, Trainer, TrainingSettings};
use cfnn::{Error, Network, Shape};

/// Position, speed, acceleration, current, each from -1 to 1; the increment
/// of the position over one step, with a friction that changes its sign and
/// falls with speed close to rest.
fn increment(x: &[f64]) -> f64 {
    let speed = 100.0 * x[1];
    let stribeck = 1.0 + 0.4 * (-speed * speed).exp();
    let friction = (3.0 * speed).tanh() * stribeck;
    x[1] + 1e-2 * x[2] + 1e-4 * (x[3] - friction)
}

/// Every second sample has its speed drawn towards zero, where the map bends.
fn samples(count: usize, start: usize) -> Result<Dataset, Error> {
    let input: Vec<f64> = (start..start + count)
        .flat_map(|s| {
            // An additive recurrence fills the cube evenly.
            let mut x = [2.0f64, 3.0, 5.0, 7.0].map(|p| (s as f64 * p.sqrt()).fract() * 2.0 - 1.0);
            if s % 2 == 0 {
                x[1] = x[1].powi(5);
            }
            x
        })
        .collect();
    let target = input.chunks(4).map(increment).collect();
    Dataset::new(4, 1, input, target)
}

/// Largest and root-mean-square error.
fn errors(network: &Network, data: &Dataset) -> Result<(f64, f64), Error> {
    let mut scratch = network.scratch();
    let (mut largest, mut sum) = (0.0f64, 0.0);
    let samples = (0..data.len()).filter_map(|s| data.input(s).zip(data.target(s)));
    for (input, target) in samples {
        let error = network.predict_one(input, &mut scratch)? - target[0];
        largest = largest.max(error.abs());
        sum += error * error;
    }
    Ok((largest, (sum / data.len() as f64).sqrt()))
}

fn main() -> Result<(), Error> {
    let mut arguments = std::env::args().skip(1).filter_map(|a| a.parse().ok());
    let epochs = arguments.next().unwrap_or(60);
    let given: Vec<usize> = arguments.collect();
    let hidden = if given.is_empty() { vec![12, 6] } else { given };
    let (training, unseen) = (samples(5000, 1)?, samples(1000, 100_001)?);

    let linear = Shape {
        inputs: 4,
        hidden: vec![],
        outputs: 1,
    };
    let start = TrainingSettings {
        initialisation: Initialisation::LinearStart,
        ..TrainingSettings::default()
    };
    let trainer = Trainer::new(linear, training.scaling()?, &training, start)?;
    let (largest, rms) = errors(&trainer.network(), &unseen)?;
    println!("linear map: max {largest:.2e}, RMS {rms:.2e}");

    for initialisation in [
        Initialisation::NguyenWidrow,
        Initialisation::LinearStart,
        Initialisation::DataAdapted { axis_aligned: 0.5 },
    ] {
        for resolve_output in [false, true] {
            let settings = TrainingSettings {
                epochs,
                initial_damping: 0.97,
                initialisation,
                resolve_output,
                min_gradient: 0.0,
                ..TrainingSettings::default()
            };
            let shape = Shape {
                inputs: 4,
                hidden: hidden.clone(),
                outputs: 1,
            };
            let began = Instant::now();
            let mut trainer = Trainer::new(shape, training.scaling()?, &training, settings)?;
            let outcome = trainer.run(|_| ());
            let (largest, rms) = errors(&trainer.network(), &unseen)?;
            let trials: usize = trainer.history().iter().map(|e| e.trials).sum();
            println!(
                "{initialisation:?}, output resolved: {resolve_output}: max {largest:.2e}, \
                 RMS {rms:.2e}, {outcome:?} after {} epochs, {trials} trials, {:.1} s",
                trainer.history().len(),
                began.elapsed().as_secs_f64()
            );
        }
    }
    Ok(())
}
