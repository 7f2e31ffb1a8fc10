//! Plain training's mean squared error beside noisy samples of a sine, over that with Bayesian regularisation:
//! least and median of twelve seeds, for three schedules of its estimates.
//!
//! `cargo run --release -p cfnn --features train --example noisy_sine`
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use std::f64::consts::PI;

use cfnn::train::{Bayesian, Dataset, Trainer, TrainingSettings};
use cfnn::{Architecture, Error, Links, Shape};

/// Normal noise of deviation 1 (Box and Muller), number `k` of a linear congruential generator.
fn noise(k: usize) -> f64 {
    let mut state = k as u64;
    let mut next = || {
        state =
            (state.wrapping_mul(6_364_136_223_846_793_005)).wrapping_add(1_442_695_040_888_963_407);
        state = (state ^ (state >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((state >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    };
    let radius = (-2.0 * next().ln()).sqrt();
    radius * (2.0 * PI * next()).cos()
}

struct Task {
    samples: usize,
    hidden: &'static [usize],
    noise: f64,
    /// Periods in the range of the input.
    periods: f64,
    links: Links,
}

impl Task {
    fn error(&self, seed: usize, settings: TrainingSettings) -> Result<f64, Error> {
        let sine = |x: f64| (self.periods * PI * x).sin();
        let last = (self.samples - 1) as f64;
        let x: Vec<f64> = (0..self.samples)
            .map(|k| 2.0 * k as f64 / last - 1.0)
            .collect();
        let y = (x.iter().enumerate()).map(|(k, &x)| sine(x) + self.noise * noise(k + 1000 * seed));
        let y = y.collect();
        let data = Dataset::new(1, 1, x, y)?;
        let shape = Shape {
            inputs: 1,
            hidden: self.hidden.to_vec(),
            outputs: 1,
        };
        let architecture = Architecture::from(shape).with_links(self.links);
        let settings = TrainingSettings {
            epochs: 300,
            threads: 1,
            seed: seed as u64,
            ..settings
        };
        let mut trainer = Trainer::new(architecture, data.scaling()?, &data, settings)?;
        trainer.run(|_| ());
        let network = trainer.network();
        let mut scratch = network.scratch();
        let mut sum = 0.0;
        for k in -200..=200 {
            let x = f64::from(k) / 200.0;
            let error = network.predict_one(&[x], &mut scratch)? - sine(x);
            sum += error * error;
        }
        Ok(sum / 401.0)
    }
}

fn main() -> Result<(), Error> {
    let each_step = |initial_damping| TrainingSettings {
        initial_damping,
        bayesian: Some(Bayesian {
            estimate_below: 1.0,
            ..Bayesian::default()
        }),
        ..TrainingSettings::default()
    };
    let schedules = [
        each_step(1e-3),
        each_step(1.0),
        TrainingSettings::regularised(),
    ];
    println!(
        "samples, hidden, noise, links: least and median gain; each step from 1e-3; each step from 1; below 1 %"
    );
    let tasks: [(usize, &[usize], f64, f64); 4] = [
        (20, &[10], 0.2, 1.0),
        (41, &[20], 0.1, 1.0),
        (100, &[10], 0.2, 2.0),
        (30, &[6, 4], 0.1, 1.5),
    ];
    for links in [Links::Cascade, Links::FeedForward] {
        for (samples, hidden, noise, periods) in tasks {
            let task = Task {
                samples,
                hidden,
                noise,
                periods,
                links,
            };
            print!("{samples}, {hidden:?}, {noise}, {links:?}:");
            for settings in &schedules {
                let mut gains = Vec::new();
                for seed in 0..12 {
                    let plain = task.error(seed, TrainingSettings::default())?;
                    gains.push(plain / task.error(seed, settings.clone())?);
                }
                gains.sort_by(f64::total_cmp);
                print!("  {:.1} {:.1}", gains[0], 0.5 * (gains[5] + gains[6]));
            }
            println!();
        }
    }
    Ok(())
}
