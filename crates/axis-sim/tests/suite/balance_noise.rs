//! Torque balance of noisy motions: what noise of the acceleration does to an inertia.

use axis_sim::Balance;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::balance::{bench, log_of, motion};

const INERTIA: f64 = 0.3;

/// Least-squares inertia from a motion with white noise (rad), as a share of the true one,
/// and the share that is predicted to be lost; the mean of some runs.
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

/// With a cut-off where noise counts, an inertia comes out too small by what is predicted;
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
