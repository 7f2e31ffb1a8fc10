//! Adaptation against an independent, slow simulation of two inertias, and on hostile logs.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use compensator::{
    AdaptError, AdaptParameter, AdaptPrior, Adaptation, Cascade, Drive, DriveModel, DriveSection,
    PriorSpread, Reference, Sample, StrokeSections,
};
use lugre::{LuGre, Parameters};

const PERIOD: f64 = 2e-4;
const TRAVEL: f64 = 0.01 / std::f64::consts::TAU;
/// Explicit steps a control period.
const STEPS: usize = 100;

/// The axis that is simulated.
fn truth() -> DriveModel {
    let along = StrokeSections::new([0.0, 1.0], |x| DriveSection {
        compliance: 6e-3 + 1e-3 * x,
        rotating: 6e-3,
        lagging: 0.0,
        load: 0.0,
    });
    DriveModel {
        travel: TRAVEL,
        load_inertia: 500.0,
        friction: LuGre::new(Parameters {
            coulomb: 0.7,
            stiction: 0.8,
            stribeck_speed: 2.7,
            stiffness: 15.0,
            damping: 1.5,
            viscous: 0.03,
        })
        .unwrap(),
        lever: TRAVEL,
        along: along.unwrap(),
        kinematics: compensator::Kinematics::default(),
        drive: Drive::Lag {
            gain: 1.0,
            bandwidth: f64::INFINITY,
        },
        delay: 0.0,
        effort_limit: 50.0,
        cascade: Cascade {
            position: 3e4,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: 0.65,
            speed_integral: 6.8,
            from_motor: false,
            signal_path: compensator::SignalPath::default(),
        },
        period: PERIOD,
    }
}

/// Forward and back, 60 mm each in 0.7 s, from rest.
fn reference(t: f64) -> Reference {
    let (way, time) = (0.06, 0.7);
    let rate = std::f64::consts::TAU / time;
    let turn = |t: f64| way * (t / time - (rate * t).sin() / std::f64::consts::TAU);
    let (sign, from, t) = match t {
        t if t < time => (1.0, 0.3, t),
        t => (-1.0, 0.3 + way, (t - time).min(time)),
    };
    Reference {
        position: from + sign * turn(t),
        velocity: sign * way / time * (1.0 - (rate * t).cos()),
        acceleration: sign * way / time * rate * (rate * t).sin(),
    }
}

/// A log of it under a plain controller: explicit steps of 2 µs, everything written out.
fn simulated() -> Vec<Sample> {
    let m = truth();
    let p = m.friction.parameters();
    let h = PERIOD / STEPS as f64;
    let (mut x, mut v, mut w, mut z) = (0.3, 0.0f64, 0.0, 0.0);
    let mut angle = x / TRAVEL;
    let (mut command, mut integral) = (0.0, 0.0);
    let mut log = Vec::new();
    for k in 0..7200 {
        let at = |k: usize| reference(k as f64 * PERIOD);
        log.push(Sample {
            reference: at(k),
            next_reference: at(k + 1),
            position: x,
            motor_angle: angle,
            motor_speed: w,
            iq: 0.0,
            last_command: command,
        });
        let r = at(k);
        let speed_error = 50.0 * (r.position - x) / TRAVEL + r.velocity / TRAVEL - w;
        integral += 6.8 * PERIOD * speed_error;
        command = 0.65 * speed_error + integral + 0.005 * r.acceleration / TRAVEL;
        for _ in 0..STEPS {
            let stiffness = 1.0 / m.along.at(x).compliance;
            let spring = stiffness * (angle - x / TRAVEL);
            let omega = v / TRAVEL;
            let level =
                p.coulomb + (p.stiction - p.coulomb) * (-(omega / p.stribeck_speed).powi(2)).exp();
            let rate = omega - p.stiffness * omega.abs() / level * z;
            let friction = p.stiffness * z + p.damping * rate + p.viscous * omega;
            w += h * (command - spring) / 6e-3;
            v += h * (spring - friction) / (TRAVEL * 500.0);
            z += h * rate;
            angle += h * w;
            x += h * v;
        }
    }
    log
}

/// A small generator of its own, so that a draw is the same everywhere.
struct Draw(u64);

impl Draw {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Sum of twelve uniform numbers: nearly Gaussian, of deviation 1.
    fn gaussian(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    /// 1 ± `share`.
    fn off(&mut self, share: f64) -> f64 {
        1.0 + share * (2.0 * self.uniform() - 1.0)
    }
}

/// With sensor noise, `times` 10 nm, 2 µrad, 10 mN·m.
fn noisy(log: &[Sample], times: f64, draw: &mut Draw) -> Vec<Sample> {
    let noisy = log.iter().map(|s| Sample {
        position: s.position + 1e-8 * times * draw.gaussian(),
        motor_angle: s.motor_angle + 2e-6 * times * draw.gaussian(),
        last_command: s.last_command + 1e-2 * times * draw.gaussian(),
        ..*s
    });
    noisy.collect()
}

const DRAWN: [AdaptParameter; 6] = [
    AdaptParameter::FrictionLevel,
    AdaptParameter::Viscosity,
    AdaptParameter::BristleStiffness,
    AdaptParameter::BristleDamping,
    AdaptParameter::LoadInertia,
    AdaptParameter::Compliance,
];

/// A model that is off, and the relative errors that it has.
fn assumed(draw: &mut Draw) -> (DriveModel, [f64; 6]) {
    let f: [f64; 6] = std::array::from_fn(|i| draw.off(if i == 4 { 0.1 } else { 0.2 }));
    let mut model = truth();
    let p = model.friction.parameters();
    model.friction = LuGre::new(Parameters {
        coulomb: p.coulomb * f[0],
        stiction: p.stiction * f[0],
        viscous: p.viscous * f[1],
        stiffness: p.stiffness * f[2],
        damping: p.damping * f[3],
        ..p
    })
    .unwrap();
    model.load_inertia *= f[4];
    model.along = model.along.with_compliance(f[5]);
    (model, f.map(|f| 1.0 / f - 1.0))
}

fn adaptation(model: &DriveModel) -> Adaptation {
    Adaptation::new(model, &AdaptPrior::default()).unwrap()
}

#[test]
fn one_log_tells_the_parameters_of_an_independent_simulation() {
    let log = simulated();
    for seed in 0..4 {
        let mut draw = Draw(seed);
        let (model, errors) = assumed(&mut draw);
        let mut adaptation = adaptation(&model);
        let learned = adaptation.learn(&noisy(&log, 1.0, &mut draw)).unwrap();
        assert!(learned.torque_after < 0.1 * learned.torque_before);
        for (parameter, error) in DRAWN.iter().zip(errors) {
            let found = learned
                .parameters
                .iter()
                .find(|p| p.parameter == *parameter);
            let found = found.unwrap();
            let off = (found.relative - error).abs();
            assert!(
                off < 0.01 && off < 5.0 * found.standard_error,
                "{found:?} {error}"
            );
            assert!(!found.at_bound);
        }
        let [travel, deviation] = learned.free_travel.unwrap();
        assert!(
            travel.abs() < 0.2e-6 + 3.0 * deviation,
            "{travel} {deviation}"
        );
        // What is handed on is what was found.
        let mass = adaptation.model().load_inertia;
        assert!((mass - 500.0).abs() < 5.0, "{mass}");
    }
}

/// Of 95 % intervals, 95 % hold: at noise far above what no model is better than.
#[test]
fn intervals_hold_as_often_as_they_say() {
    let log = simulated();
    let mut held = [0; 6];
    let draws = 80;
    for seed in 0..draws {
        let mut draw = Draw(1000 + seed);
        let (model, errors) = assumed(&mut draw);
        let mut adaptation = adaptation(&model);
        let learned = adaptation.learn(&noisy(&log, 20.0, &mut draw)).unwrap();
        for ((parameter, error), held) in DRAWN.iter().zip(errors).zip(&mut held) {
            let found = learned.parameters.iter();
            let found = found.filter(|p| p.parameter == *parameter);
            let inside = found.filter(|f| (f.relative - error).abs() < 1.96 * f.standard_error);
            *held += inside.count();
        }
    }
    let all: usize = held.iter().sum();
    let share = all as f64 / (6 * draws) as f64;
    println!("{share} of 95 % intervals hold: {held:?}");
    assert!((0.90..=0.985).contains(&share), "{share} {held:?}");
}

#[test]
fn a_load_far_beyond_the_prior_is_learned() {
    let mut model = truth();
    model.load_inertia = 300.0;
    let mut adaptation = adaptation(&model);
    adaptation.learn(&simulated()).unwrap();
    let mass = adaptation.model().load_inertia;
    assert!((mass - 500.0).abs() < 2.5, "{mass}");
}

#[test]
fn a_bound_holds_and_is_told() {
    let mut model = truth();
    model.load_inertia = 300.0;
    let spread = PriorSpread {
        deviation: 1.0,
        bound: 1.2,
    };
    let prior = AdaptPrior::default().with(AdaptParameter::LoadInertia, spread);
    let mut adaptation = Adaptation::new(&model, &prior).unwrap();
    let learned = adaptation.learn(&simulated()).unwrap();
    let inertia = learned.parameters.iter();
    let inertia = inertia.filter(|p| p.parameter == AdaptParameter::LoadInertia);
    assert!(inertia.clone().all(|p| p.at_bound) && inertia.count() == 1);
    assert!((adaptation.model().load_inertia - 360.0).abs() < 1e-9);
}

#[test]
fn steps_can_be_taken_back_and_bits_depend_on_the_logs_alone() {
    let log = simulated();
    let mut draw = Draw(5);
    let (model, _) = assumed(&mut draw);
    let logs = [noisy(&log, 1.0, &mut draw), noisy(&log, 1.0, &mut draw)];
    let mut first = adaptation(&model);
    assert_eq!(first.model(), model);
    assert!(!first.step_back());
    let one = first.learn(&logs[0]).unwrap();
    let after_one = first.model();
    first.learn(&logs[1]).unwrap();
    assert_eq!(first.moves(), 2);
    assert!(first.step_back());
    assert_eq!((first.model(), first.moves()), (after_one, 1));
    assert_eq!(first.estimates(), one.parameters);

    let mut second = adaptation(&model);
    assert_eq!(second.learn(&logs[0]).unwrap(), one);
    assert_eq!(second.model(), after_one);
    second.forget();
    assert_eq!(second.model(), model);
}

#[test]
fn hostile_logs_are_refused_and_change_nothing() {
    let log = simulated();
    let model = truth();
    let mut a = adaptation(&model);
    let mut refused = |log: &[Sample], what: &str| {
        let error = a.learn(log).unwrap_err();
        assert!(error.to_string().contains(what), "{error}");
        assert_eq!((a.model(), a.moves()), (model, 0));
    };
    refused(&[], "0 samples");
    refused(&log[..100], "100 samples");
    refused(&vec![Sample::default(); 5000], "moved by 0");
    for value in [f64::NAN, f64::INFINITY, 1e300] {
        let mut bad = log.clone();
        bad[777].motor_angle = value;
        refused(&bad, "sample 777: motor_angle");
    }
    let mut limited = log.clone();
    limited.iter_mut().for_each(|s| s.last_command = 60.0);
    refused(&limited, "at its limit");
    let mut silent = log.clone();
    silent.iter_mut().for_each(|s| s.last_command = 0.0);
    refused(&silent, "explains too little");
    let mut draw = Draw(9);
    let garbage: Vec<Sample> = (0..5000)
        .map(|_| Sample {
            position: draw.gaussian(),
            motor_angle: 1e6 * draw.gaussian(),
            motor_speed: 1e9 * draw.uniform(),
            last_command: 40.0 * draw.uniform(),
            ..Sample::default()
        })
        .collect();
    refused(&garbage, "explains too little");
}

/// A torn log is learned from, or refused: in no case it makes a far worse model.
#[test]
fn a_glitch_does_no_great_harm() {
    let mut log = simulated();
    log[2000].position += 1e-4;
    log[3000].last_command = 30.0;
    let mut adaptation = adaptation(&truth());
    if adaptation.learn(&log).is_ok() {
        for found in adaptation.estimates() {
            assert!(found.relative.abs() < 0.05, "{found:?}");
        }
    }
}

#[test]
fn settings_are_checked() {
    let bad = |f: &dyn Fn(&mut AdaptPrior)| {
        let mut prior = AdaptPrior::default();
        f(&mut prior);
        Adaptation::new(&truth(), &prior).unwrap_err()
    };
    let setting = |error: AdaptError| matches!(error, AdaptError::Setting(_));
    assert!(setting(bad(&|p| p.spreads[0].deviation = f64::NAN)));
    assert!(setting(bad(&|p| p.spreads[3].bound = 0.5)));
    assert!(setting(bad(&|p| p.retention = 1.5)));
    assert!(setting(bad(&|p| p.smoothing = 1.0)));
    let fixed = bad(&|p| p.spreads.iter_mut().for_each(|s| s.deviation = 0.0));
    assert_eq!(fixed, AdaptError::Nothing);
    let mut slow = truth();
    slow.period = 0.01;
    assert!(setting(
        Adaptation::new(&slow, &AdaptPrior::default()).unwrap_err()
    ));
}
