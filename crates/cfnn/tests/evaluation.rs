//! Evaluation against a plain one written out here.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use cfnn::train::nguyen_widrow;
use cfnn::{Error, FixedNetwork, Network, Predictor, Scaling, ScalingRange, Shape};
use proptest::prelude::*;

/// The definition, sum by sum.
fn reference(shape: &Shape, weights: &[f64], scaled: &[f64]) -> Vec<f64> {
    let mut seen = vec![1.0];
    seen.extend_from_slice(scaled);
    let layers = shape.layers();
    for (index, layer) in layers.iter().enumerate() {
        let net: Vec<f64> = (0..layer.neurons)
            .map(|j| {
                let weight = |i: usize| weights[layer.first_parameter + i * layer.neurons + j];
                seen.iter().enumerate().map(|(i, a)| weight(i) * a).sum()
            })
            .collect();
        if index + 1 == layers.len() {
            return net;
        }
        seen.extend(net.iter().map(|&n| libm::tanh(n)));
    }
    unreachable!()
}

proptest! {
    /// Layers up to 40 neurons pass through every width of the kernel. Some 40
    /// roundings per sum, amplified by three layers of weights of length about
    /// 1.5: 1.1e-14 measured.
    #[test]
    fn agrees_with_the_definition(
        hidden in prop::collection::vec(1..41usize, 0..4),
        inputs in 1..6usize,
        outputs in 1..20usize,
        seed in 0..10_000u64,
    ) {
        let shape = Shape { inputs, hidden, outputs };
        let weights = nguyen_widrow(&shape, seed).unwrap();
        let scaling = Scaling::from_ranges(
            &vec![(-2.0, 6.0); inputs],
            &vec![(10.0, 12.0); outputs],
        ).unwrap();
        let input: Vec<f64> = (0..inputs).map(|i| (i as f64 * 0.7 + seed as f64).sin() * 4.0 + 2.0).collect();
        let scaled: Vec<f64> = input.iter().map(|x| (x - 2.0) / 4.0).collect();
        let expected = reference(&shape, &weights, &scaled);
        let network = Network::new(shape, scaling, weights).unwrap();
        let mut out = vec![0.0; outputs];
        let mut scratch = network.scratch();
        network.evaluate(&input, &mut scratch, &mut out).unwrap();
        for (y, e) in out.iter().zip(&expected) {
            prop_assert!((y - 11.0 - e).abs() < 1e-13, "{} against {e}", y - 11.0);
        }
    }
}

#[test]
fn borrowed_network_gives_the_same_bits_and_single_precision_is_near() {
    let shape = Shape {
        inputs: 4,
        hidden: vec![34, 19, 8],
        outputs: 1,
    };
    let weights = nguyen_widrow(&shape, 5).unwrap();
    let ranges = [(0.0, 1.5), (-0.33, 0.33), (-1.0, 1.0), (-15.0, 15.0)];
    let scaling = Scaling::from_ranges(&ranges, &[(0.0, 1.5)]).unwrap();
    let network = Network::new(shape, scaling, weights).unwrap();
    let mut predictor = Predictor::<4, 1>::new(network.clone()).unwrap();
    let range = |(low, high)| ScalingRange::new("input", low, high).unwrap();
    let hidden = [34, 19, 8];
    let fixed = FixedNetwork::<f64, 4, 1, 66>::new(
        &hidden,
        network.packed_weights(),
        ranges.map(range),
        [range((0.0, 1.5))],
    )
    .unwrap();
    let single: Vec<f32> = network.packed_weights().iter().map(|&w| w as f32).collect();
    let range = |(low, high)| ScalingRange::new("input", low as f32, high as f32).unwrap();
    let fixed32 = FixedNetwork::<f32, 4, 1, 66>::new(
        &hidden,
        &single,
        ranges.map(range),
        [range((0.0, 1.5))],
    )
    .unwrap();
    let mut scratch = network.scratch();
    for s in 0..200 {
        let t = f64::from(s);
        let x = [
            0.7 + 0.5 * t.sin(),
            0.3 * t.cos(),
            (0.3 * t).sin(),
            t / 14.0,
        ];
        let y = network.predict_one(&x, &mut scratch).unwrap();
        assert_eq!(predictor.predict(&x)[0].to_bits(), y.to_bits());
        assert_eq!(fixed.evaluate(&x)[0].to_bits(), y.to_bits());
        // Sums of up to 66 terms of order 1 in 24-bit arithmetic: 1.4e-6 measured.
        let z = fixed32.evaluate(&x.map(|v| v as f32))[0];
        assert!((f64::from(z) - y).abs() < 1e-5, "{z} against {y}");
    }
}

#[test]
fn misfits_are_refused() {
    let shape = Shape {
        inputs: 2,
        hidden: vec![3],
        outputs: 1,
    };
    let scaling = Scaling::from_ranges(&[(0.0, 1.0); 2], &[(0.0, 1.0)]).unwrap();
    let make = |shape: &Shape, n| Network::new(shape.clone(), scaling.clone(), vec![0.1; n]);
    assert!(make(&shape, 15).is_ok());
    assert_eq!(
        make(&shape, 14),
        Err(Error::Length {
            what: "weights",
            found: 14,
            expected: 15
        })
    );
    let empty = Shape {
        hidden: vec![3, 0],
        ..shape.clone()
    };
    assert!(matches!(
        make(&empty, 15),
        Err(Error::EmptyLayer {
            what: "hidden",
            index: 1
        })
    ));
    let huge = Shape {
        hidden: vec![usize::MAX, 2],
        ..shape.clone()
    };
    assert!(matches!(make(&huge, 15), Err(Error::TooLarge { .. })));
    let mut weights = vec![0.0; 15];
    weights[7] = f64::NAN;
    let refused = Network::new(shape.clone(), scaling.clone(), weights);
    assert!(matches!(refused, Err(Error::NotFinite { index: 7, .. })));
    let network = make(&shape, 15).unwrap();
    let mut scratch = network.scratch();
    assert!(network.predict_one(&[0.0; 3], &mut scratch).is_err());
    assert!(Predictor::<3, 1>::new(network).is_err());
    for (low, high) in [
        (1.0, 1.0),
        (2.0, 1.0),
        (f64::NAN, 1.0),
        (0.0, f64::INFINITY),
    ] {
        assert!(Scaling::from_ranges(&[(low, high)], &[]).is_err());
    }
    assert!(Scaling::fit(1, &[1.0, 1.0], 1, &[0.0, 1.0]).is_err());
}

#[test]
fn scaling_meets_its_ends() {
    let scaling = Scaling::fit(2, &[0.0, -5.0, 1.5, 7.0, 0.3, 1.0], 1, &[2.0, 3.0, 4.0]).unwrap();
    assert_eq!(scaling.input()[1].to_unit(-5.0), -1.0);
    assert_eq!(scaling.input()[1].to_unit(7.0), 1.0);
    assert_eq!(scaling.output()[0].from_unit(1.0), 4.0);
    assert_eq!(scaling.output()[0].from_unit(-1.0), 2.0);
}
