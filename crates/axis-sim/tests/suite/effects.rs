//! Effects vanish at their null value, to the bit, and do something elsewhere.

use axis_sim::effects::{ActiveEffect, EFFECTS, Machine};
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
        let mut typical = effect.typical();
        // Where and when the test's short motion is.
        match effect.name {
            "position-dependent-friction" => typical[1] = 0.604,
            "process-force" => (typical[1], typical[2]) = (0.05, 0.1),
            _ => {}
        }
        assert!(!same(&without, &with(typical)), "{}", effect.name);
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
        error.contains("backslash") && error.contains("viscous-friction"),
        "{error}"
    );
    let bad = with.replace("4e-6", "4");
    let error = Axis::parse("bad.toml", &bad).unwrap_err().to_string();
    assert!(error.contains("gap from"), "{error}");
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
