//! Torque balance of noisy motions: what noise of the acceleration does to an inertia.

use std::f64::consts::TAU;

use axis_log::Log;
use axis_sim::Balance;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::balance::{bench, log_of, motion};

const INERTIA: f64 = 0.3;

/// Least-squares inertia from a motion with white noise (rad), as a share of the true one,
/// and the share that is foretold to be lost; the mean of some runs.
fn fitted(noise: f64, cutoff: &str) -> [f64; 2] {
    const RUNS: u64 = 10;
    let axis = bench(INERTIA, cutoff);
    let run = |seed: u64| {
        let [mut position, acceleration] = motion(20_000);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        for x in &mut position {
            let n: f64 = StandardNormal.sample(&mut random);
            *x += noise * n;
        }
        let torque = acceleration.iter().map(|a| INERTIA * a).collect();
        let log = log_of(&[("position_rad", position), ("torque_n_m", torque)]);
        let balance = Balance::new(&log, 1e-3, &axis).unwrap();
        let trace = balance.run(&axis, &[], None).unwrap();
        let model = trace.channel("torque_n_m").unwrap();
        let measured = balance.compared().channel("torque_n_m").unwrap();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let share = product(measured, model) / product(model, model);
        [share, balance.quality().attenuation]
    };
    let sums = (0..RUNS)
        .map(run)
        .fold([0.0; 2], |s, r| [s[0] + r[0], s[1] + r[1]]);
    sums.map(|sum| sum / RUNS as f64)
}

/// With a cut-off where noise counts, an inertia comes out too small by what is foretold;
/// with the one that is taken from the log, by less than 0.2 %.
#[test]
fn noise_draws_an_inertia_by_what_is_foretold() {
    for (noise, cutoff) in [(3e-4, 40.0), (1e-3, 30.0), (1e-3, 25.0)] {
        let [share, foretold] = fitted(noise, &format!("[balance]\ncutoff_hz = {cutoff}"));
        let lost = 1.0 - share;
        println!("noise {noise}, {cutoff} Hz: lost {lost:.4e}, foretold {foretold:.4e}");
        assert!(foretold > 0.01, "a case that tells nothing: {foretold}");
        assert!(
            (lost / foretold - 1.0).abs() < 0.2,
            "{lost} beside {foretold}"
        );
    }
    for noise in [1e-6, 1e-5, 1e-4, 1e-3] {
        let [share, foretold] = fitted(noise, "");
        println!(
            "noise {noise}: lost {:.4e}, foretold {foretold:.4e}",
            1.0 - share
        );
        assert!(foretold <= 1e-3);
        assert!((1.0 - share).abs() < 2e-3, "{share}");
    }
}

/// Standstill says nothing of friction, and is left out: as long as the sensor's noise
/// hides motion, and no longer.
#[test]
fn standstill_is_left_out() {
    let [mut position, _] = motion(10_000);
    // The second half stands.
    let last = position[5000];
    position[5000..].iter_mut().for_each(|x| *x = last);
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for x in &mut position {
        let n: f64 = StandardNormal.sample(&mut random);
        *x += 1e-5 * n;
    }
    let torque = position.clone();
    let log = log_of(&[("position_rad", position), ("torque_n_m", torque)]);
    let axis = bench(INERTIA, "");
    let balance = Balance::new(&log, 1e-3, &axis).unwrap();
    let time = balance.compared().time();
    let late = time.iter().filter(|t| **t > 5.2).count();
    assert!(
        late as f64 <= 0.01 * time.len() as f64,
        "{late} of {}",
        time.len()
    );
    let early = time.iter().filter(|t| **t < 5.0).count();
    assert!(early as f64 * balance.compared_period() > 4.0, "{early}");
}

/// A rotor at 30 rad/s that hardly swings, with cogging of an order, and white noise of its position (rad).
fn rolling(order: f64, noise: f64, samples: usize) -> Log {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let angle = |k: usize| 30.0 * k as f64 * 1e-3 + 0.05 * (8.0 * k as f64 * 1e-3).sin();
    let angles: Vec<f64> = (0..samples).map(angle).collect();
    let torque = angles
        .iter()
        .map(|a| 0.01 + 2e-3 * (order * a).sin())
        .collect();
    let shown = angles.iter().map(|a| {
        let n: f64 = StandardNormal.sample(&mut random);
        a + noise * n
    });
    log_of(&[("position_rad", shown.collect()), ("torque_n_m", torque)])
}

/// Of a rotor of 4e-6 kg·m² its acceleration is noise at any frequency, and its inertia makes nothing of the
/// torque. 12 a turn at 30 rad/s are 57 Hz.
#[test]
fn a_log_at_one_speed_is_compared_up_to_what_repeats_with_the_turn() {
    let unknown = "[tolerances]\ntable_inertia = \"unknown\"";
    for (order, hertz) in [(12.0, 57.3), (36.0, 171.9)] {
        let log = rolling(order, 1e-3, 3000);
        let balance = Balance::new(&log, 1e-3, &bench(4e-6, unknown)).unwrap();
        let quality = balance.quality();
        println!("{quality:?}");
        assert_eq!(quality.orders, [order]);
        assert!(quality.cutoff > hertz && quality.cutoff < 1.5 * hertz);
        let [kept, all] = quality.samples;
        assert!(10 * kept > 9 * all, "{kept} of {all}");
        // What is compared shows it as it is: 2 mN·m behind the low-pass.
        let torque = balance.compared().channel("torque_n_m").unwrap();
        let most = torque
            .iter()
            .fold(0.0_f64, |most, t| most.max((t - 0.01).abs()));
        let left = 2e-3 / (1.0 + (hertz / quality.cutoff).powi(8));
        assert!((most / left - 1.0).abs() < 0.1, "{most} {left}");
    }
}

#[test]
fn what_bounds_a_cutoff_is_said_and_what_would_set_it() {
    let sentence = |more: &str| {
        let log = rolling(12.0, 1e-3, 3000);
        let balance = Balance::new(&log, 1e-3, &bench(4e-6, more)).unwrap();
        balance.quality().sentence("log")
    };
    let asked = sentence("[balance]\ncutoff_hz = 30");
    assert!(
        asked.contains("30.000 Hz (as [balance] cutoff_hz of the axis file asks)"),
        "{asked}"
    );
    let capped = sentence("[balance]\ncutoff_hz = 400");
    assert!(
        capped.contains("250.000 Hz (capped by the sampling rate"),
        "{capped}"
    );
    // Too short for anything.
    let log = rolling(12.0, 1e-3, 60);
    let error = Balance::new(&log, 1e-3, &bench(4e-6, ""))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("below") && error.contains("[balance] cutoff_hz"),
        "{error}"
    );
}

/// Every eleventh sample of a motion of up to 4 Hz is balanced as well as all are; of a motion of 30 Hz they
/// show another one.
#[test]
fn a_slow_log_is_balanced_where_it_shows_its_motion() {
    let [position, acceleration] = motion(20_000);
    let torque: Vec<f64> = acceleration.iter().map(|a| INERTIA * a).collect();
    let every = |series: &[f64]| -> Vec<f64> { series.iter().step_by(11).copied().collect() };
    let axis = bench(INERTIA, "");
    let slow = log_of(&[
        ("position_rad", every(&position)),
        ("torque_n_m", every(&torque)),
    ]);
    let balance = Balance::new(&slow, 11e-3, &axis).unwrap();
    let model = balance.run(&axis, &[], None).unwrap();
    let measured = balance.compared().channel("torque_n_m").unwrap();
    let model = model.channel("torque_n_m").unwrap();
    let off = model
        .iter()
        .zip(measured)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>();
    let all = measured.iter().map(|b| b * b).sum::<f64>();
    assert!((off / all).sqrt() < 1e-3, "{}", (off / all).sqrt());
    let fast: Vec<f64> = (0..2000)
        .map(|k| (TAU * 30.0 * 11e-3 * f64::from(k)).sin())
        .collect();
    let log = log_of(&[("position_rad", fast.clone()), ("torque_n_m", fast)]);
    let error = Balance::new(&log, 11e-3, &axis).unwrap_err().to_string();
    assert!(error.contains("samples a second at least"), "{error}");
}
