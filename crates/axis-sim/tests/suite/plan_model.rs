//! What plans assume of an axis with effects, against formulas written down here, and what
//! such a plan leaves on the machine that has them.

use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, ClosedLoop};
use compensator::{DriveModel, NoCompensation, Plan, PlanSettings, Reference, Target};
use trajectories::Motion;

use crate::{OTHERS, PRINTED, axis, changed};

fn with(axis: &Axis, effects: &[(&str, &[f64])]) -> Axis {
    let mut axis = axis.clone();
    for (name, values) in effects {
        axis.effects.push(ActiveEffect {
            effect: Effect::named(name).unwrap(),
            values: values.to_vec(),
        });
    }
    axis
}

/// Force of the assumed friction at a steady speed of the load.
fn steady(model: &DriveModel, speed: f64) -> f64 {
    model.friction.steady_state(speed / model.lever) / model.lever
}

#[test]
fn an_effect_that_is_a_number_of_a_part_is_assumed_as_if_the_file_said_it() {
    let lever = 0.010 / std::f64::consts::TAU;
    let more = 0.0003 / (std::f64::consts::PI / 30.0) + 8000.0 * lever * lever;
    let told = changed(
        PRINTED,
        &[
            (
                "viscous_n_m_per_rpm = 0.0003",
                &format!("viscous_n_m_s_per_rad = {more}"),
            ),
            (
                "torque_constant_n_m_per_a = 1.641",
                "torque_constant_n_m_per_a = 1.6738200000000001",
            ),
        ],
    );
    let found = with(
        &axis(PRINTED),
        &[
            ("viscous-friction", &[8000.0]),
            ("torque-constant", &[0.02]),
            ("payload-mass", &[30.0]),
        ],
    );
    let [told, found] = [told, found].map(|axis| axis.drive_model().unwrap());
    assert_eq!(found.load_inertia, told.load_inertia + 30.0);
    assert_eq!(found.drive, told.drive);
    let [a, b] = [&told, &found].map(|model| model.friction.parameters());
    assert!((a.viscous / b.viscous - 1.0).abs() < 1e-12, "{a:?} {b:?}");
    assert_eq!(
        [a.coulomb, a.stiction, a.stiffness],
        [b.coulomb, b.stiction, b.stiffness]
    );
}

#[test]
fn steady_friction_is_the_mean_of_both_directions_of_what_is_there() {
    // No fall with speed of its own, so that the effect's is the whole of it.
    let flat = changed(
        PRINTED,
        &[("stiction_n_m = 0.7653", "stiction_n_m = 0.6757")],
    );
    let effects: [(&str, &[f64]); 4] = [
        ("coulomb-friction", &[94.0]),
        ("asymmetric-friction", &[60.0, 20.0]),
        ("asymmetric-viscous-friction", &[3000.0, 1000.0]),
        ("stribeck-friction", &[70.0, 0.015]),
    ];
    let model = with(&flat, &effects).drive_model().unwrap();
    let own = flat.drive_model().unwrap();
    for speed in [1e-4, 1e-3, 0.01, 0.02, 0.05, 0.3, 2.0] {
        let falling = 70.0 * (-(speed / 0.015_f64).powi(2)).exp();
        let added = 94.0 + 40.0 + 2000.0 * speed + falling;
        let expected = steady(&own, speed) + added;
        let found = steady(&model, speed);
        assert!(
            (found / expected - 1.0).abs() < 1e-9,
            "{speed}: {found} for {expected}"
        );
    }
    // The way before it slides is the axis' own.
    let way = |model: &DriveModel| {
        let p = model.friction.parameters();
        p.coulomb / p.stiffness
    };
    assert!((way(&model) / way(&own) - 1.0).abs() < 1e-12);
}

/// As a search gives it: dry friction that the bristle has no more, and Maxwell's slip of its level.
#[test]
fn friction_with_a_memory_is_assumed_by_its_level() {
    let bare = axis(PRINTED);
    let level = 0.5 * bare.friction.law.parameters().coulomb
        / bare.friction.lever(bare.travel_per_radian());
    let slip = ("maxwell-slip-hysteresis", &[level, 3e-5][..]);
    let machine = with(&bare, &[("coulomb-friction", &[-level]), slip]);
    let [own, more, moved] =
        [&bare, &with(&bare, &[slip]), &machine].map(|a| a.drive_model().unwrap());
    for speed in [1e-4, 0.01, 0.3] {
        let added = steady(&more, speed) - steady(&own, speed);
        assert!((added / level - 1.0).abs() < 1e-9, "{speed}: {added}");
        let same = steady(&moved, speed) / steady(&own, speed);
        assert!((same - 1.0).abs() < 1e-12, "{speed}: {same}");
    }
    let closed = ClosedLoop::new(&machine).unwrap();
    let [none, told] = [None, Some(&moved)].map(|b| greatest(&closed, b));
    assert!(told < 0.3 * none, "{told} of {none}");
}

#[test]
fn a_load_along_the_stroke_is_assumed_where_it_is() {
    let bare = axis(PRINTED);
    let effects: [(&str, &[f64]); 2] = [("constant-load", &[-40.0]), ("spring-force", &[600.0])];
    let [own, model] = [bare.clone(), with(&bare, &effects)].map(|a| a.drive_model().unwrap());
    let [least, most] = model.along.ends();
    let sections = model.along.sections().iter().zip(own.along.sections());
    let last = (sections.len() - 1) as f64;
    for (i, (section, own)) in sections.enumerate() {
        let position = least + (most - least) * i as f64 / last;
        let expected = own.load - 40.0 + 600.0 * (position - bare.stroke.start);
        assert!(
            (section.load - expected).abs() < 1e-9,
            "{position}: {}",
            section.load
        );
    }
    assert_eq!(model.friction, own.friction);
}

#[test]
fn a_wave_of_the_transmission_is_assumed_and_planned_for() {
    let bare = axis(PRINTED);
    let waves: [(&str, &[f64]); 3] = [
        ("kinematic-error-harmonic", &[2e-6, 7.0, 0.4]),
        ("periodic-lead-error", &[0.5e-6, 1.0]),
        ("lead-error", &[1e-4]),
    ];
    let machine = with(&bare, &waves);
    let (model, own) = (machine.drive_model().unwrap(), bare.drive_model().unwrap());
    let found = [
        (model.kinematics.amplitude, 2e-6),
        (model.kinematics.order, 7.0),
        (model.kinematics.phase, 0.4),
    ];
    for (found, expected) in found {
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    }
    let closed = ClosedLoop::new(&machine).unwrap();
    let [none, untold, told] = [None, Some(&own), Some(&model)].map(|b| greatest(&closed, b));
    println!("{none} without, {untold} untold, {told} told");
    assert!(told < 0.5 * untold, "{told} of {untold}, {none} without");
}

#[test]
fn what_no_plan_follows_changes_none() {
    let bare = axis(PRINTED);
    let effects: [(&str, &[f64]); 6] = [
        ("cyclic-load", &[60.0, 0.8, 1.0]),
        ("process-force", &[60.0, 0.0, 5.0]),
        ("cogging-torque", &[0.05, 4.0, 0.3]),
        ("warming-friction", &[60.0, 2.0]),
        ("lead-error", &[1e-4]),
        ("encoder-eccentricity", &[1e-3, 0.2]),
    ];
    let [own, model] = [bare.clone(), with(&bare, &effects)].map(|a| a.drive_model().unwrap());
    assert_eq!(model, own);
}

#[test]
fn effects_that_leave_less_than_no_friction_are_refused() {
    let less = with(&axis(PRINTED), &[("coulomb-friction", &[-2000.0])]);
    let message = less.drive_model().unwrap_err().to_string();
    assert!(
        message.contains("[[effects]]") && message.contains("coulomb"),
        "{message}"
    );
}

/// Greatest tracking error along the axis' first trajectory, without a plan or with one.
fn greatest(closed: &ClosedLoop, assumed_model: Option<&DriveModel>) -> f64 {
    let axis = closed.axis();
    let motion = axis.plan(&axis.trajectories[0]).unwrap();
    let targets = |k: usize| {
        let at = motion.at(k as f64 * axis.period);
        Target::of(Reference {
            position: at.position,
            velocity: at.velocity,
            acceleration: at.acceleration,
        })
    };
    let mut most = 0.0_f64;
    let see = |cycle: &axis_sim::Cycle| most = most.max(cycle.error().abs());
    match assumed_model {
        None => closed.run(&motion, &mut NoCompensation, see),
        Some(model) => {
            let mut plan = Plan::new(model, &PlanSettings::default(), targets).unwrap();
            closed.run(&motion, &mut plan, see)
        }
    }
    .completed()
    .unwrap();
    most
}

#[test]
fn a_plan_that_is_told_what_was_found_does_as_well_as_on_the_machine_of_the_file() {
    for name in [PRINTED].into_iter().chain(OTHERS) {
        let bare = axis(name);
        let scales = axis_sim::effects::Scales::of(&bare);
        let typical = |name: &'static str| (name, Effect::named(name).unwrap().typical(&scales));
        let found = ["viscous-friction", "coulomb-friction", "payload-mass"].map(typical);
        let found = found
            .each_ref()
            .map(|(name, values)| (*name, values.as_slice()));
        let machine = with(&bare, &found);
        let (model, own) = (machine.drive_model().unwrap(), bare.drive_model().unwrap());
        let [as_filed, changed] = [&bare, &machine].map(|axis| ClosedLoop::new(axis).unwrap());
        let none = greatest(&changed, None);
        let [untold, told] =
            [&own, &model].map(|assumed_model| greatest(&changed, Some(assumed_model)) / none);
        let ideal = greatest(&as_filed, Some(&own)) / greatest(&as_filed, None);
        println!("{name}: {untold:.4} untold, {told:.4} told, {ideal:.4} as filed");
        assert!(
            told < 1.1 * ideal + 5e-3,
            "{name}: {told}, as filed {ideal}"
        );
        if name == PRINTED {
            assert!(told < 0.1 * untold, "{told} of {untold}");
        }
    }
}
