//! Transforms against the sum that defines them, and back again.

use std::f64::consts::TAU;

use axis_fourier::{Complex, forward, inverse};
use proptest::collection::vec;
use proptest::prelude::*;

fn transformed(samples: &[f64]) -> Vec<Complex<f64>> {
    let plan = forward(samples.len());
    let mut out = plan.make_output_vec();
    plan.process(&mut samples.to_vec(), &mut out).unwrap();
    out
}

proptest! {
    /// Lengths with every kind of factor, primes among them.
    #[test]
    fn forward_is_the_sum_of_its_definition(samples in vec(-1.0..1.0_f64, 1..140)) {
        let n = samples.len();
        for (k, found) in transformed(&samples).iter().enumerate() {
            let turn = |j: usize| TAU * (j * k % n) as f64 / n as f64;
            let terms = samples.iter().enumerate();
            let sum: Complex<f64> = terms.map(|(j, x)| Complex::from_polar(*x, -turn(j))).sum();
            prop_assert!((found - sum).norm() < 1e-11, "{k} of {n}: {found} instead of {sum}");
        }
    }

    #[test]
    fn back_again_gives_the_samples(samples in vec(-1.0..1.0_f64, 1..3000)) {
        let n = samples.len();
        let mut back = vec![0.0; n];
        inverse(n).process(&mut transformed(&samples), &mut back).unwrap();
        for (found, x) in back.iter().zip(&samples) {
            prop_assert!((found / n as f64 - x).abs() < 1e-13);
        }
    }
}

#[test]
fn no_samples_have_one_amplitude_of_nothing() {
    assert_eq!(transformed(&[]).len(), 1);
}
