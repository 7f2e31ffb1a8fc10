//! Moves one after the other: what a strategy keeps from one to the next.

use std::path::PathBuf;
use std::sync::Arc;

use axis_pipeline::moves::{MoveRun, Moves, NamedMotion};
use axis_pipeline::strategies::{Predictors, STRATEGIES, SharedMotion, named};
use axis_sim::{Axis, ClosedLoop, Measured};
use trajectories::{Limits, Program, SCurve, Sine, Step};

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

/// The runs of moves under a strategy that believes the axis of `predictors`.
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
    let to = |from: f64, to: f64| {
        named_motion(Arc::new(SCurve::plan(from, to, &limits).unwrap()) as SharedMotion)
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
    for (strategy, most) in [("plan", 2e-6), ("drive_terms", 4e-6)] {
        let runs = made(&predictors, &axis, strategy, &moves);
        let ends: Vec<f64> = runs
            .iter()
            .map(|run| 1e6 * run.errors.last().unwrap())
            .collect();
        let peaks: Vec<f64> = runs.iter().map(|run| run.figures.max).collect();
        println!(
            "{strategy}: ends {ends:.3?} µm, peaks {peaks:.3?} µm, lost {:.2} µm",
            1e6 * lost
        );
        for (k, peak) in peaks.iter().enumerate() {
            assert!(*peak < 1e6 * most, "{strategy}, move {}: {peak} µm", k + 1);
        }
    }
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
        for run in &runs {
            println!("{:.3} {:?}", run.figures.max, run.learned);
        }
        let peaks: Vec<f64> = runs.iter().map(|run| run.figures.max).collect();
        println!("{amplitude} m, {frequency} Hz: {peaks:.3?} µm");
    }
}
