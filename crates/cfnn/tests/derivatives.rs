//! Jacobian and sensitivities: a closed form, and central differences of the evaluation.

use cfnn::train::starting_weights;
use cfnn::{Architecture, Error, FixedNetwork, Network, Scaling, ScalingRange, Shape};
use proptest::prelude::*;

use crate::support::{architectures, reference, uniform};

/// `y = 11 + (a + b s + c tanh(p + q s))`, `s = (x - 2)/4`: all derivatives written down.
#[test]
fn one_neuron_has_its_closed_form() {
    let (p, q, a, b, c) = (-0.3, 1.7, 0.4, -0.8, 0.9);
    let shape = Shape {
        inputs: 1,
        hidden: vec![1],
        outputs: 1,
    };
    let scaling = Scaling::from_ranges(&[(-2.0, 6.0)], &[(6.0, 16.0)]).unwrap();
    let network = Network::new(shape, scaling, vec![p, q, a, b, c]).unwrap();
    let range = |low, high| ScalingRange::new("range", low, high).unwrap();
    let fixed = FixedNetwork::<f64, 1, 1, 3>::new(
        &[1],
        network.packed_weights(),
        [range(-2.0, 6.0)],
        [range(6.0, 16.0)],
    )
    .unwrap();
    for k in 0..20 {
        let x = 2.0 + 4.0 * uniform(k);
        let s = (x - 2.0) / 4.0;
        let t = libm::tanh(p + q * s);
        let d = 1.0 - t * t;
        let expected = [c * d, c * d * s, 1.0, s, t].map(|v| 5.0 * v);
        // 1.8e-15 measured.
        for (found, e) in network.jacobian(&[x]).unwrap().iter().zip(expected) {
            assert!((found - e).abs() < 5e-15, "{found} against {e}");
        }
        let slope = 5.0 * (b + c * d * q) / 4.0;
        let found = network.sensitivities(&[x]).unwrap();
        assert!(
            (found[0] - slope).abs() < 2e-15,
            "{} against {slope}",
            found[0]
        );
        assert_eq!(fixed.sensitivities(&[x]).1, [[found[0]]]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Central differences of fourth order with step 1e-4 err by h⁴ f⁽⁵⁾/30 and by rounding, some 1e-15/h;
    /// relative to the largest derivative of the table 1.9e-11 measured.
    #[test]
    fn any_architecture_agrees_with_differences(
        architecture in architectures(), seed in 0..1000u64,
    ) {
        let shape = architecture.shape().clone();
        let scaling = Scaling::from_ranges(
            &vec![(-2.0, 6.0); shape.inputs],
            &vec![(-2.0, 2.0); shape.outputs],
        ).unwrap();
        let weights = starting_weights(&architecture, seed).unwrap();
        let at = |k: usize| 2.0 + 4.0 * uniform(k + seed as usize);
        let rows: Vec<f64> = (0..3 * shape.inputs).map(at).collect();
        for row in rows.chunks(shape.inputs) {
            let scaled: Vec<f64> = row.iter().map(|x| (x - 2.0) / 4.0).collect();
            prop_assume!(reference(&architecture, &weights, &scaled).1 > 1e-2);
        }
        // None for weights that the architecture lacks, which cannot change.
        let evaluated = |weights: Vec<f64>, rows: &[f64]| {
            let network = Network::new(architecture.clone(), scaling.clone(), weights).ok()?;
            let mut out = vec![0.0; 3 * shape.outputs];
            network.evaluate_rows(rows, &mut network.scratch(), &mut out).unwrap();
            Some(out)
        };
        let by_weight = |column: usize, by: f64| {
            let mut weights = weights.clone();
            weights[column] += by;
            evaluated(weights, &rows)
        };
        let by_input = |column: usize, by: f64| {
            let mut rows = rows.clone();
            rows.iter_mut().skip(column).step_by(shape.inputs).for_each(|x| *x += by);
            evaluated(weights.clone(), &rows)
        };
        let network = Network::new(architecture.clone(), scaling.clone(), weights.clone()).unwrap();
        let jacobian = network.jacobian(&rows).unwrap();
        prop_assert!(deviation(&jacobian, weights.len(), by_weight) < LIMIT);
        let slopes = network.sensitivities(&rows).unwrap();
        prop_assert!(deviation(&slopes, shape.inputs, by_input) < LIMIT);
    }
}

const LIMIT: f64 = 6e-11;

/// Largest difference of a table from differences of what `moved` gives for a column and a distance,
/// relative to the largest entry or 1.
fn deviation(table: &[f64], columns: usize, moved: impl Fn(usize, f64) -> Option<Vec<f64>>) -> f64 {
    let h = 1e-4;
    let largest = table.iter().fold(1.0, |m: f64, v| m.max(v.abs()));
    let mut worst = 0.0f64;
    for column in 0..columns {
        let points = [2.0, 1.0, -1.0, -2.0].map(|n| moved(column, n * h));
        for (r, row) in table.chunks(columns).enumerate() {
            let slope = match &points {
                [Some(a), Some(b), Some(c), Some(d)] => {
                    (8.0 * (b[r] - c[r]) - (a[r] - d[r])) / (12.0 * h)
                }
                _ => 0.0,
            };
            worst = worst.max((row[column] - slope).abs() / largest);
        }
    }
    worst
}

#[test]
fn tables_that_do_not_fit_are_refused() {
    let shape = Shape {
        inputs: 2,
        hidden: vec![],
        outputs: 1 << 16,
    };
    let scaling = Scaling::from_ranges(&[(0.0, 1.0); 2], &vec![(0.0, 1.0); 1 << 16]).unwrap();
    let network = Network::new(Architecture::from(shape), scaling, vec![0.0; 3 << 16]).unwrap();
    let refused = network.jacobian(&[0.0; 2]).unwrap_err();
    assert!(
        matches!(refused, Error::DerivativeMemory { .. }),
        "{refused}"
    );
    for wrong in [&[][..], &[0.0], &[0.0; 3]] {
        assert!(network.sensitivities(wrong).is_err());
        let mut out = vec![0.0; 1 << 16];
        assert!(
            network
                .evaluate_rows(wrong, &mut network.scratch(), &mut out)
                .is_err()
        );
    }
    let rows = network.evaluate_rows(&[0.0; 4], &mut network.scratch(), &mut [0.0; 9]);
    assert!(matches!(rows, Err(Error::Length { .. })));
    assert_eq!(
        network.sensitivities(&[f64::NAN, 0.0]).unwrap().len(),
        2 << 16
    );
}
