//! Identification from data of any kind ends, with a fit or an error.
#![cfg(feature = "identify")]

use lugre::identify::{
    ConstantSpeedRun, FrictionIdentifyError, MeasuredMotion, PreslidingRecord, StaticParameters,
    identify_presliding, identify_static, identify_static_within,
};
use proptest::prelude::*;

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => prop::num::f64::ANY,
        6 => -1e2..1e2,
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, 0.0, -0.0, 1e308, 1e100, -1e100, 5e-324, 1e-200, 1.0,
        ]),
    ]
}

/// Empty, one sample, constant, unsorted, tiny, huge, and with numbers that
/// are none.
fn channel() -> impl Strategy<Value = Vec<f64>> {
    prop_oneof![
        1 => prop::collection::vec(any_number(), 0..3),
        1 => prop::collection::vec(any_number(), 60..200),
        2 => prop::collection::vec(-1e2..1e2, 60..200),
        1 => prop::collection::vec(prop::sample::select(vec![1e100, -1e100, 1e-300, 0.0]), 60..200),
        1 => (any_number(), 0usize..200).prop_map(|(x, n)| vec![x; n]),
    ]
}

/// Two channels, most often of one length.
fn channels() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
    (channel(), channel(), 0..5).prop_map(|(mut a, mut b, keep)| {
        if keep > 0 {
            let n = a.len().min(b.len());
            a.truncate(n);
            b.truncate(n);
        }
        (a, b)
    })
}

fn run() -> impl Strategy<Value = ConstantSpeedRun> {
    let wild = (
        any_number(),
        prop::option::of(any_number()),
        any_number(),
        prop::option::of(any_number()),
        any_number(),
    );
    let tame = (
        prop_oneof![-1e2..1e2, prop::sample::select(vec![1e-300, 1e100, -1e100])],
        prop::option::of(1e-6..1.0),
        prop_oneof![-2.0..2.0, prop::sample::select(vec![0.0, 1e100, 1e-300])],
        prop::option::of(1e-6..1.0),
        0.0..0.1,
    );
    prop_oneof![1 => wild.boxed(), 60 => tame.boxed()].prop_map(
        |(speed, speed_standard_error, torque, torque_standard_error, vibration)| {
            ConstantSpeedRun {
                speed,
                speed_standard_error,
                torque,
                torque_standard_error,
                vibration,
                vibration_frequency: f64::NAN,
            }
        },
    )
}

proptest! {
    #[test]
    fn records((speeds, torques) in channels(), rate in any_number()) {
        if let Ok(run) = ConstantSpeedRun::from_record(&speeds, &torques, rate) {
            prop_assert!(run.speed.is_finite() && run.torque.is_finite());
            for error in [run.speed_standard_error, run.torque_standard_error].into_iter().flatten() {
                prop_assert!(error > 0.0 && error.is_finite());
            }
            prop_assert!(run.vibration >= 0.0 && run.vibration_frequency >= 0.0);
            let _ = run.is_at_rest();
        }
    }

    #[test]
    fn static_fits(runs in prop::collection::vec(run(), 0..40), limit in any_number()) {
        let _ = identify_static_within(&runs, limit);
        if let Ok(fit) = identify_static(&runs) {
            prop_assert!(fit.stiction.value >= fit.coulomb.value && fit.viscous.value >= 0.0);
            prop_assert!(fit.stribeck_speed.value > 0.0);
        }
    }

    #[test]
    fn presliding_fits(
        (motion, torque) in channels(), by_speed in any::<bool>(), ordinary in any::<bool>(),
        time_step in any_number(), statics in prop::array::uniform4(any_number()),
    ) {
        let time_step = if ordinary { 1e-3 } else { time_step };
        let [coulomb, stiction, stribeck_speed, viscous] =
            if ordinary { [0.7, 0.8, 3.0, 0.01] } else { statics };
        let statics = StaticParameters { coulomb, stiction, stribeck_speed, viscous };
        let motion = if by_speed { MeasuredMotion::Speed(&motion) } else { MeasuredMotion::Displacement(&motion) };
        let record = PreslidingRecord { time_step, motion, torque: &torque };
        if let Ok(fit) = identify_presliding(statics, &record) {
            prop_assert!(fit.law().is_ok());
        }
    }
}

#[test]
fn a_limit_that_is_no_number_is_refused() {
    for bad in [f64::NAN, -0.1] {
        let error = identify_static_within(&[], bad).expect_err("no limit");
        let FrictionIdentifyError::BadNumber { quantity, .. } = error else {
            panic!("{error}");
        };
        assert_eq!(quantity, "vibration_limit");
    }
}

/// A long record that drifts, whose samples are all correlated: over all lags of all samples, 10¹² products, this would
/// not end.
#[test]
fn a_long_record_takes_no_longer_than_its_length() {
    let n = 1 << 20;
    let speeds: Vec<f64> = (0..n).map(|i| 1.0 + i as f64 / n as f64).collect();
    let run = ConstantSpeedRun::from_record(&speeds, &speeds, 1e4).expect("good");
    assert!(run.torque_standard_error.is_some());
}
