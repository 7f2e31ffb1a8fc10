//! What a constant-speed record shows of vibration and of standstill, at any
//! sample rate, through noise, filters and coarse sensors.
#![cfg(feature = "identify")]

use crate::rig;
use std::f64::consts::TAU;

use crate::rig::{Noise, QUIET_MM_S, RAD_PER_M};
use lugre::identify::{ConstantSpeedRun, Reason, identify_static};

const SECONDS: f64 = 2.0;

fn condense(speeds: &[f64], rate: f64) -> ConstantSpeedRun {
    ConstantSpeedRun::from_record(speeds, &vec![1.0; speeds.len()], rate).expect("good")
}

fn samples(rate: f64) -> usize {
    (SECONDS * rate) as usize
}

fn white(n: usize, noise: &mut Noise) -> Vec<f64> {
    (0..n).map(|_| noise.normal()).collect()
}

/// Differences of a noisy position, of standard deviation 1.
fn differenced(n: usize, noise: &mut Noise) -> Vec<f64> {
    let position = white(n + 1, noise);
    position
        .windows(2)
        .map(|p| (p[1] - p[0]) / 2f64.sqrt())
        .collect()
}

/// White noise through a first-order low-pass at `corner` Hz, of standard
/// deviation 1.
fn filtered(n: usize, rate: f64, corner: f64, noise: &mut Noise) -> Vec<f64> {
    let keep = (-TAU * corner / rate).exp();
    let mut state = noise.normal();
    (0..n)
        .map(|_| {
            state = keep * state + (1.0 - keep * keep).sqrt() * noise.normal();
            state
        })
        .collect()
}

const RATES: [f64; 4] = [250.0, 1e3, 4e3, 20e3];

/// White, differenced, and filtered at 100 and 30 Hz.
fn noises(rate: f64, seed: u64) -> [Vec<f64>; 4] {
    let (n, mut noise) = (samples(rate), Noise::new(seed));
    [
        white(n, &mut noise),
        differenced(n, &mut noise),
        filtered(n, rate, 100.0, &mut noise),
        filtered(n, rate, 30.0, &mut noise),
    ]
}

#[test]
fn noise_is_no_vibration_at_any_rate() {
    for rate in RATES {
        for seed in 0..40 {
            for (kind, noise) in noises(rate, seed).iter().enumerate() {
                let speeds: Vec<f64> = noise.iter().map(|e| 1.0 + 0.5 * e).collect();
                let run = condense(&speeds, rate);
                assert_eq!(run.vibration, 0.0, "{rate} Hz, noise {kind}, seed {seed}");
            }
        }
    }
}

/// 62 Hz at 15 % of the mean speed, under noise of 15 %.
#[test]
fn a_vibration_is_found_at_any_rate() {
    for rate in RATES {
        for seed in 0..20 {
            for (kind, noise) in noises(rate, seed).iter().enumerate() {
                let swinging: Vec<f64> = noise
                    .iter()
                    .enumerate()
                    .map(|(i, e)| 1.0 + 0.15 * (TAU * 62.0 * i as f64 / rate).sin() + 0.15 * e)
                    .collect();
                let run = condense(&swinging, rate);
                // Measured: −8 % to +18 %, and 0.19 Hz.
                let amplitude = run.vibration / 0.15;
                let off = (run.vibration_frequency - 62.0).abs();
                assert!(
                    (0.75..1.3).contains(&amplitude) && off < 0.5,
                    "{rate} Hz, noise {kind}, seed {seed}: {run:?}"
                );
            }
        }
        let clean: Vec<f64> = (0..samples(rate))
            .map(|i| 1.0 + 0.3 * (TAU * 62.0 * i as f64 / rate).sin())
            .collect();
        let run = condense(&clean, rate);
        // Biased by the shorter overlap at a lag, −1.1 %; 0.042 Hz measured.
        assert!((run.vibration / 0.3 - 1.0).abs() < 0.02, "{run:?}");
        assert!((run.vibration_frequency - 62.0).abs() < 0.1, "{run:?}");
    }
}

/// An axis that stands still, through a sensor that does not show it as 0.
fn standstills(rate: f64, seed: u64) -> Vec<Vec<f64>> {
    let n = samples(rate);
    let mut all: Vec<Vec<f64>> = noises(rate, seed).into();
    let mut noise = Noise::new(seed + 1000);
    // Rounded to a step of 1 of the sensor, larger and smaller than its noise.
    for size in [2.0, 0.5] {
        let rough = white(n, &mut noise);
        all.push(rough.iter().map(|e| (size * e).round()).collect());
    }
    // One count of an encoder that flickers between two, sometimes or once.
    let position: Vec<f64> = (0..=n).map(|_| f64::from(noise.normal() > 1.0)).collect();
    all.push(position.windows(2).map(|p| p[1] - p[0]).collect());
    let mut once = vec![0.0; n];
    once[n / 3] = 1.0;
    all.push(once);
    all.push(vec![0.0; n]);
    all
}

#[test]
fn standstill_is_recognised_through_noise_and_resolution() {
    for rate in RATES {
        for seed in 0..15 {
            for (kind, speeds) in standstills(rate, seed).iter().enumerate() {
                let run = condense(speeds, rate);
                assert!(
                    run.is_at_rest(),
                    "{rate} Hz, kind {kind}, seed {seed}: {run:?}"
                );
            }
        }
    }
}

/// Slow motion is not standstill: 200 counts of an encoder, evenly spread or
/// flickering.
#[test]
fn slow_motion_is_no_standstill() {
    for rate in RATES {
        let n = samples(rate);
        for seed in 0..15 {
            let mut noise = Noise::new(seed);
            let jitter: Vec<f64> = white(n + 1, &mut noise);
            let counts = |rough: f64| -> Vec<f64> {
                let place = |i: usize| (200.0 * i as f64 / n as f64 + rough * jitter[i]).floor();
                (0..n).map(|i| place(i + 1) - place(i)).collect()
            };
            for speeds in [counts(0.0), counts(0.3)] {
                let run = condense(&speeds, rate);
                assert!(!run.is_at_rest(), "{rate} Hz, seed {seed}: {run:?}");
            }
        }
    }
    // Constant samples are taken at their word.
    assert!(!condense(&[1e-3; 100], 1e3).is_at_rest());
    assert!(condense(&[0.0; 100], 1e3).is_at_rest());
}

/// Runs at rest, whose torque is anything up to T_S, do not reach the fit.
#[test]
fn runs_at_rest_are_left_out() {
    let law = rig::paper();
    let mut noise = Noise::new(3);
    let mut runs = Vec::new();
    for v in QUIET_MM_S {
        for speed in [v * 1e-3 * RAD_PER_M, -v * 1e-3 * RAD_PER_M] {
            let torques: Vec<f64> = (0..1000)
                .map(|_| law.steady_state(speed) * (1.0 + 0.01 * noise.normal()))
                .collect();
            runs.push(
                ConstantSpeedRun::from_record(&vec![speed; 1000], &torques, 1e3).expect("good"),
            );
        }
    }
    let moving = runs.len();
    let alone = identify_static(&runs).expect("enough runs");
    for speeds in standstills(1e3, 5) {
        let torques: Vec<f64> = speeds.iter().map(|_| 0.1 + 0.01 * noise.normal()).collect();
        runs.push(ConstantSpeedRun::from_record(&speeds, &torques, 1e3).expect("good"));
    }
    let fit = identify_static(&runs).expect("enough runs");
    assert_eq!(fit.left_out.len(), runs.len() - moving);
    for left in &fit.left_out {
        assert!(
            left.run >= moving && left.reason == Reason::AtRest,
            "{left:?}"
        );
    }
    assert_eq!(fit.parameters(), alone.parameters());
}
