//! Drive terms of the paper's axis: values by hand, units, and the loss against the plan.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use std::f64::consts::{PI, TAU};
use std::path::PathBuf;
use std::sync::Arc;

use axis_pipeline::drive_terms::{
    Term, gain_terms, losses, of_axis, over_position, over_turn, terms,
};
use axis_pipeline::moves::{Moves, NamedMotion};
use axis_pipeline::strategies::{Predictors, STRATEGIES, named, reversal_start};
use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, ClosedLoop, Measured};
use compensator::{DriveTerms, DriveTermsFeedforward, ReversalPulse};
use trajectories::{Limits, SCurve};

fn axis(name: &str) -> Axis {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../data/axes");
    Axis::read(&folder.join(name)).unwrap()
}

/// A feed-forward that a file has to six digits, as `tune` writes it, lacks nothing; one that is a thousandth too low does.
#[test]
fn rounding_of_the_file_is_no_term_to_add() {
    let mut axis = axis("liu2025.toml");
    let to_add = |axis: &Axis| {
        let list = terms(axis, &of_axis(axis).unwrap());
        let of = |name: &str| list.iter().find(|term| term.name == name).unwrap().value;
        [
            of("acceleration_feedforward"),
            of("acceleration_feedforward_to_add"),
        ]
    };
    let [total, _] = to_add(&axis);
    let rounded: f64 = format!("{total:.5e}").parse().unwrap();
    assert_ne!(rounded, total);
    let mut fed = |by: f64| {
        axis.control
            .change(|values| values.set("acceleration_feedforward", by))
            .unwrap();
        to_add(&axis)[1]
    };
    assert_eq!(fed(rounded), 0.0);
    assert!((fed(0.999 * total) / (1e-3 * total) - 1.0).abs() < 1e-6);
}

/// From the numbers of the file: screw and mass, couplings, nut, friction.
#[test]
fn terms_of_the_papers_axis_by_hand() {
    let axis = axis("liu2025.toml");
    let list = terms(&axis, &of_axis(&axis).unwrap());
    let r = 0.01 / TAU;
    let (density, length, g) = (7850.0, 1.5, 206e9 / 2.6);
    let polar = PI * 0.04_f64.powi(4) / 32.0;
    let screw = density * polar * length;
    let rotating = 0.0053 + 1e-4 + screw;
    let total = rotating + r * r * 515.0;
    // At mid-stroke: nut, two couplings, half of the screw; of the screw's own inertia,
    // the parts beyond each spring.
    let x = 0.75;
    let per_force = 1.0 / 7.45e7 + r * r * (2.0 / 2800.0 + x / (g * polar));
    let lag = (1e-4 + screw) / 2800.0 + screw / 2800.0 + density * (length * x - x * x / 2.0) / g;
    let wind_up = 515.0 * per_force + lag;
    let expected = [
        ("travel_per_motor_angle", r, 10.0),
        ("torque_constant", 1.641, 1.641),
        ("inertia_total", total, 1e4 * total),
        ("inertia_rotating", rotating, 1e4 * rotating),
        ("inertia_ratio", total / rotating, total / rotating),
        (
            "acceleration_feedforward",
            total / (r * 1.641),
            total / (r * 1.641),
        ),
        ("velocity_feedforward", 1.0, 100.0),
        ("velocity_feedforward_to_add", 0.0, 0.0),
        ("viscous_friction", 0.0003 * 30.0 / PI, 0.3),
        ("coulomb_friction", 0.6757, 0.6757),
        ("coulomb_command", 0.6757 / 1.641, 0.6757 / 1.641),
        ("standing_load", 0.0, 0.0),
        ("wind_up_per_acceleration", wind_up, 1e6 * wind_up),
        ("speed_per_jerk", wind_up / r, wind_up / r * 30.0 / PI),
        (
            "lost_motion",
            2.0 * per_force * 0.6757 / r,
            2e6 * per_force * 0.6757 / r,
        ),
    ];
    for (name, si, drive) in expected {
        let term = list.iter().find(|t| t.name == name).unwrap();
        let near = |a: f64, b: f64| (a - b).abs() <= 2e-4 * b.abs() + 1e-15;
        assert!(near(term.value, si), "{term:?} {si}");
        assert!(near(term.drive_value, drive), "{term:?} {drive}");
    }
}

/// A mass on a lead has a motor that turns: its inertia is m r², its torque constant the
/// force's times r. A linear motor's are the slide's.
#[test]
fn terms_of_motors_that_turn_and_of_those_that_do_not() {
    let r = 2.5e-3 / TAU;
    let emps = [
        ("travel_per_motor_angle", r, "m/rad", 2.5, "mm/rev"),
        (
            "torque_constant",
            35.15065188 * r,
            "N·m/V",
            35.15065188 * r,
            "N·m/V",
        ),
        (
            "inertia_total",
            95.1089 * r * r,
            "kg·m²",
            95.1089e4 * r * r,
            "kg·cm²",
        ),
        (
            "acceleration_feedforward",
            95.1089 / 35.15065188,
            "V/(m/s²)",
            95.1089 / 35.15065188,
            "V/(m/s²)",
        ),
    ];
    let linear = [
        ("travel_per_motor_angle", 1.0, "m/m", 1.0, "1"),
        ("torque_constant", 93.0, "N/A", 93.0, "N/A"),
        ("inertia_total", 40.0, "kg", 40.0, "kg"),
        (
            "acceleration_feedforward",
            40.0 / 93.0,
            "A/(m/s²)",
            40.0 / 93.0,
            "A/(m/s²)",
        ),
    ];
    for (file, expected) in [("emps.toml", emps), ("linear-motor.toml", linear)] {
        let axis = axis(file);
        let list = terms(&axis, &of_axis(&axis).unwrap());
        for (name, value, unit, drive_value, drive_unit) in expected {
            let term = list.iter().find(|t| t.name == name).unwrap();
            let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
            assert!(
                near(term.value, value) && near(term.drive_value, drive_value),
                "{term:?}"
            );
            assert_eq!(
                (term.unit.as_str(), term.drive_unit.as_str()),
                (unit, drive_unit)
            );
        }
    }
}

#[test]
fn every_term_has_units_and_a_meaning_on_every_axis() {
    for file in [
        "liu2025.toml",
        "belt.toml",
        "rotary-table.toml",
        "linear-motor.toml",
        "linear-stage.toml",
        "emps.toml",
        "joint.toml",
    ] {
        let axis = axis(file);
        let of = of_axis(&axis).unwrap();
        let list = terms(&axis, &of);
        assert!(list.len() >= 23, "{file}");
        for t in &list {
            assert!(
                !t.unit.is_empty() && !t.drive_unit.is_empty() && !t.meaning.is_empty(),
                "{t:?}"
            );
            assert!(
                t.value.is_finite() && t.drive_value.is_finite(),
                "{file} {t:?}"
            );
        }
        let table = over_position(&axis, &of, &axis.position_errors().unwrap());
        assert!(table.rows.len() == 33);
        assert!(
            table
                .rows
                .iter()
                .all(|row| row.len() == table.headings.len())
        );
    }
}

/// Each step takes away most of what the one before has left.
#[test]
fn loss_is_ordered_on_the_models_own_trajectories() {
    let machine = axis("liu2025-machine.toml");
    let losses = losses(&machine, &machine).unwrap();
    assert_eq!(losses.len(), 6);
    for l in losses {
        assert!(l.drive_terms.max < 0.2 * l.none.max, "{l:?}");
        assert!(l.drive_terms.mean < 0.2 * l.none.mean, "{l:?}");
        assert!(l.plan.max < 0.05 * l.drive_terms.max, "{l:?}");
        assert!(l.plan.mean < 0.05 * l.drive_terms.mean, "{l:?}");
    }
}

/// Better than friction feed-forward alone, which has the true law but neither inertia
/// nor wind-up.
#[test]
fn better_than_friction_alone() {
    let machine = axis("liu2025-machine.toml");
    let mut predictors = Predictors::of(&machine);
    predictors.identified = Some(machine.friction.law);
    let kinds = ["lugre", "drive_terms"].map(|name| named(STRATEGIES, name).unwrap());
    let runs = axis_pipeline::compensation::compensate_with(
        &machine,
        &machine,
        &predictors,
        &kinds,
        || (),
    )
    .unwrap();
    for pair in runs.chunks(2) {
        let [lugre, terms] = [&pair[0].run.figures, &pair[1].run.figures];
        assert!(terms.max < 0.6 * lugre.max && terms.mean < 0.5 * lugre.mean);
    }
}

/// Greatest and mean error over the trajectories under terms, µm; `cargo test -p pipeline
/// --test drive_terms worth -- --nocapture` prints the table of docs/drive-terms.md.
fn error_under(machine: &Axis, terms: DriveTerms) -> [f64; 2] {
    let closed_loop = ClosedLoop::new(machine).unwrap();
    let [mut most, mut mean] = [0.0_f64; 2];
    for spec in &machine.trajectories {
        let motion = machine.plan(spec).unwrap();
        let mut errors = Vec::new();
        let mut law = DriveTermsFeedforward::new(terms);
        let run = closed_loop.run(&motion, &mut law, |cycle| errors.push(cycle.error()));
        run.completed().unwrap();
        let figures = axis_pipeline::Figures::of_si(&errors).unwrap();
        most = most.max(figures.max);
        mean = mean.max(figures.mean);
    }
    [most, mean]
}

/// Every term is worth having: without it more is left.
#[test]
fn what_each_term_is_worth() {
    let machine = axis("liu2025-machine.toml");
    let model = machine.drive_model().unwrap();
    let start = reversal_start(&machine);
    let all = DriveTerms::new(&model, &start).unwrap();
    let mut rigid = model;
    rigid.along = model.along.with_compliance(0.0);
    let with = |change: fn(&mut DriveTerms)| {
        let mut terms = all;
        change(&mut terms);
        terms
    };
    let without = [
        (
            "without torque feed-forward of the inertia",
            with(|t| t.effort_per_acceleration = 0.0),
        ),
        ("without viscous friction", with(|t| t.viscous = 0.0)),
        (
            "without wind-up, the pulse fitted again",
            DriveTerms::new(&rigid, &start).unwrap(),
        ),
        (
            "without the pulse: the level steps with the direction",
            with(|t| t.pulse = ReversalPulse::default()),
        ),
        ("pulse without delay", with(|t| t.pulse.delay = 0.0)),
        ("without wind-up, pulse without delay", {
            let mut terms = DriveTerms::new(&rigid, &start).unwrap();
            terms.pulse.delay = 0.0;
            terms
        }),
        ("without wind-up and pulse", {
            let mut terms = DriveTerms::new(&rigid, &start).unwrap();
            terms.pulse = ReversalPulse::default();
            terms
        }),
    ];
    let best = error_under(&machine, all);
    println!("all: {:.2} / {:.3}", best[0], best[1]);
    for (name, terms) in without {
        let [most, mean] = error_under(&machine, terms);
        println!("{name}: {most:.2} / {mean:.3}");
        assert!(most > 1.1 * best[0] || mean > 1.1 * best[1], "{name}");
    }
}

/// Moves that go on from each other: the drive keeps its friction level, so that none
/// starts with a jump, and a way back is no worse than a start.
#[test]
fn moves_go_on_from_each_other() {
    let machine = axis("liu2025-machine.toml");
    let limits = Limits::new(0.1, 0.225, 1.2).unwrap();
    let motion = |from: f64, to: f64| NamedMotion {
        name: format!("{from} to {to}"),
        learned: None,
        motion: Arc::new(SCurve::plan(from, to, &limits).unwrap()),
    };
    let motions = [motion(0.6, 0.9), motion(0.9, 1.2), motion(1.2, 0.6)];
    let closed_loop = ClosedLoop::new(&machine).unwrap();
    let run = |name: &str| -> Vec<f64> {
        let kind = named(STRATEGIES, name).unwrap_or(&axis_pipeline::strategies::NONE);
        let mut strategy = kind.strategy(&Predictors::of(&machine)).unwrap();
        let mut moves = Moves::new(&closed_loop, |_: &mut Measured| ());
        let make = |m| moves.make(&mut *strategy, m).unwrap().figures.max;
        motions.iter().map(make).collect()
    };
    let (none, terms) = (run("none"), run("drive_terms"));
    for (none, terms) in none.iter().zip(&terms) {
        assert!(*terms < 0.5 * none, "{none} {terms}");
    }
}

/// Lead error and cogging of the axis file's effects come into the tables.
#[test]
fn effects_that_depend_on_position_are_tabled() {
    let plain = axis("liu2025.toml");
    assert_eq!(over_turn(&plain, &plain.position_errors().unwrap()), None);
    let mut with = plain.clone();
    let effect = |name, values: Vec<f64>| ActiveEffect {
        effect: Effect::named(name).unwrap(),
        values,
    };
    with.effects = vec![
        effect("lead-error", vec![1e-4]),
        effect("periodic-lead-error", vec![2e-6, 0.0]),
        effect("cogging-torque", vec![0.05, 8.0, 0.0]),
    ];
    let errors = with.position_errors().unwrap();
    let table = over_position(&with, &of_axis(&with).unwrap(), &errors);
    for row in &table.rows {
        assert!((row[1] - 1e-4 * (row[0] - 0.6)).abs() < 1e-12, "{row:?}");
    }
    let turn = over_turn(&with, &errors).unwrap();
    for row in &turn.rows {
        assert!(
            (row[1] - 0.05 * (8.0 * row[0]).sin()).abs() < 1e-12,
            "{row:?}"
        );
        assert!((row[2] - 2e-6 * row[0].sin()).abs() < 1e-12, "{row:?}");
    }
}

/// Parameters of makers with the values of the paper's axis, by hand: k_p = 0.0678 A/rpm at 1.641 N·m/A, T_n = 0.0678/0.7122 s,
/// Kv = 46.7/s.
#[test]
fn parameters_of_drives_have_their_units() {
    let liu = axis("liu2025.toml");
    let list = terms(&liu, &of_axis(&liu).unwrap());
    let entered = |list: &[Term], term: &str, drive: &str| {
        let term = list.iter().find(|t| t.name == term).unwrap();
        let all = &term.parameters;
        all.iter()
            .find(|p| p.drive == drive)
            .map(|p| (p.parameter, p.value, p.unit))
    };
    let gain = 0.0678 * 30.0 / PI * 1.641;
    let time = 0.0678 / 0.7122;
    // 280.2 rpm per mm, 10 mm a turn.
    let kv = 280.2 / 60.0 * 10.0;
    for (term, drive, parameter, value, unit) in [
        ("speed_gain", "SINAMICS S120", "p1460", gain, None),
        (
            "speed_gain",
            "SINAMICS S210",
            "p1460",
            gain,
            Some("N·m·s/rad"),
        ),
        (
            "speed_integral_time",
            "SINAMICS S210",
            "p1462",
            1e3 * time,
            Some("ms"),
        ),
        ("speed_integral_time", "AX8000", "3140:02", time, Some("s")),
        (
            "position_gain",
            "SINUMERIK 840D",
            "MD32200",
            0.06 * kv,
            Some("1000/min"),
        ),
        (
            "position_gain",
            "TwinCAT CNC",
            "P-AXIS-00099",
            100.0 * kv,
            Some("0.01/s"),
        ),
        ("current_q_gain", "AX5000", "S-0-0106", 8.805, Some("V/A")),
    ] {
        let (number, found, in_unit) = entered(&list, term, drive).unwrap();
        let found = found.unwrap();
        assert_eq!((number, in_unit), (parameter, unit), "{term} {drive}");
        assert!(
            (found / value - 1.0).abs() < 1e-9,
            "{term} {drive}: {found} {value}"
        );
    }
    let (number, value, _) = entered(&list, "inertia_total", "SINAMICS S210").unwrap();
    assert_eq!((number, value), ("p1498", None));
    // A linear motor has no torque, and its speed gain is no parameter of a motor that turns.
    let linear = axis("linear-motor.toml");
    let list = terms(&linear, &of_axis(&linear).unwrap());
    assert!(entered(&list, "speed_gain", "SINAMICS S210").is_none());
    assert!(entered(&list, "speed_integral_time", "SINAMICS S210").is_some());
    // A low pass of 100 Hz is a smoothing time of 1/(2π 100 Hz).
    let mut slow = liu.clone();
    slow.control
        .change(|own| own.set("speed_lowpass", 100.0))
        .unwrap();
    let list = gain_terms(&slow);
    let (_, value, _) = entered(&list, "speed_lowpass", "SINAMICS S210").unwrap();
    assert!((value.unwrap() - 1.591549).abs() < 1e-5);
}
