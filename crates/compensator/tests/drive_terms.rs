//! The terms of an ordinary drive: their values, what a drive makes of them, and what it
//! makes of samples that are none.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use compensator::{
    Cascade, Compensator, CompensatorError, Correction, Drive, DriveModel, DriveSection,
    DriveTerms, DriveTermsFeedforward, Reference, ReversalStart, Sample, StrokeSections,
};
use lugre::{LuGre, Parameters};
use proptest::prelude::*;
use trajectories::{Limits, Motion, SCurve};

const R: f64 = 0.01 / std::f64::consts::TAU;
const T: f64 = 1e-4;
const START: ReversalStart = ReversalStart {
    acceleration: 0.0,
    jerk: 1.2,
};

/// A ball screw of about the size of Liu et al. 2025, its load rising by 20 N a metre.
fn model(from_motor: bool) -> DriveModel {
    let section = |x: f64| DriveSection {
        compliance: 6e-3 + 1e-4 * x,
        rotating: 8.4e-3,
        lagging: 2e-3,
        load: 100.0 + 20.0 * x,
    };
    DriveModel {
        travel: R,
        load_inertia: 515.0,
        friction: LuGre::new(Parameters {
            viscous: 0.0298,
            ..Parameters::LIU_2025
        })
        .unwrap(),
        lever: R,
        along: StrokeSections::new([0.0, 1.5], section).unwrap(),
        kinematics: compensator::Kinematics::default(),
        drive: Drive::Lag {
            gain: 1.641,
            bandwidth: 6000.0,
        },
        delay: 0.0,
        effort_limit: 15.0,
        cascade: Cascade {
            position: 29_342.0,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: 0.6474,
            speed_integral: 6.801,
            from_motor,
            signal_path: compensator::SignalPath::default(),
        },
        period: T,
    }
}

fn terms(from_motor: bool) -> DriveTerms {
    DriveTerms::new(&model(from_motor), &START).unwrap()
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * (1.0 + b.abs())
}

/// Samples along the way there and back over 300 mm, with a rest between.
fn samples() -> Vec<Sample> {
    let limits = Limits::new(0.1, 0.225, 1.2).unwrap();
    let there = SCurve::plan(0.6, 0.9, &limits).unwrap();
    let back = SCurve::plan(0.9, 0.6, &limits).unwrap();
    let rest = there.duration() + 0.1;
    let at = |k: usize| {
        let time = k as f64 * T;
        let s = match time < rest {
            true => there.at(time),
            false => back.at(time - rest),
        };
        Reference {
            position: s.position,
            velocity: s.velocity,
            acceleration: s.acceleration,
        }
    };
    let cycles = ((rest + back.duration()) / T) as usize + 500;
    let sample = |k| Sample {
        reference: at(k),
        next_reference: at(k + 1),
        ..Sample::default()
    };
    (0..cycles).map(sample).collect()
}

#[test]
fn values_are_those_of_the_formulas() {
    let t = terms(false);
    let (m, middle) = (515.0, 6e-3 + 1e-4 * 0.75);
    assert!(near(t.inertia, 8.4e-3 + R * R * m));
    assert!(near(
        t.effort_per_acceleration,
        (8.4e-3 + R * R * m) / (R * 1.641)
    ));
    assert!(near(t.viscous, 0.0298) && near(t.coulomb, 0.6757));
    assert!(near(t.standing, R * 115.0));
    let winding = R * m + 2e-3 / R;
    let row = t.row(0.75);
    assert!(near(row.speed_per_jerk, middle * winding));
    assert!(near(row.position_per_acceleration, R * middle * winding));
    assert!(near(row.lost_motion, 2.0 * R * middle * 0.6757));
    let rows: Vec<_> = t.table().collect();
    assert!(rows.len() == 33 && rows[0].position == 0.0 && near(rows[32].position, 1.5));
    assert!(near(rows[32].load, R * 130.0));
}

/// Friction in a coordinate of its own (here the load's way) comes over to the motor.
#[test]
fn friction_of_the_load_is_seen_from_the_motor() {
    let mut model = model(false);
    let p = model.friction.parameters();
    model.lever = 1.0;
    model.friction = LuGre::new(Parameters {
        coulomb: p.coulomb / R,
        stiction: p.stiction / R,
        stribeck_speed: p.stribeck_speed * R,
        stiffness: p.stiffness / (R * R),
        damping: p.damping / (R * R),
        viscous: p.viscous / (R * R),
    })
    .unwrap();
    let (a, b) = (DriveTerms::new(&model, &START).unwrap(), terms(false));
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * b.abs();
    assert!(close(a.coulomb, b.coulomb) && close(a.viscous, b.viscous));
    assert!(close(a.pulse.amplitude, b.pulse.amplitude));
    assert!(close(a.pulse.delay, b.pulse.delay) && close(a.pulse.decay, b.pulse.decay));
}

/// The command along even motion, and where the wind-up enters by the place of the sensor.
#[test]
fn even_acceleration() {
    for from_motor in [false, true] {
        let t = terms(from_motor);
        let mut law = DriveTermsFeedforward::new(t);
        let at = |k: f64| Reference {
            position: 0.6 + 0.5 * 0.05 * (k * T).powi(2),
            velocity: 0.05 * k * T,
            acceleration: 0.05,
        };
        let mut c = Correction::default();
        let last = 20_000;
        for k in 0..=last {
            c = law.correct(&Sample {
                reference: at(f64::from(k)),
                next_reference: at(f64::from(k + 1)),
                ..Sample::default()
            });
        }
        let (now, next) = (at(f64::from(last)), at(f64::from(last + 1)));
        let load = R * 20.0 * (next.position - 0.6);
        let torque = t.inertia * 0.05 / R + t.viscous * next.velocity / R + t.coulomb + load;
        assert!((c.command - torque / 1.641).abs() < 1e-9, "{c:?}");
        let s = |at: &Reference| {
            let b = t.viscous * at.velocity / R;
            let row = t.row(at.position);
            let compliance = row.lost_motion / (2.0 * R * t.coulomb);
            row.speed_per_jerk * at.acceleration + compliance * (b + row.load)
        };
        let wound = t.row(now.position).lost_motion / 2.0;
        let expected = match from_motor {
            // The level's own wind-up comes over the decay, and the way it was wound at the
            // start, accelerating and loaded, is home.
            true => R * (s(&now) - s(&at(0.0))) + wound,
            false => (s(&next) - s(&now)) / (T * 29_342.0),
        };
        assert!((c.position - expected).abs() < 1e-8, "{c:?} {expected}");
    }
}

/// After a reversal the level changes by twice as much as after a start, and so does the
/// pulse; at rest the level holds.
#[test]
fn pulse_of_a_reversal_is_twice_that_of_a_start() {
    let t = terms(false);
    let mut law = DriveTermsFeedforward::new(t);
    let crawl = |velocity: f64| {
        let reference = Reference {
            velocity,
            ..Reference::default()
        };
        Sample {
            reference,
            next_reference: reference,
            ..Sample::default()
        }
    };
    let friction = |iq: f64, v: f64| iq * 1.641 - t.viscous * v / R;
    let mut run = |v: f64, cycles: usize| -> Vec<f64> {
        (0..cycles)
            .map(|_| friction(law.correct(&crawl(v)).command, v))
            .collect()
    };
    let start = run(1e-3, 10_000);
    assert_eq!(start[0], 0.0);
    let height = start.iter().copied().fold(0.0, f64::max) - t.coulomb;
    assert!((height - t.pulse.amplitude).abs() < 0.01 * t.pulse.amplitude);
    assert!((start[9_999] - t.coulomb).abs() < 1e-6);
    assert!((run(0.0, 10)[9] - t.coulomb).abs() < 1e-6);
    let back = run(-1e-3, 10_000);
    let height = -t.coulomb - back.iter().copied().fold(0.0, f64::min);
    assert!((height - 2.0 * t.pulse.amplitude).abs() < 0.02 * t.pulse.amplitude);
    // A drive that goes on from there starts with that level.
    let mut law = law.carried_on();
    assert!((1.641 * law.correct(&crawl(0.0)).command + t.coulomb).abs() < 1e-6);
}

/// Friction that comes up at once, or none, has no pulse.
#[test]
fn no_pulse_without_presliding() {
    let mut stiff = model(false);
    let p = stiff.friction.parameters();
    stiff.friction = LuGre::new(Parameters {
        stiction: p.coulomb,
        stiffness: 1e9,
        damping: 0.0,
        ..p
    })
    .unwrap();
    let mut none = model(false);
    none.friction = LuGre::new(Parameters {
        coulomb: 0.0,
        stiction: 0.0,
        ..p
    })
    .unwrap();
    let pulse = DriveTerms::new(&none, &START).unwrap().pulse;
    assert_eq!((pulse.amplitude, pulse.decay), (0.0, 0.0));
    let pulse = DriveTerms::new(&stiff, &START).unwrap().pulse;
    assert!(pulse.delay + pulse.decay < 0.01, "{pulse:?}");
    for model in [stiff, none] {
        let mut law = DriveTermsFeedforward::new(DriveTerms::new(&model, &START).unwrap());
        for sample in samples() {
            let c = law.correct(&sample);
            assert!(c.command.is_finite() && c.position.is_finite());
        }
    }
}

/// The command to 80 roundings of its size, the position to 10 nm.
#[test]
fn single_precision_follows_double() {
    for from_motor in [false, true] {
        let single = terms(from_motor).cast::<f32>();
        let double = single.cast::<f64>();
        let mut single = DriveTermsFeedforward::new(single);
        let mut double = DriveTermsFeedforward::new(double);
        let (mut off, mut size) = (Correction::default(), Correction::default());
        for sample in samples() {
            let sample = sample.cast::<f32>();
            let a: Correction = single.correct(&sample).cast();
            let b = double.correct(&sample.cast());
            off.position = f64::max(off.position, (a.position - b.position).abs());
            off.command = f64::max(off.command, (a.command - b.command).abs());
            size.position = f64::max(size.position, b.position.abs());
            size.command = f64::max(size.command, b.command.abs());
        }
        // Time since the change of direction is a sum of periods, which rounds.
        let epsilon = f64::from(f32::EPSILON);
        assert!(
            off.command < 80.0 * epsilon * size.command,
            "{off:?} of {size:?}"
        );
        assert!(off.position < 1e-8, "{off:?} of {size:?}");
    }
}

#[test]
fn settings_that_make_no_terms_are_refused_by_name() {
    let refused = |model: &DriveModel, start: &ReversalStart| match DriveTerms::new(model, start) {
        Err(CompensatorError::Setting { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    let start = |acceleration, jerk| ReversalStart { acceleration, jerk };
    assert_eq!(refused(&model(false), &start(0.0, 0.0)), "jerk");
    assert_eq!(refused(&model(false), &start(0.0, f64::NAN)), "jerk");
    assert_eq!(refused(&model(false), &start(-1.0, 1.0)), "acceleration");
    let mut none = model(false);
    none.travel = 0.0;
    assert_eq!(refused(&none, &START), "travel_per_radian");
    let mut none = model(false);
    none.cascade.velocity_feedforward = f64::INFINITY;
    assert_eq!(refused(&none, &START), "velocity_feedforward");
}

/// All bit patterns, and magnitudes of which some are valid.
fn any_number() -> impl Strategy<Value = f64> {
    let special = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
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

fn any_sample() -> impl Strategy<Value = Sample> {
    prop::array::uniform6(any_number()).prop_map(|v| {
        let reference = |i: usize| Reference {
            position: v[i],
            velocity: v[i + 1],
            acceleration: v[i + 2],
        };
        Sample {
            reference: reference(0),
            next_reference: reference(3),
            ..Sample::default()
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever comes, the command stays finite and within its limit, and a reset forgets.
    #[test]
    fn any_samples(samples in prop::collection::vec(any_sample(), 1..60), from_motor: bool) {
        let terms = terms(from_motor);
        let mut fresh = DriveTermsFeedforward::new(terms);
        let mut law = DriveTermsFeedforward::new(terms);
        let mut single = DriveTermsFeedforward::new(terms.cast::<f32>());
        for sample in &samples {
            let c = law.correct(sample);
            prop_assert!(c.position.is_finite() && c.command.abs() <= 15.0, "{c:?}");
            let c = single.correct(&sample.cast());
            prop_assert!(c.position.is_finite() && c.command.abs() <= 15.0, "{c:?}");
        }
        law.reset();
        for sample in self::samples().iter().take(50) {
            prop_assert_eq!(law.correct(sample), fresh.correct(sample));
        }
    }

    /// Any start that is accepted gives a pulse of finite numbers, none negative in time.
    #[test]
    fn any_start(acceleration in any_number(), jerk in any_number()) {
        let start = ReversalStart { acceleration, jerk };
        if let Ok(terms) = DriveTerms::new(&model(false), &start) {
            let p = terms.pulse;
            prop_assert!(p.delay >= 0.0 && p.decay >= 0.0 && p.amplitude.is_finite(), "{p:?}");
            prop_assert!(p.delay.is_finite() && p.decay.is_finite(), "{p:?}");
        }
    }
}
