//! Effects vanish at their null value, to the bit, and do something elsewhere.

use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, EffectNeed, Measure, Nature, Scales};
use axis_sim::{Axis, LoggedReference, Replay, Trace};
use trajectories::Motion;

fn axis() -> Axis {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
    Axis::read(file.as_ref()).unwrap()
}

/// A quick move over 8 mm, as a log's reference; one cycle a sample.
fn replay(axis: &Axis) -> Replay {
    let limits = trajectories::Limits::new(0.1, 1.0, 20.0).unwrap();
    let motion = trajectories::SCurve::plan(0.6, 0.608, &limits).unwrap();
    let samples = (motion.duration() / axis.period) as usize;
    let at = |k: usize| motion.at(k as f64 * axis.period);
    let channel = |name: &str, f: &dyn Fn(usize) -> f64| {
        axis_log::Channel::new(name, (0..samples).map(f).collect()).unwrap()
    };
    let log = axis_log::Log::new(vec![
        channel("t_s", &|k| k as f64 * axis.period),
        channel("position_ref_m", &|k| at(k).position),
        channel("velocity_ref_m_s", &|k| at(k).velocity),
        channel("position_m", &|k| at(k).position),
    ])
    .unwrap();
    Replay::new(&log, axis.period).unwrap()
}

fn same(a: &Trace, b: &Trace) -> bool {
    let channels = a.channels.iter().zip(&b.channels);
    channels.into_iter().all(|((_, a), (_, b))| a == b)
}

/// Effects that the axis can have.
fn fitting(axis: &Axis) -> impl Iterator<Item = &'static Effect> {
    let all = EFFECTS.iter().copied();
    all.filter(move |effect| effect.applies_to(axis).is_ok())
}

#[test]
fn each_effect_vanishes_at_its_null_value_and_not_at_a_typical_one() {
    let axis = axis();
    let replay = replay(&axis);
    let without = replay.run(&axis, &[], None).unwrap();
    for effect in fitting(&axis) {
        let with = |values| {
            let active = ActiveEffect { effect, values };
            replay.run(&axis, &[active], None).unwrap()
        };
        assert!(
            same(&without, &with(effect.null(&Scales::of(&axis)))),
            "{}",
            effect.name
        );
        assert!(
            !same(&without, &with(values(effect, &axis, 1.0))),
            "{}",
            effect.name
        );
    }
}

/// Values of an effect with its sizes scaled, so that the loop holds with two
/// of them, and its shape where and when the test's short motion is.
fn values(effect: &Effect, axis: &Axis, share: f64) -> Vec<f64> {
    let mut values = effect.typical(&Scales::of(axis));
    for (value, p) in values.iter_mut().zip(effect.parameters) {
        if p.is_size() {
            *value *= share;
        }
    }
    for (value, p) in values.iter_mut().zip(effect.parameters) {
        match p.nature {
            Nature::Place(_) => *value = axis.stroke.start + 0.004,
            Nature::Begin(_) => *value = 0.05,
            Nature::End(_) => *value = 0.1,
            _ => {}
        }
    }
    values
}

/// The rule of the module's page, for every effect of the registry: two of the
/// same shape are one with the sum of their sizes, and one without size
/// changes nothing beside another of any shape, wherever it stands.
#[test]
fn two_of_an_effect_add() {
    let axis = axis();
    let replay = replay(&axis);
    for effect in fitting(&axis) {
        let run = |all: &[&Vec<f64>]| {
            let active = |values: &&Vec<f64>| ActiveEffect {
                effect,
                values: (*values).clone(),
            };
            let active: Vec<ActiveEffect> = all.iter().map(active).collect();
            replay.run(&axis, &active, None).unwrap()
        };
        // 0.5 + 0.25 = 0.75 without rounding.
        let (a, b, sum) = (
            values(effect, &axis, 0.5),
            values(effect, &axis, 0.25),
            values(effect, &axis, 0.75),
        );
        let expected: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + b).collect();
        for (p, (sum, expected)) in effect.parameters.iter().zip(sum.iter().zip(&expected)) {
            assert!(
                !p.is_size() || sum == expected,
                "{}: a rounded sum",
                effect.name
            );
        }
        let both = run(&[&a, &b]);
        assert!(same(&both, &run(&[&sum])), "{}: no sum", effect.name);
        assert!(same(&both, &run(&[&b, &a])), "{}: order", effect.name);
        assert!(
            !same(&both, &run(&[&a])),
            "{}: the first alone",
            effect.name
        );
        assert!(!same(&both, &run(&[&b])), "{}: the last alone", effect.name);

        // Of another shape, and without size.
        let mut nothing = values(effect, &axis, 0.0);
        for (value, p) in nothing.iter_mut().zip(effect.parameters) {
            if !p.is_size() {
                *value = 0.5 * (*value + p.bounds(&Scales::of(&axis))[1]);
            }
        }
        let alone = run(&[&a]);
        assert!(
            same(&alone, &run(&[&a, &nothing])),
            "{}: last wins",
            effect.name
        );
        assert!(
            same(&alone, &run(&[&nothing, &a])),
            "{}: first wins",
            effect.name
        );
    }
}

/// Two eccentricities in quadrature are one of √2 the size between them:
/// a sin θ + a sin(θ + π/2) = √2 a sin(θ + π/4).
#[test]
fn eccentricities_of_different_phase_superpose() {
    let axis = axis();
    let replay = replay(&axis);
    let effect = Effect::named("encoder-eccentricity").unwrap();
    let run = |all: &[[f64; 2]]| {
        let active = |values: &[f64; 2]| ActiveEffect {
            effect,
            values: values.to_vec(),
        };
        let active: Vec<ActiveEffect> = all.iter().map(active).collect();
        let trace = replay.run(&axis, &active, None).unwrap();
        trace.channel("motor_angle_rad").unwrap().to_vec()
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let two = run(&[[1e-3, 0.0], [1e-3, quarter]]);
    let one = run(&[[1e-3 * 2f64.sqrt(), 0.5 * quarter]]);
    let without = run(&[]);
    let apart = |a: &[f64], b: &[f64]| {
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        apart.fold(0.0, f64::max)
    };
    println!("{:e} of {:e} rad", apart(&two, &one), apart(&two, &without));
    // Rounding of an angle of 377 rad (6e-14): measured 1.1e-13 of 1.2e-3 rad.
    assert!(apart(&two, &one) < 1e-12, "{:e}", apart(&two, &one));
    assert!(apart(&two, &without) > 1e-4);
}

/// What fits the rigid mass of the EMPS benchmark.
const ON_RIGID: &[&str] = &[
    "viscous-friction",
    "coulomb-friction",
    "asymmetric-friction",
    "asymmetric-viscous-friction",
    "stribeck-friction",
    "position-dependent-friction",
    "warming-friction",
    "maxwell-slip-hysteresis",
    "constant-load",
    "process-force",
    "cyclic-load",
    "spring-force",
    "payload-mass",
    "structural-resonance",
    "torque-constant",
    "cogging-torque",
    "controller-gain",
    "speed-controller-gain",
    "reference-delay",
];

#[test]
fn an_effect_tells_whether_it_applies() {
    let rigid = crate::axis(crate::RIGID);
    let ball_screw = axis();
    let log = axis_log::Log::new(
        ["t_s", "position_ref_m", "position_m"]
            .map(|name| axis_log::Channel::new(name, vec![0.0, 1e-3, 2e-3]).unwrap())
            .to_vec(),
    )
    .unwrap();
    let replay = Replay::new(&log, 1e-3).unwrap();
    for effect in EFFECTS.iter().copied() {
        // A ball screw has all but what needs a load that turns, or a linear motor.
        let others = [EffectNeed::Turning, EffectNeed::LinearMotor];
        let elsewhere = others.iter().any(|need| effect.needs.contains(need));
        assert_eq!(effect.applies_to(&ball_screw).is_err(), elsewhere);
        // One mass under force and P-P control has no transmission, currents or encoder
        // at the motor; what has no need of them fits it.
        let fits = ON_RIGID.contains(&effect.name);
        assert_eq!(effect.applies_to(&rigid).is_ok(), fits, "{}", effect.name);
        // What it tells is what a replay does, and what a file may say.
        let values = values(effect, &rigid, 0.1);
        let mut entry = format!("\n[[effects]]\nname = \"{}\"\n", effect.name);
        for (p, value) in effect.parameters.iter().zip(&values) {
            entry += &format!("{} = {value}\n", p.name);
        }
        let ran = replay.run(&rigid, &[ActiveEffect { effect, values }], None);
        assert_eq!(ran.is_ok(), fits, "{}", effect.name);
        let read = Axis::parse("rigid.toml", &(crate::text(crate::RIGID) + &entry));
        match (effect.applies_to(&rigid), read) {
            (Ok(()), read) => assert!(read.is_ok(), "{}", effect.name),
            (Err(reason), read) => {
                let message = read.err().unwrap().to_string();
                assert!(message.contains(&reason), "{message}");
            }
        }
    }
}

/// What is said of an effect is said on a joint too.
#[test]
fn no_effect_speaks_of_a_screw() {
    for effect in EFFECTS {
        for text in [effect.summary, effect.depends_on] {
            let mut words = text.split(|c: char| !c.is_alphanumeric());
            let of_a_screw = ["screw", "nut", "table"];
            assert!(words.all(|word| !of_a_screw.contains(&word)), "{text}");
        }
    }
}

#[test]
fn names_are_unique_and_found() {
    for (i, effect) in EFFECTS.iter().enumerate() {
        assert!(EFFECTS[..i].iter().all(|other| other.name != effect.name));
        assert!(axis_sim::effects::Effect::named(effect.name).is_some());
    }
}

#[test]
fn a_logged_reference_passes_through_its_samples_and_is_smooth_between() {
    let t: Vec<f64> = (0..200).map(|k| f64::from(k) * 1e-3).collect();
    // What the interpolation is exact for, where nothing is left of the slopes that a spline has
    // at its ends: each sample away from these leaves 2 − √3 of that.
    let position = |t: f64| 0.6 + 0.1 * t + 0.3 * t * t - 0.7 * t * t * t;
    let velocity = |t: f64| 0.1 + 0.6 * t - 2.1 * t * t;
    let log = axis_log::Log::new(vec![
        axis_log::Channel::new("t_s", t.clone()).unwrap(),
        axis_log::Channel::new("position_ref_m", t.iter().map(|&t| position(t)).collect()).unwrap(),
        axis_log::Channel::new("velocity_ref_m_s", t.iter().map(|&t| velocity(t)).collect())
            .unwrap(),
    ])
    .unwrap();
    let reference = LoggedReference::new(&log, 1e-3).unwrap();
    for k in 0..1980 {
        let t = f64::from(k) * 1e-4;
        let at = reference.at(t);
        let from_end = (k / 10).min(198 - k / 10);
        let of_end = 0.268_f64.powi(from_end);
        // Rounding of 0.6, divided by the sampling period for the velocity.
        assert!((at.position - position(t)).abs() < 1e-14 + 1e-10 * of_end);
        assert!((at.velocity - velocity(t)).abs() < 1e-11 + 1e-6 * of_end);
    }
}

#[test]
fn effects_stand_in_the_axis_file() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
    let text = std::fs::read_to_string(file).unwrap();
    let with = format!("{text}\n[[effects]]\nname = \"backlash\"\ngap = 4e-6\n");
    let axis = Axis::parse("with.toml", &with).unwrap();
    assert_eq!(axis.effects[0].values, [4e-6]);
    assert_ne!(axis.fingerprint, self::axis().fingerprint);

    let bad = with.replace("backlash", "backslash");
    let error = Axis::parse("bad.toml", &bad).unwrap_err().to_string();
    assert!(
        error.contains("backslash") && error.contains("did you mean \"backlash\"?"),
        "{error}"
    );
    // Errors stand at the line of what is wrong.
    let line = 1 + with.lines().position(|l| l.starts_with("gap")).unwrap();
    for (from, to, says) in [
        (
            "gap = 4e-6",
            "gap = 4",
            "effects[1].gap` is 4; valid: a number from 0 to 0.001 m",
        ),
        (
            "gap = 4e-6",
            "gpa = 4e-6",
            "effects[1].gpa` is not a key of this table; did you mean `gap`?",
        ),
    ] {
        let bad = with.replace(from, to);
        let error = Axis::parse("bad.toml", &bad).unwrap_err().to_string();
        assert!(error.starts_with(&format!("bad.toml:{line}: `")), "{error}");
        assert!(error.contains(says), "{error}");
    }
    let bad = with.replace("name = \"backlash\"", "nmae = \"backlash\"");
    let error = Axis::parse("bad.toml", &bad).unwrap_err().to_string();
    assert!(error.contains("did you mean `name`?"), "{error}");
}

/// What a search may find at the speed of logs, where the file says nothing of speed, stands in the file that it writes.
#[test]
fn an_effect_in_proportion_to_the_speed_of_logs_is_read() {
    let text = std::fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../data/axes/emps.toml"
    ))
    .unwrap();
    let mut axis = Axis::parse("axis.toml", &text).unwrap();
    assert!(axis.trajectories.is_empty());
    let expected = 0.12 * Scales::of(&axis).ratio(Measure::Speed);
    for by in [0.02, 1.0, 50.0] {
        axis.fastest = Some(by * expected);
        let scales = Scales::of(&axis);
        for effect in fitting(&axis) {
            for edge in [0, 1] {
                let values = effect.parameters.iter().map(|p| p.bounds(&scales)[edge]);
                let values = values.collect();
                let entry = ActiveEffect { effect, values }.entry(&scales, |v| format!("{v:e}"));
                let read = Axis::parse("axis.toml", &format!("{text}{entry}"));
                assert!(read.is_ok(), "{by}: {} {:?}", effect.name, read.err());
            }
        }
    }
}

#[test]
fn the_emps_axis_is_a_rigid_mass() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/emps.toml");
    let axis = Axis::read(file.as_ref()).unwrap();
    assert_eq!(axis.period, 1e-3);
    let kinds = [
        axis.mechanism.kind().name,
        axis.actuator.kind().name,
        axis.control.kind().name,
        axis.friction.kind().name,
    ];
    assert_eq!(kinds, ["rigid-mass", "force-gain", "p-p", "coulomb"]);
}
