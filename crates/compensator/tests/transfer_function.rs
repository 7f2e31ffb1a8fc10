//! The linear model: basis, responses, laws of a linear filter.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use approx::assert_relative_eq;
use compensator::{
    Compensator, CompensatorError, MAX_ORDER, Reference, Sample, TransferFunction,
    TransferFunctionModel,
};
use proptest::prelude::*;

const T: f64 = 1e-4;

fn model(direct: f64, poles: &[f64], coefficients: &[f64]) -> TransferFunctionModel {
    TransferFunctionModel::new(T, direct, poles, coefficients).unwrap()
}

fn impulse_response(model: &TransferFunctionModel, cycles: usize) -> Vec<f64> {
    let mut impulse = vec![0.0; cycles];
    impulse[0] = 1.0;
    model.simulate(&impulse)
}

/// A model of order 1 to 6 with settled poles.
fn models() -> impl Strategy<Value = TransferFunctionModel> {
    let terms = prop::collection::vec((-0.5..0.95f64, -1e-5..1e-5f64), 1..7);
    (terms, -1e-5..1e-5f64).prop_map(|(terms, direct)| {
        let (poles, coefficients): (Vec<_>, Vec<_>) = terms.into_iter().unzip();
        model(direct, &poles, &coefficients)
    })
}

fn signal() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-3.0..3.0f64, 100)
}

/// Each term alone, against the definition of orthonormality.
#[test]
fn basis_is_orthonormal() {
    let poles = [0.9, 0.9, 0.5, -0.3, 0.95, 0.9];
    let responses: Vec<Vec<f64>> = (0..poles.len())
        .map(|i| {
            let mut coefficients = [0.0; 6];
            coefficients[i] = 1.0;
            impulse_response(&model(0.0, &poles, &coefficients), 2000)
        })
        .collect();
    for (i, a) in responses.iter().enumerate() {
        for (j, b) in responses.iter().enumerate() {
            let product: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
            let expected = f64::from(u8::from(i == j));
            // 2000 terms of rounding; 0.95^2000 is nothing. 1.1e-15 measured.
            assert!((product - expected).abs() < 1e-14, "{i} {j}: {product}");
        }
    }
}

/// Order 2 against the recursion worked out by hand from H(z).
#[test]
fn second_order_by_hand() {
    let (p, q, c, d) = (0.8, 0.6, [2.0, -3.0], 0.5);
    let h = impulse_response(&model(d, &[p, q], &c), 3);
    let (g, f) = (f64::sqrt(1.0 - p * p), f64::sqrt(1.0 - q * q));
    // B2 = f (z⁻¹ − p) / ((1 − p z⁻¹)(1 − q z⁻¹)).
    let b1 = [g, g * p, g * p * p];
    let b2 = [
        -f * p,
        f * (1.0 - p * (p + q)),
        f * ((p + q) - p * (p * p + p * q + q * q)),
    ];
    for k in 0..3 {
        let direct = if k == 0 { d } else { 0.0 };
        assert_relative_eq!(h[k], direct + c[0] * b1[k] + c[1] * b2[k], epsilon = 1e-14);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn linear(model in models(), a in signal(), b in signal(), x in -2.0..2.0f64, y in -2.0..2.0f64) {
        let mix: Vec<f64> = a.iter().zip(&b).map(|(a, b)| x * a + y * b).collect();
        let (ea, eb) = (model.simulate(&a), model.simulate(&b));
        for (k, e) in model.simulate(&mix).iter().enumerate() {
            // Outputs are of order 1e-4: 8e-20 measured.
            prop_assert!((e - (x * ea[k] + y * eb[k])).abs() < 8e-19);
        }
    }

    #[test]
    fn time_invariant(model in models(), a in signal(), delay in 1..50usize) {
        let mut late = vec![0.0; delay];
        late.extend(&a);
        let (early, late) = (model.simulate(&a), model.simulate(&late));
        prop_assert_eq!(&late[..delay], &vec![0.0; delay][..]);
        prop_assert_eq!(&late[delay..], &early[..]);
    }

    /// H(e^{jωT}) is the Fourier sum of the impulse response.
    #[test]
    fn frequency_response(model in models(), frequency in 0.0..5000.0f64) {
        let (mut re, mut im) = (0.0, 0.0);
        for (k, h) in impulse_response(&model, 2000).iter().enumerate() {
            let angle = std::f64::consts::TAU * frequency * T * k as f64;
            re += h * angle.cos();
            im -= h * angle.sin();
        }
        let (x, y) = model.response(frequency);
        // 2.5e-20 measured, mostly the angles' rounding.
        prop_assert!((x - re).abs() < 2e-19 && (y - im).abs() < 2e-19);
        prop_assert_eq!(model.dc_gain(), model.response(0.0).0);
    }

    /// The strategy says at t_k what the model gives for t_{k+1}, after a
    /// reset too; the lead adds the derivative.
    #[test]
    fn strategy_is_one_cycle_ahead(model in models(), a in signal(), lead in 0.0..0.02f64) {
        let expected = model.simulate(&a);
        let mut plain = TransferFunction::new(model);
        let mut leading = TransferFunction::with_lead(model, lead).unwrap();
        for _ in 0..2 {
            plain.reset();
            leading.reset();
            for (k, pair) in a.windows(2).enumerate() {
                let [reference, next_reference] = [pair[0], pair[1]].map(|acceleration| Reference {
                    acceleration,
                    ..Reference::default()
                });
                let sample = Sample { reference, next_reference, ..Sample::default() };
                prop_assert_eq!(plain.predict_error(&sample), expected[k + 1]);
                let derivative = (expected[k + 1] - expected[k]) / T;
                let correction = leading.correct(&sample).position;
                let wanted = expected[k + 1] + lead * derivative;
                // A few roundings on the way to each: half of this measured.
                let size = (lead / T).max(1.0) * (expected[k].abs() + expected[k + 1].abs());
                prop_assert!((correction - wanted).abs() <= 4.0 * f64::EPSILON * size);
            }
        }
    }
}

#[test]
fn getters_return_what_was_given() {
    let m = model(1e-6, &[0.9, 0.5], &[2e-6, 3e-6]);
    assert_eq!((m.period(), m.direct(), m.order()), (T, 1e-6, 2));
    assert_eq!(
        (m.poles(), m.coefficients()),
        (&[0.9, 0.5][..], &[2e-6, 3e-6][..])
    );
}

#[test]
fn invalid_models_are_refused() {
    let refused =
        |period, direct, poles: &[f64], coefficients: &[f64]| match TransferFunctionModel::new(
            period,
            direct,
            poles,
            coefficients,
        ) {
            Err(CompensatorError::Setting { name, .. }) => name,
            other => panic!("{other:?}"),
        };
    assert_eq!(refused(0.0, 0.0, &[], &[]), "period");
    assert_eq!(refused(T, f64::NAN, &[], &[]), "direct");
    assert_eq!(refused(T, 0.0, &[1.0], &[0.0]), "pole");
    assert_eq!(refused(T, 0.0, &[f64::NAN], &[0.0]), "pole");
    assert_eq!(refused(T, 0.0, &[0.5], &[f64::INFINITY]), "coefficient");
    assert_eq!(refused(T, 0.0, &[0.5], &[]), "coefficients");
    let many = [0.5; MAX_ORDER + 1];
    assert_eq!(refused(T, 0.0, &many, &many), "order");
    let any = model(0.0, &[0.5], &[1.0]);
    assert!(TransferFunction::with_lead(any, -1e-3).is_err());
    assert!(TransferFunction::with_lead(any, f64::NAN).is_err());
}
