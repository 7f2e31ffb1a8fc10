//! Values of any kind, whatever they are: an answer, or a refusal that says
//! what is valid. Nothing here panics or hangs.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]
#![cfg(feature = "identify")]

use compensator::{
    Candidates, Combined, Compensator, FeedforwardDrive, FrictionFeedforward, MotionEstimator,
    MotionRecord, NetworkCompensation, NoCompensation, ObserverGains, Reference, Sample,
    TransferFunction, TransferFunctionError, TransferFunctionModel, identify_transfer_function,
};
use lugre::{LuGre, Parameters};
use proptest::prelude::*;

/// All bit patterns, and magnitudes of which some are valid.
fn any_number() -> impl Strategy<Value = f64> {
    let special = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        0.0,
        -0.0,
        5e-324,
    ];
    prop_oneof![
        1 => any::<f64>(),
        3 => (-20.0..20.0f64).prop_map(|x| 10f64.powf(x)),
        2 => -2.0..2.0f64,
        1 => prop::sample::select(special.to_vec()),
    ]
}

/// Of some magnitude that may be, or of any.
fn series() -> impl Strategy<Value = Vec<f64>> {
    let valid = (-99.0..99.0f64, prop::collection::vec(-2.0..2.0f64, 0..40))
        .prop_map(|(exponent, v)| v.iter().map(|x| x * 10f64.powf(exponent)).collect());
    prop_oneof![4 => valid, 1 => prop::collection::vec(any_number(), 0..40)]
}

fn any_sample() -> impl Strategy<Value = Sample> {
    prop::array::uniform10(any_number()).prop_map(|v| {
        let reference = |i: usize| Reference {
            position: v[i],
            velocity: v[i + 1],
            acceleration: v[i + 2],
        };
        Sample {
            reference: reference(0),
            next_reference: reference(3),
            position: v[6],
            motor_angle: 0.0,
            motor_speed: v[7],
            iq: v[8],
            last_command: v[9],
        }
    })
}

fn law() -> LuGre {
    LuGre::new(Parameters {
        viscous: 0.0298,
        ..Parameters::LIU_2025
    })
    .unwrap()
}

/// Runs a strategy over the samples, then over plain ones after a reset: what
/// came before leaves no trace.
fn is_sound(mut law: impl Compensator, samples: &[Sample]) -> bool {
    for sample in samples {
        law.correct(sample);
    }
    law.reset();
    (0..3).all(|_| {
        let correction = law.correct(&Sample::default());
        correction.position.is_finite() && correction.command.is_finite()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_settings_are_refused_or_work(
        v in prop::array::uniform6(any_number()),
        poles in prop::collection::vec(any_number(), 0..20),
        samples in prop::collection::vec(any_sample(), 0..6),
    ) {
        let gains = ObserverGains { position: v[0], drift: v[1], acceleration: v[2] };
        gains.noise_gains();
        for gains in [gains, ObserverGains::critically_damped(v[3]).unwrap_or_default()] {
            for (r, period) in [(v[4], v[5]), (1e-3, 1e-4)] {
                let Ok(estimator) = MotionEstimator::new(r, period, gains) else { continue };
                let noise = gains.noise_gains();
                prop_assert!(noise.position >= 0.0 && noise.loop_input >= 1.0, "{gains:?} {noise:?}");
                let model = |_: f64, v: f64, _: f64, _: f64| v * period;
                prop_assert!(is_sound(NetworkCompensation::new(model, estimator), &samples));
            }
        }
        if let Ok(friction) = FrictionFeedforward::new(law(), FeedforwardDrive { travel_per_radian: v[0], torque_constant: v[1], period: v[2] }) {
            prop_assert!(is_sound(Combined::new(NoCompensation, friction), &samples));
        }
        let coefficients = vec![v[3]; poles.len()];
        for (period, poles) in [(v[4], &poles[..]), (1e-4, &[0.5, 0.9])] {
            let Ok(model) = TransferFunctionModel::new(period, v[5], poles, &coefficients[..poles.len().min(coefficients.len())]) else {
                continue;
            };
            model.response(v[0]);
            model.simulate(&v);
            for law in [Ok(TransferFunction::new(model)), TransferFunction::with_lead(model, v[1])].into_iter().flatten() {
                prop_assert!(is_sound(law, &samples));
            }
        }
    }

    #[test]
    fn any_motion_is_refused_or_identified(
        period in prop_oneof![3 => Just(1e-4), 1 => any_number()],
        a in series(),
        e in series(),
        max_order in prop_oneof![0..5usize, any::<usize>()],
        cycles in prop::collection::vec(prop::collection::vec(prop_oneof![-1.0..1.0f64, any_number()], 1..3), 1..3),
        usual: bool,
    ) {
        let count = a.len().min(e.len());
        let motion = MotionRecord { period, acceleration: &a[..count], error: &e[..count] };
        let candidates = if usual {
            Candidates { max_order: 3, ..Candidates::for_period(period) }
        } else {
            Candidates { max_order, pole_cycles: cycles }
        };
        if let Ok(fit) = identify_transfer_function(&[motion], &[motion], &candidates) {
            prop_assert!(fit.chosen.validation_rms.is_finite());
            prop_assert!(fit.model.coefficients().iter().all(|c| c.is_finite()));
        }
    }
}

/// Without a sample to judge by, the first candidate would count as the best.
#[test]
fn validation_motions_without_samples_are_refused() {
    let a: Vec<f64> = (0..50).map(|k| f64::from(k % 7) - 3.0).collect();
    let motion = MotionRecord {
        period: 1e-4,
        acceleration: &a,
        error: &a,
    };
    let empty = MotionRecord {
        acceleration: &[],
        error: &[],
        ..motion
    };
    let candidates = Candidates {
        max_order: 1,
        pole_cycles: vec![vec![0.5]],
    };
    let refused = identify_transfer_function(&[motion], &[empty], &candidates).unwrap_err();
    assert_eq!(refused, TransferFunctionError::Empty("validation sample"));
    // Squares of these would overflow, and the sums say nothing.
    let huge = vec![1e200; 50];
    let huge = MotionRecord {
        error: &huge,
        ..motion
    };
    let refused = identify_transfer_function(&[motion], &[huge], &candidates).unwrap_err();
    assert!(
        refused.to_string().contains("from -1e100 to 1e100"),
        "{refused}"
    );
}

#[test]
fn absurd_settings_are_refused_with_the_limit() {
    let refusals = [
        MotionEstimator::new(1e-300, 1e-4, ObserverGains::default()).map(drop),
        MotionEstimator::new(1e-3, 1e-12, ObserverGains::default()).map(drop),
        ObserverGains::critically_damped(1e17).map(drop),
        FrictionFeedforward::new(
            law(),
            FeedforwardDrive {
                travel_per_radian: 1e-3,
                torque_constant: 1e-310,
                period: 1e-4,
            },
        )
        .map(drop),
        TransferFunctionModel::new(1e4, 0.0, &[], &[]).map(drop),
        TransferFunctionModel::new(1e-4, 0.0, &[], &[])
            .and_then(|model| TransferFunction::with_lead(model, 1e300))
            .map(drop),
    ];
    let limits = [
        "1e3 m/rad",
        "1e-9 to 1e3 s",
        "at most 1e6",
        "1e9 N·m/A",
        "1e3 s",
        "0 to 1e3 s",
    ];
    for (refusal, limit) in refusals.into_iter().zip(limits) {
        let message = refusal.unwrap_err().to_string();
        assert!(message.contains(limit), "{message}");
    }
}
