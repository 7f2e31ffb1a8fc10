//! Moves one after the other: what a strategy keeps from one to the next.

use std::path::PathBuf;
use std::sync::Arc;

use axis_pipeline::moves::{MoveRun, Moves, NamedMotion};
use axis_pipeline::strategies::{Predictors, STRATEGIES, SharedMotion, named};
use axis_sim::{Axis, ClosedLoop, Measured};
use trajectories::{Limits, Program, Sine, Step};

fn text(name: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../data/axes");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

fn named_motion(motion: SharedMotion) -> NamedMotion {
    NamedMotion {
        name: String::new(),
        motion,
        learned: None,
    }
}

/// The runs of moves under a strategy that assumes the axis of `predictors`.
fn made(
    predictors: &Predictors,
    machine: &Axis,
    strategy: &str,
    moves: &[NamedMotion],
) -> Vec<MoveRun> {
    let kind = named(STRATEGIES, strategy).unwrap();
    let mut strategy = kind.strategy(predictors).unwrap();
    let closed_loop = ClosedLoop::new(machine).unwrap();
    let mut rig = Moves::new(&closed_loop, |_: &mut Measured| ());
    let run = |motion| rig.make(&mut *strategy, motion).unwrap();
    moves.iter().map(run).collect()
}

/// An axis whose position loop is closed at the motor is homed once. After a move friction leaves
/// the transmission wound up, one way or the other, by some micrometres: a plan that took each
/// move's start for home led the load by that much past it.
#[test]
fn an_axis_that_is_homed_at_its_motor_stays_homed() {
    const KV: &str = "velocity_feedforward = 1.0";
    let content = text("screw-datasheet.toml");
    let with_motor = content.replacen(KV, &format!("{KV}\nfeedback = \"motor\""), 1);
    assert_ne!(with_motor, content);
    let axis = Axis::parse("screw-datasheet.toml", &with_motor).unwrap();
    let limits = Limits::new(0.1, 1.0, 20.0).unwrap();
    // At rest in between: only a standstill tells what it takes to hold the axis.
    let to = |from: f64, to: f64| {
        let steps = vec![Step::Move { to, limits }, Step::Dwell { duration: 0.3 }];
        named_motion(Arc::new(Program::new(from, steps).unwrap()) as SharedMotion)
    };
    let moves = [
        to(0.6, 0.62),
        to(0.62, 0.6),
        to(0.6, 0.62),
        to(0.62, 0.64),
        to(0.64, 0.6),
    ];
    // The wind-up that friction leaves: F/k at the load, either way.
    let r = 0.01 / std::f64::consts::TAU;
    let lost = 2.0 * 0.6757 * r * axis.mechanism.compliance(0.62);
    assert!(lost > 5e-6, "{lost:e}");
    let predictors = Predictors::of(&axis);
    for (strategy, most, at_rest) in [("plan", 3.0, 0.3), ("drive_terms", 200.0, 2.0)] {
        let runs = made(&predictors, &axis, strategy, &moves);
        let ends = runs.iter().map(|run| 1e6 * run.errors.last().unwrap());
        let ends: Vec<f64> = ends.collect();
        let peaks: Vec<f64> = runs.iter().map(|run| run.figures.max).collect();
        let lost = 1e6 * lost;
        println!("{strategy}: peaks {peaks:.2?} µm, ends {ends:.2?} µm, lost {lost:.2} µm");
        assert!(
            peaks.iter().all(|peak| *peak < most),
            "{strategy}: {peaks:?}"
        );
        assert!(
            ends.iter().all(|end| end.abs() < at_rest),
            "{strategy}: {ends:?}"
        );
    }
}

/// A move that begins as the last one ends begins with the friction that this has left, whatever
/// command its last cycle had: that of one that ends in a step of the jerk is a third of what
/// friction holds.
#[test]
fn a_move_that_follows_at_once_knows_how_friction_was_left() {
    let machine = Axis::parse("liu2025-machine.toml", &text("liu2025-machine.toml")).unwrap();
    let limits = Limits::new(0.1, 1.0, 20.0).unwrap();
    let steps = |to: &[f64]| to.iter().map(|&to| Step::Move { to, limits }).collect();
    let motion = |from: f64, to: &[f64]| {
        named_motion(Arc::new(Program::new(from, steps(to)).unwrap()) as SharedMotion)
    };
    let predictors = Predictors::of(&machine);
    let joined = made(&predictors, &machine, "plan", &[motion(0.6, &[0.62, 0.6])]);
    let apart = [motion(0.6, &[0.62]), motion(0.62, &[0.6])];
    let apart = made(&predictors, &machine, "plan", &apart);
    let [joined, back] = [joined[0].figures.max, apart[1].figures.max];
    println!("there and back {joined:.3} µm in one program, {back:.3} µm in two");
    // 34 µm by the command.
    assert!(back < 5.0 * joined, "{joined} {back}");
}

/// Laps of a circle, one axis of it, after one another: what is learned stays learned.
#[test]
fn repeated_laps_go_down_and_stay_down() {
    let machine = Axis::parse("liu2025-machine.toml", &text("liu2025-machine.toml")).unwrap();
    let axis = Axis::parse("liu2025.toml", &text("liu2025.toml")).unwrap();
    for (amplitude, frequency) in [(0.02, 0.5), (0.05, 0.25), (0.005, 2.0), (0.01, 1.0)] {
        let lap = Program::new(
            0.6,
            vec![Step::Sine(Sine {
                amplitude,
                frequency,
                cycles: 1,
            })],
        );
        let laps = vec![named_motion(Arc::new(lap.unwrap())); 9];
        let runs = made(&Predictors::of(&axis), &machine, "iterative", &laps);
        let peaks: Vec<f64> = runs.iter().map(|run| run.figures.max).collect();
        println!("{amplitude} m, {frequency} Hz: {peaks:.3?} µm");
        // A lap begins as the one before has left the axis, so the second still finds another
        // start than the first.
        assert!(
            peaks[3..].iter().all(|peak| *peak < 0.1 * peaks[0]),
            "{peaks:?}"
        );
        let best = peaks[3..].iter().copied().fold(f64::INFINITY, f64::min);
        assert!(
            peaks[3..]
                .iter()
                .all(|peak| *peak < 0.02 * peaks[0] + 2.0 * best),
            "{peaks:?}"
        );
    }
}
