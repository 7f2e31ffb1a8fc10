//! The observer against closed forms: steady states, lags, noise.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use approx::assert_relative_eq;
use compensator::{CompensatorError, MotionEstimate, MotionEstimator, ObserverGains, Sample};
use proptest::prelude::*;

const R: f64 = 0.01 / std::f64::consts::TAU;
const T: f64 = 1e-4;

/// Feeds `cycles` samples of position and motor-side speed as functions of time.
fn observe(
    gains: ObserverGains,
    cycles: u32,
    position: impl Fn(f64) -> f64,
    motor_side_speed: impl Fn(f64) -> f64,
) -> MotionEstimate {
    let mut estimator = MotionEstimator::new(R, T, gains).unwrap();
    let mut estimate = MotionEstimate::default();
    for k in 0..=cycles {
        let time = f64::from(k) * T;
        estimate = estimator.update(&Sample {
            position: position(time),
            motor_angle: 0.0,
            motor_speed: motor_side_speed(time) / R,
            ..Sample::default()
        });
    }
    estimate
}

/// Gains well inside the stability limit, so that 4000 cycles settle them.
fn gains() -> impl Strategy<Value = ObserverGains> {
    (0.1..1.0f64, 0.1..0.9f64, 0.05..1.0f64).prop_map(|(position, share, acceleration)| {
        ObserverGains {
            position,
            drift: share * position,
            acceleration,
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Constant speed, also when the screw's pitch differs from the nominal
    /// lead: the wind-up rate takes up the difference.
    #[test]
    fn ramp_is_exact(gains in gains(), v in -0.5..0.5f64, pitch in -1e-3..1e-3f64) {
        let e = observe(gains, 4000, |t| 0.6 + v * t, |_| v * (1.0 + pitch));
        // Positions of about 1 m round to 1e-16 m: over T that is 1e-12 m/s,
        // over T again 1e-8 m/s². Measured: 2.2e-16, 6.2e-13, 6.0e-9.
        prop_assert!((e.position - (0.6 + 0.4 * v)).abs() < 2e-15);
        prop_assert!((e.velocity - v).abs() < 5e-12);
        prop_assert!(e.acceleration.abs() < 5e-8);
    }

    /// Constant acceleration of motor and table together.
    #[test]
    fn parabola_is_exact(gains in gains(), a in -3.0..3.0f64) {
        let e = observe(gains, 4000, |t| 0.6 + 0.5 * a * t * t, |t| a * t);
        // Measured: 4.4e-16, 7.6e-13, 5.2e-9.
        prop_assert!((e.position - (0.6 + 0.5 * a * 0.16)).abs() < 4e-15);
        prop_assert!((e.velocity - 0.4 * a).abs() < 5e-12);
        prop_assert!((e.acceleration - a).abs() < 5e-8);
    }

    /// Wind-up that accelerates at c: the lags in the documentation.
    #[test]
    fn wind_up_lags_as_stated(gains in gains(), c in 0.1..1.0f64) {
        let (alpha, beta) = (gains.position, gains.drift);
        let e = observe(gains, 4000, |t| 0.5 * c * t * t, |_| 0.0);
        let position_lag = c * T * T * (1.0 - alpha) / beta;
        let speed_lag = c * T * (alpha / beta - 0.5);
        // Measured: 1.6e-17, 1.6e-13.
        prop_assert!((0.5 * c * 0.16 - e.position - position_lag).abs() < 1.5e-16);
        prop_assert!((0.4 * c - e.velocity - speed_lag).abs() < 1.5e-12);
    }

    /// Constant jerk: the acceleration lags by T (1/γ − 1/2).
    #[test]
    fn acceleration_lags_as_stated(gains in gains(), j in 1.0..100.0f64) {
        let gains = ObserverGains { drift: 0.0, ..gains };
        let e = observe(gains, 4000, |_| 0.0, |t| 0.5 * j * t * t);
        let lag = j * T * (1.0 / gains.acceleration - 0.5);
        // Measured: 1.7e-11.
        prop_assert!((0.4 * j - e.acceleration - lag).abs() < 1.5e-10);
    }

    /// A filter's gain for white noise is the energy of its impulse response.
    #[test]
    fn noise_gains_are_the_impulse_responses_energy(gains in gains()) {
        let mut estimator = MotionEstimator::new(R, T, gains).unwrap();
        estimator.update(&Sample::default());
        let (mut position, mut speed, mut prediction, mut input) = (0.0, 0.0, 0.0, 0.0);
        for k in 0..4000 {
            let impulse = f64::from(u8::from(k == 0));
            let e = estimator.update(&Sample { position: impulse, ..Sample::default() });
            let next = e.position + T * e.velocity;
            position += e.position.powi(2);
            speed += (T * e.velocity).powi(2);
            prediction += next.powi(2);
            input += (impulse + next).powi(2);
        }
        let stated = gains.noise_gains();
        // 6.7e-16 measured.
        assert_relative_eq!(stated.position, position.sqrt(), max_relative = 5e-15);
        assert_relative_eq!(stated.speed_times_period, speed.sqrt(), max_relative = 5e-15);
        assert_relative_eq!(stated.predicted_error, prediction.sqrt(), max_relative = 5e-15);
        assert_relative_eq!(stated.loop_input, input.sqrt(), max_relative = 5e-15);
    }

    /// The default loses nothing of the scale: not a bit.
    #[test]
    fn default_takes_the_scale_as_it_is(positions in prop::collection::vec(-1.0..1.0f64, 1..50)) {
        let mut estimator = MotionEstimator::new(R, T, ObserverGains::default()).unwrap();
        for position in positions {
            let e = estimator.update(&Sample { position, motor_speed: 7.0, ..Sample::default() });
            prop_assert_eq!(e.position, position);
        }
    }
}

#[test]
fn reset_starts_anew() {
    let mut estimator = MotionEstimator::new(R, T, ObserverGains::default()).unwrap();
    let sample = Sample {
        position: 0.3,
        motor_angle: 0.0,
        motor_speed: 20.0,
        ..Sample::default()
    };
    let first = estimator.update(&sample);
    estimator.update(&Sample::default());
    estimator.reset();
    assert_eq!(estimator.update(&sample), first);
    assert_eq!(first.velocity, R * 20.0);
}

#[test]
fn smoothing_reduces_noise() {
    let smooth = ObserverGains::critically_damped(10.0)
        .unwrap()
        .noise_gains();
    let plain = ObserverGains::default().noise_gains();
    assert!(smooth.predicted_error < 0.5 * plain.predicted_error);
    assert!(smooth.loop_input < plain.loop_input);
}

#[test]
fn invalid_gains_are_refused() {
    let refused = |position, drift, acceleration| {
        let gains = ObserverGains {
            position,
            drift,
            acceleration,
        };
        match MotionEstimator::new(R, T, gains) {
            Err(CompensatorError::Setting { name, .. }) => name,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(refused(0.0, 0.0, 1.0), "position");
    assert_eq!(refused(f64::NAN, 0.0, 1.0), "position");
    assert_eq!(refused(0.5, 3.0, 1.0), "drift");
    assert_eq!(refused(0.5, -0.1, 1.0), "drift");
    assert_eq!(refused(0.5, 0.1, 1.1), "acceleration");
    assert!(MotionEstimator::new(0.0, T, ObserverGains::default()).is_err());
    assert!(MotionEstimator::new(R, f64::INFINITY, ObserverGains::default()).is_err());
    assert!(ObserverGains::critically_damped(0.0).is_err());
}
