//! The network strategy: Eq. (36), shapes, the kinds of models.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use cfnn::{FixedNetwork, Network, Scaling, ScalingRange, Shape};
use compensator::{
    Compensator, CompensatorError, IncrementModel, MotionEstimator, NetworkCompensation,
    ObserverGains, Reference, Sample,
};
use proptest::prelude::*;

const R: f64 = 0.01 / std::f64::consts::TAU;
const T: f64 = 1e-4;
const RANGES: [(f64, f64); 4] = [(0.1, 1.3), (-0.2, 0.2), (-3.0, 3.0), (-15.0, 15.0)];
/// One hidden neuron, [bias, four inputs], then [bias, four inputs, hidden].
const WEIGHTS: [f64; 11] = [0.1, 0.0, 0.2, -0.1, 0.05, 1e-3, 2e-4, 1.0, 2e-3, 3e-5, 1e-3];

fn estimator() -> MotionEstimator {
    MotionEstimator::new(R, T, ObserverGains::default()).unwrap()
}

fn network() -> Network {
    let shape = Shape {
        inputs: 4,
        hidden: vec![1],
        outputs: 1,
    };
    let scaling = Scaling::from_ranges(&RANGES, &[(-2e-5, 2e-5)]).unwrap();
    Network::new(shape, scaling, WEIGHTS.to_vec()).unwrap()
}

#[test]
fn the_models_agree() {
    let input = RANGES.map(|(low, high)| ScalingRange::new("input", low, high).unwrap());
    let output = [ScalingRange::new("output", -2e-5, 2e-5).unwrap()];
    let mut fixed = FixedNetwork::<f64, 4, 1, 6>::new(&[1], &WEIGHTS, input, output).unwrap();

    let input = RANGES.map(|(l, h)| ScalingRange::new("input", l as f32, h as f32).unwrap());
    let output = [ScalingRange::new("output", -2e-5f32, 2e-5).unwrap()];
    let weights = WEIGHTS.map(|w| w as f32);
    let mut single = FixedNetwork::<f32, 4, 1, 6>::new(&[1], &weights, input, output).unwrap();

    let mut predictor = cfnn::Predictor::<4, 1>::new(network()).unwrap();
    for (s, v, a, i) in [(0.6, 0.1, 1.0, 3.0), (0.9, -0.05, -2.0, 0.2)] {
        let increment = predictor.increment(s, v, a, i);
        assert_eq!(increment, fixed.increment(s, v, a, i));
        // About ten roundings of 6e-8 relative to the output's half range.
        assert!((increment - single.increment(s, v, a, i)).abs() < 10.0 * 6e-8 * 2e-5);
        // The direct link from the speed carries it: 2e-5/0.2 = T.
        assert!((increment - v * T).abs() < 1e-7);
    }
}

#[test]
fn another_shape_is_refused() {
    let shape = Shape {
        inputs: 3,
        hidden: vec![1],
        outputs: 2,
    };
    let scaling = Scaling::from_ranges(&RANGES[..3], &RANGES[..2]).unwrap();
    let weights = vec![0.1; 4 + 2 * 5];
    let other = Network::new(shape, scaling, weights).unwrap();
    let refusal = NetworkCompensation::from_network(other, estimator()).unwrap_err();
    let expected = CompensatorError::NetworkShape {
        inputs: 3,
        outputs: 2,
    };
    assert_eq!(refusal, expected);
    assert!(NetworkCompensation::from_network(network(), estimator()).is_ok());
}

proptest! {
    /// With the exact kinematics of a cycle as the model, the prediction is
    /// the error that then occurs.
    #[test]
    fn kinematic_model_predicts_the_next_error(
        a in -3.0..3.0f64,
        reference_a in -3.0..3.0f64,
        iq in -15.0..15.0f64,
    ) {
        let at = |k: u32, a: f64| {
            let time = f64::from(k) * T;
            Reference { position: 0.6 + 0.5 * a * time * time, velocity: a * time, acceleration: a }
        };
        let mut commands = Vec::new();
        let model = |_: f64, v: f64, a: f64, command: f64| {
            commands.push(command);
            v * T + 0.5 * a * T * T
        };
        let mut law = NetworkCompensation::new(model, estimator());
        for k in 0..600 {
            let table = at(k, a);
            let correction = law.correct(&Sample {
                reference: at(k, reference_a),
                next_reference: at(k + 1, reference_a),
                position: table.position,
                motor_angle: 0.0,
                motor_speed: table.velocity / R,
                iq: -1.0,
                last_command: iq,
            });
            let truth = at(k + 1, reference_a).position - at(k + 1, a).position;
            // The acceleration starts at 0 and closes in by γ = 5 % a cycle;
            // what is missing of it costs T²/2 times that.
            let tolerance = 0.5 * 3.0 * T * T * 0.95f64.powi(k as i32);
            prop_assert!((correction.position - truth).abs() <= tolerance * (1.0 + 1e-9) + 1e-14);
            prop_assert_eq!(correction.command, 0.0);
        }
        prop_assert!(commands.iter().all(|&command| command == iq));
    }
}

#[test]
fn reset_forgets() {
    let model = |_: f64, v: f64, _: f64, _: f64| v * T;
    let mut law = NetworkCompensation::new(model, estimator());
    let sample = Sample {
        position: 0.3,
        motor_angle: 0.0,
        motor_speed: 10.0,
        ..Sample::default()
    };
    let first = law.correct(&sample);
    law.correct(&Sample::default());
    law.reset();
    assert_eq!(law.correct(&sample), first);
    assert_eq!(first.position, law_of_first(&sample));
}

/// Eq. (36) by hand for a first sample, whose speed is r ω.
fn law_of_first(sample: &Sample) -> f64 {
    sample.next_reference.position - (sample.position + R * sample.motor_speed * T)
}
