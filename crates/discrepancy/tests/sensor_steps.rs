//! The steps of sensors in a stiff loop change the torque with which it holds.

use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, ClosedLoop, Recorder};
use compensator::NoCompensation;
use discrepancy::logs::NamedLog;
use discrepancy::{Discovery, Evidence, Settings, Verdict};
use trajectories::{Limits, Program, Step};

/// Moves of the rack with tuned gains, by its own simulation with the noise and the steps of its sensors.
fn tuned_rack(machine: &Axis, name: &str, moves: [f64; 3], seed: u64) -> NamedLog {
    let mut at = machine.stroke.start;
    let rest = Step::Dwell { duration: 0.4 };
    let mut steps = vec![rest];
    for (by, speed) in moves.into_iter().zip([1.0, 0.1, 0.6]) {
        at += by;
        let limits = Limits::new(speed, 3.0, 30.0).unwrap();
        steps.extend([Step::Move { to: at, limits }, rest]);
    }
    let program = Program::new(machine.stroke.start, steps).unwrap();
    let mut recorder = Recorder::new(machine);
    ClosedLoop::new(machine)
        .unwrap()
        .with_seed(seed)
        .run(&program, &mut NoCompensation, |c| recorder.push(c))
        .completed()
        .unwrap();
    (name.to_owned(), recorder.log().unwrap(), machine.period)
}

/// What is found in a rack with tuned gains on which this load (N) acts.
fn discovered(load: f64) -> Discovery {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../data/axes/tuned/rack.toml"
    );
    let machine = Axis::read(file.as_ref()).unwrap();
    let mut loaded = machine.clone();
    if load != 0.0 {
        loaded.effects.push(ActiveEffect {
            effect: Effect::named("constant-load").unwrap(),
            values: vec![load],
        });
    }
    let fit = vec![tuned_rack(&loaded, "fit.csv", [0.3, 0.02, -0.25], 21)];
    let check = vec![tuned_rack(&loaded, "check.csv", [-0.2, 0.03, 0.15], 22)];
    let evidence = Evidence::new(&machine, fit, check, Vec::new()).unwrap();
    let settings = Settings::default();
    let (_, discovered) = evidence.discover(&machine, &settings, |_| ()).unwrap();
    println!("{}", discovered.discovery.sentence);
    discovered.discovery
}

/// Before the steps were in the model, a clean rack had a gap that no effect explains.
#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn a_clean_axis_with_tuned_gains_lacks_nothing() {
    assert_eq!(discovered(0.0).verdict, Verdict::NothingMissing);
}

/// Before the steps were in the noise that a residual is compared with, a load was explained in part only.
#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn a_load_on_an_axis_with_tuned_gains_is_explained() {
    let found = discovered(40.0);
    assert_eq!(found.verdict, Verdict::Explained);
    let [load] = &found.effects[..] else {
        panic!("{}", found.sentence);
    };
    assert_eq!(load.name, "constant-load");
    let force = &load.parameters[0];
    let [from, to] = force.ci95;
    assert!((from..=to).contains(&40.0) && to - from < 2.0, "{force:?}");
}
