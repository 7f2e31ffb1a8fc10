//! Identification of systems that are known.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use compensator::{
    Candidates, MotionRecord, TransferFunctionError, TransferFunctionModel,
    identify_transfer_function,
};
use proptest::prelude::*;

const T: f64 = 1e-4;
const POLE: f64 = 0.99;

/// Smooth accelerations at three incommensurate frequencies (Hz) per set, with
/// a rest at the end: rich enough for order 4 and more.
fn acceleration(frequencies: [f64; 3]) -> Vec<f64> {
    let value = |k: u32| {
        let time = f64::from(k) * T;
        let sines = frequencies.map(|f| (std::f64::consts::TAU * f * time).sin());
        if k < 6000 {
            sines.iter().sum::<f64>() * (1.0 + (40.0 * time).cos())
        } else {
            0.0
        }
    };
    (0..8000).map(value).collect()
}

fn training() -> Vec<f64> {
    acceleration([3.0, 23.1, 71.7])
}

fn validation() -> Vec<f64> {
    acceleration([4.3, 17.9, 53.2])
}

fn candidates() -> Candidates {
    Candidates {
        max_order: 8,
        pole_cycles: [0.97, 0.98, POLE, 0.995].map(|p| vec![p]).to_vec(),
    }
}

fn motion<'a>(acceleration: &'a [f64], error: &'a [f64]) -> MotionRecord<'a> {
    MotionRecord {
        period: T,
        acceleration,
        error,
    }
}

/// Standard normal numbers from a counter: splitmix64 and Box–Muller.
fn noise(seed: u64, count: usize, sigma: f64) -> Vec<f64> {
    let mut state = seed;
    let mut uniform = move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut x = state;
        x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    let normal = |_| {
        let radius = (-2.0 * (1.0 - uniform()).ln()).sqrt();
        sigma * radius * (std::f64::consts::TAU * uniform()).cos()
    };
    (0..count).map(normal).collect()
}

fn with_noise(
    model: &TransferFunctionModel,
    acceleration: &[f64],
    seed: u64,
    sigma: f64,
) -> Vec<f64> {
    let error = model.simulate(acceleration);
    let noise = noise(seed, error.len(), sigma);
    error.iter().zip(noise).map(|(e, n)| e + n).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// Without noise: order, pole, feed-through and coefficients come back.
    #[test]
    fn recovers_a_laguerre_system(
        coefficients in prop::collection::vec(prop_oneof![-2e-5..-2e-6f64, 2e-6..2e-5f64], 1..5),
        with_direct: bool,
    ) {
        let direct = if with_direct { 3e-6 } else { 0.0 };
        let poles = vec![POLE; coefficients.len()];
        let truth = TransferFunctionModel::new(T, direct, &poles, &coefficients).unwrap();
        let (train, valid) = (training(), validation());
        let (train_error, valid_error) = (truth.simulate(&train), truth.simulate(&valid));
        let fit = identify_transfer_function(
            &[motion(&train, &train_error)],
            &[motion(&valid, &valid_error)],
            &candidates(),
        ).unwrap();
        prop_assert_eq!(fit.model.poles(), truth.poles());
        prop_assert_eq!(fit.chosen.direct, with_direct);
        // Rounding of 1e-16 times the condition of the motions, on 2e-5: 6e-19 measured
        // for the feed-through, 1.0e-19 for the others.
        prop_assert!((fit.model.direct() - direct).abs() < 4e-18);
        for (found, true_value) in fit.model.coefficients().iter().zip(&coefficients) {
            prop_assert!((found - true_value).abs() < 8e-19);
        }
    }

    /// With white noise of 0.05 µm: the true order and pole, the coefficients
    /// within five standard errors (one in 10⁶ by chance), and the residual's
    /// RMS as large as the noise.
    #[test]
    fn finds_order_and_coefficients_in_noise(seed: u64) {
        let coefficients = [1.2e-5, -6e-6, 4e-6, -3e-6];
        let sigma = 5e-8;
        let truth = TransferFunctionModel::new(T, 0.0, &[POLE; 4], &coefficients).unwrap();
        let (train, valid) = (training(), validation());
        let train_error = with_noise(&truth, &train, seed, sigma);
        let valid_error = with_noise(&truth, &valid, !seed, sigma);
        let fit = identify_transfer_function(
            &[motion(&train, &train_error)],
            &[motion(&valid, &valid_error)],
            &candidates(),
        ).unwrap();
        prop_assert_eq!(fit.model.poles(), truth.poles());
        prop_assert!(!fit.chosen.direct);
        for (i, found) in fit.model.coefficients().iter().enumerate() {
            let error = fit.standard_errors[i + 1];
            prop_assert!((found - coefficients[i]).abs() < 5.0 * error);
            // 6.6e-11 measured.
            prop_assert!(error < 5e-10, "a standard error that says nothing: {error}");
        }
        // The RMS of 8000 normal numbers scatters by 0.8 %.
        prop_assert!((fit.chosen.training_rms / sigma - 1.0).abs() < 0.04);
        prop_assert!((fit.chosen.validation_rms / sigma - 1.0).abs() < 0.04);
    }
}

/// The figures of the table are those of the model, run over the motions.
#[test]
fn reported_rms_is_the_models() {
    let truth = TransferFunctionModel::new(T, 1e-6, &[0.9, 0.999], &[1e-5, 2e-5]).unwrap();
    let (train, valid) = (training(), validation());
    let train_error = with_noise(&truth, &train, 1, 1e-7);
    let valid_error = with_noise(&truth, &valid, 2, 1e-7);
    let fit = identify_transfer_function(
        &[motion(&train, &train_error), motion(&valid, &valid_error)],
        &[motion(&valid, &valid_error)],
        &candidates(),
    )
    .unwrap();
    let predicted = fit.model.simulate(&valid);
    let squares = predicted
        .iter()
        .zip(&valid_error)
        .map(|(p, e)| (p - e).powi(2));
    let rms = (squares.sum::<f64>() / valid.len() as f64).sqrt();
    // 3.6e-15 measured.
    assert!((rms / fit.chosen.validation_rms - 1.0).abs() < 3e-14);
    assert_eq!(fit.trials.len(), 4 * 8 * 2);
    let best = fit
        .trials
        .iter()
        .map(|t| t.validation_rms)
        .fold(f64::INFINITY, f64::min);
    assert!(fit.chosen.validation_rms <= 1.01 * best);
}

#[test]
fn two_alternating_poles() {
    let truth =
        TransferFunctionModel::new(T, 0.0, &[0.98, 0.999, 0.98], &[1e-5, 2e-5, -5e-6]).unwrap();
    let (train, valid) = (training(), validation());
    let (train_error, valid_error) = (truth.simulate(&train), truth.simulate(&valid));
    let fit = identify_transfer_function(
        &[motion(&train, &train_error)],
        &[motion(&valid, &valid_error)],
        &Candidates {
            max_order: 4,
            pole_cycles: vec![vec![0.98], vec![0.98, 0.999]],
        },
    )
    .unwrap();
    assert_eq!(fit.model.poles(), truth.poles());
    assert_eq!(fit.chosen.poles, [0.98, 0.999]);
}

#[test]
fn unusable_motions_are_refused() {
    let (a, e) = ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]);
    let good = motion(&a, &e);
    let identify = |t: &[MotionRecord], v: &[MotionRecord]| {
        identify_transfer_function(t, v, &candidates()).unwrap_err()
    };
    assert_eq!(
        identify(&[], &[good]),
        TransferFunctionError::Empty("training motion")
    );
    assert_eq!(
        identify(&[good], &[]),
        TransferFunctionError::Empty("validation motion")
    );
    let length = identify(&[motion(&a, &e[..2])], &[good]);
    assert!(matches!(
        length,
        TransferFunctionError::Length {
            set: "training",
            index: 0,
            accelerations: 3,
            errors: 2
        }
    ));
    let period = identify(
        &[good],
        &[
            good,
            MotionRecord {
                period: 1e-3,
                ..good
            },
        ],
    );
    assert!(matches!(
        period,
        TransferFunctionError::Period {
            set: "validation",
            index: 1,
            ..
        }
    ));
    let nan = identify(&[motion(&a, &[0.0, f64::NAN, 0.0])], &[good]);
    assert!(matches!(
        nan,
        TransferFunctionError::Value {
            sample: 1,
            what: "error",
            ..
        }
    ));
    let still = [0.0; 100];
    assert_eq!(
        identify(&[motion(&still, &still)], &[good]),
        TransferFunctionError::Undetermined
    );
}

#[test]
fn unusable_candidates_are_refused() {
    let (a, e) = ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]);
    let refused = |max_order, pole_cycles| {
        let candidates = Candidates {
            max_order,
            pole_cycles,
        };
        identify_transfer_function(&[motion(&a, &e)], &[motion(&a, &e)], &candidates).unwrap_err()
    };
    assert_eq!(refused(2, vec![]), TransferFunctionError::Empty("pole"));
    assert_eq!(
        refused(2, vec![vec![]]),
        TransferFunctionError::Empty("pole")
    );
    assert!(matches!(
        refused(0, vec![vec![0.5]]),
        TransferFunctionError::Setting(_)
    ));
    assert!(matches!(
        refused(17, vec![vec![0.5]]),
        TransferFunctionError::Setting(_)
    ));
    assert!(matches!(
        refused(2, vec![vec![1.0]]),
        TransferFunctionError::Setting(_)
    ));
}
