//! Fits that begin far from where D is least.

use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, ClosedLoop, Recorder};
use compensator::NoCompensation;
use discrepancy::{Fitter, LogSet, State};
use trajectories::{Limits, Program, Step};

fn warming(force: f64, distance: f64) -> ActiveEffect {
    ActiveEffect {
        effect: Effect::named("warming-friction").unwrap(),
        values: vec![force, distance],
    }
}

/// Of a friction that falls with the way, a log of less than a metre shows hardly more than the
/// slope, force over distance: the distance that is sought lies far off, and is approached in
/// steps. The force of such a step must be that which goes with it.
#[test]
fn a_size_follows_a_shape_that_moves_in_steps() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
    let machine = Axis::read(file.as_ref()).unwrap();
    let mut true_machine = machine.clone();
    true_machine.effects.push(warming(35.0, 4.3));
    let limits = Limits::new(0.1, 2.0, 50.0).unwrap();
    let rest = Step::Dwell { duration: 0.1 };
    let from = machine.stroke.start + 0.1;
    let to = |to: f64| Step::Move { to, limits };
    let turn = [rest, to(from + 0.1), rest, to(from)];
    let program = Program::new(from, turn.iter().cycle().take(4).cloned().collect()).unwrap();
    let mut recorder = Recorder::new(&true_machine);
    ClosedLoop::new(&true_machine)
        .unwrap()
        .run(&program, &mut NoCompensation, |c| recorder.push(c))
        .completed()
        .unwrap();
    let log = recorder.log().unwrap();
    let set = LogSet::new(vec![("way".to_owned(), log, machine.period)], &machine).unwrap();
    let fitter = Fitter {
        machine: &machine,
        set: &set,
    };
    let at = |force: f64, distance: f64| {
        let effects = vec![warming(force, distance)];
        let initial = State::initial(&machine);
        fitter.at(State { effects, ..initial }).unwrap()
    };
    let there = at(35.0, 4.3).deviance;
    let far = at(80.0, 20.0);
    assert!(far.deviance > there + 1e3, "{} {there}", far.deviance);
    let known = fitter.known_columns(&far);
    let found = fitter.refine(far, &known, 4);
    assert!(found.deviance < there + 30.0, "{} {there}", found.deviance);
}
