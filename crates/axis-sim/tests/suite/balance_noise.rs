//! Torque balance of noisy motions: an inertia is found as it is, and standstill is left out.

use axis_sim::Balance;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::balance::{bench, log_of, motion};

const INERTIA: f64 = 0.3;

/// Least-squares inertia from a motion with white noise (rad), as a share of the true one, and the share of the
/// acceleration's power that is noise; the mean of some runs.
fn fitted(noise: f64, cutoff: &str, motion: &[Vec<f64>; 2]) -> [f64; 2] {
    const RUNS: u64 = 10;
    let axis = bench(INERTIA, cutoff);
    let run = |seed: u64| {
        let [mut position, acceleration] = motion.clone();
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

/// The motion of a bench for the first `moving` of `n` samples, begun and ended within a fifth of these, and standstill.
fn begun_and_ended(n: usize, moving: usize) -> [Vec<f64>; 2] {
    let [mut position, _] = motion(n);
    for (k, x) in position.iter_mut().enumerate() {
        let edge = (5.0 * k.min(moving.saturating_sub(k)) as f64 / moving as f64).min(1.0);
        // Smooth to the second derivative.
        *x *= edge.powi(3) * (10.0 - 15.0 * edge + 6.0 * edge * edge);
    }
    let at = |k: usize| position[k.min(n - 1)];
    let second = |k: usize| (at(k + 1) - 2.0 * at(k) + at(k.max(1) - 1)) * 1e6;
    let acceleration = (0..n).map(second).collect();
    [position, acceleration]
}

/// With a cut-off at which noise would draw an inertia down by some per cent, and with the one that is taken from the
/// log, the inertia comes out as it is.
///
/// Of a log that stands still for three quarters of its time, the parts that move have more of the power than the whole.
#[test]
fn noise_of_the_acceleration_does_not_draw_an_inertia_down() {
    let (moving, mostly_at_rest) = (motion(20_000), begun_and_ended(20_000, 5_000));
    for (noise, cutoff) in [(3e-4, 40.0), (1e-3, 30.0), (1e-3, 25.0)] {
        for motion in [&moving, &mostly_at_rest] {
            let [share, power] = fitted(noise, &format!("[balance]\ncutoff_hz = {cutoff}"), motion);
            println!("noise {noise}, {cutoff} Hz: {share:.5}, {power:.4e} of the power is noise");
            assert!(power > 0.01, "a case that tells nothing: {power}");
            assert!((share - 1.0).abs() < 1e-3, "{share}, {power}");
        }
    }
    for noise in [1e-6, 1e-5, 1e-4, 1e-3] {
        let [share, power] = fitted(noise, "", &moving);
        println!("noise {noise}: {share:.6}, {power:.4e} of the power is noise");
        assert!(power <= 1e-3);
        assert!((share - 1.0).abs() < 1e-3, "{share}");
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
