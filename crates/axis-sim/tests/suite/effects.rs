//! Effects vanish at their null value, to the bit, and do something elsewhere.

use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, Machine};
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

#[test]
fn each_effect_vanishes_at_its_null_value_and_not_at_a_typical_one() {
    let axis = axis();
    let replay = replay(&axis);
    let machine = Machine::BallScrew(Box::new(axis));
    let without = replay.run(&machine, &[], None).unwrap();
    for effect in EFFECTS.iter().copied() {
        let with = |values| {
            let active = ActiveEffect { effect, values };
            replay.run(&machine, &[active], None).unwrap()
        };
        assert!(same(&without, &with(effect.null())), "{}", effect.name);
        assert!(
            !same(&without, &with(values(effect, 1.0))),
            "{}",
            effect.name
        );
    }
}

/// Values of an effect with its sizes scaled, so that the loop holds with two
/// of them, and its shape where and when the test's short motion is.
fn values(effect: &Effect, share: f64) -> Vec<f64> {
    let mut values = effect.typical();
    for (value, p) in values.iter_mut().zip(effect.parameters) {
        if p.size {
            *value *= share;
        }
    }
    match effect.name {
        "position-dependent-friction" => values[1] = 0.604,
        "process-force" => (values[1], values[2]) = (0.05, 0.1),
        _ => {}
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
    let machine = Machine::BallScrew(Box::new(axis));
    for effect in EFFECTS.iter().copied() {
        let run = |all: &[&Vec<f64>]| {
            let active = |values: &&Vec<f64>| ActiveEffect {
                effect,
                values: (*values).clone(),
            };
            let active: Vec<ActiveEffect> = all.iter().map(active).collect();
            replay.run(&machine, &active, None).unwrap()
        };
        // 0.5 + 0.25 = 0.75 without rounding.
        let (a, b, sum) = (
            values(effect, 0.5),
            values(effect, 0.25),
            values(effect, 0.75),
        );
        let expected: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + b).collect();
        for (p, (sum, expected)) in effect.parameters.iter().zip(sum.iter().zip(&expected)) {
            assert!(!p.size || sum == expected, "{}: a rounded sum", effect.name);
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
        let mut nothing = values(effect, 0.0);
        for (value, p) in nothing.iter_mut().zip(effect.parameters) {
            if !p.size {
                *value = 0.5 * (*value + p.bounds[1]);
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
    let machine = Machine::BallScrew(Box::new(axis));
    let effect = Effect::named("encoder-eccentricity").unwrap();
    let run = |all: &[[f64; 2]]| {
        let active = |values: &[f64; 2]| ActiveEffect {
            effect,
            values: values.to_vec(),
        };
        let active: Vec<ActiveEffect> = all.iter().map(active).collect();
        let trace = replay.run(&machine, &active, None).unwrap();
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
    // Rounding, carried through the loop: measured 4e-15 of 2e-3 rad.
    assert!(apart(&two, &one) < 3e-14, "{:e}", apart(&two, &one));
    assert!(apart(&two, &without) > 1e-4);
}

#[test]
fn an_effect_tells_whether_it_applies() {
    let rigid = Machine::read(&crate::data(crate::RIGID)).unwrap();
    let ball_screw = Machine::BallScrew(Box::new(axis()));
    let log = axis_log::Log::new(
        ["t_s", "position_ref_m", "position_m"]
            .map(|name| axis_log::Channel::new(name, vec![0.0, 1e-3, 2e-3]).unwrap())
            .to_vec(),
    )
    .unwrap();
    let replay = Replay::new(&log, 1e-3).unwrap();
    for effect in EFFECTS.iter().copied() {
        assert_eq!(effect.applies_to(&ball_screw), Ok(()));
        assert_eq!(effect.applies_to(&rigid).is_ok(), effect.on_rigid);
        // What it tells is what a replay does, and what a file may say.
        let values = values(effect, 0.1);
        let mut entry = format!("\n[[effects]]\nname = \"{}\"\n", effect.name);
        for (p, value) in effect.parameters.iter().zip(&values) {
            entry += &format!("{} = {value}\n", p.name);
        }
        let ran = replay.run(&rigid, &[ActiveEffect { effect, values }], None);
        assert_eq!(ran.is_ok(), effect.on_rigid, "{}", effect.name);
        let read = Machine::parse("rigid.toml", &(crate::text(crate::RIGID) + &entry));
        match (effect.applies_to(&rigid), read) {
            (Ok(()), read) => assert!(read.is_ok(), "{}", effect.name),
            (Err(reason), read) => {
                let message = read.err().unwrap().to_string();
                assert!(message.contains(reason), "{message}");
            }
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
    // A cubic is what the interpolation is exact for.
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
        // Rounding of 0.6, divided by the sampling period for the velocity.
        assert!((at.position - position(t)).abs() < 1e-15 * 10.0);
        assert!((at.velocity - velocity(t)).abs() < 1e-11);
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

#[test]
fn the_emps_axis_is_a_rigid_mass() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/emps.toml");
    let Machine::Rigid(axis) = Machine::read(file.as_ref()).unwrap() else {
        panic!("a rigid mass");
    };
    assert_eq!(axis.period, 1e-3);
    let error = Axis::read(file.as_ref()).unwrap_err().to_string();
    assert!(error.contains("ball-screw"), "{error}");
}
