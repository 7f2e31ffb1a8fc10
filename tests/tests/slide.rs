//! A slide on a linear motor, simulated by code that shares none with the library, whose drive
//! low-passes its speed and commands late, which its axis file does not say.

use std::path::Path;

use axis_log::{Channel, Log};
use axis_sim::Axis;
use discrepancy::controller::better_than_own;
use discrepancy::logs::NamedLog;
use discrepancy::{Discovery, Evidence, Settings, Verdict};
use independent_axis::{Motion, Random, SlideDrive, SlideHidden, Table, slide_log};

const DRIVE: SlideDrive = SlideDrive {
    speed_lowpass: Some(500.0),
    late: true,
};
const RIPPLE: SlideHidden = SlideHidden {
    ripple: [9.0, 0.024, 0.7],
    cable: 0.0,
};

fn axis() -> Axis {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    Axis::read(&root.join("data/axes/linear-motor.toml")).unwrap()
}

fn as_log(table: &Table) -> Log {
    let column = |i: usize| table.rows.iter().map(|row| row[i]).collect();
    let channel = |(i, name): (usize, &&str)| Channel::new(*name, column(i)).unwrap();
    Log::new(table.names.iter().enumerate().map(channel).collect()).unwrap()
}

/// A log to fit and one to check.
fn logs(hidden: &SlideHidden) -> [Vec<NamedLog>; 2] {
    let there = |start: f64, way: f64, speed: f64| {
        Motion::from(start)
            .rest(0.25)
            .by(way, speed, 0.08)
            .rest(0.25)
            .by(-0.7 * way, 0.3 * speed, 0.1)
            .rest(0.25)
            .by(-0.2 * way, 0.05 * speed, 0.05)
            .rest(0.25)
    };
    let motions = [there(0.1, 0.4, 1.0), there(0.55, -0.3, 0.7)];
    let mut seed = 0;
    motions.map(|motion| {
        seed += 1;
        let table = slide_log(&DRIVE, hidden, &motion, &mut Random::new(seed, 1));
        vec![(format!("log {seed}"), as_log(&table), 5e-4)]
    })
}

/// What is found by torque balance.
fn balanced(hidden: &SlideHidden) -> Discovery {
    let machine = axis().without_control().unwrap();
    let [fit, check] = logs(hidden);
    let evidence = Evidence::new(&machine, fit, check, Vec::new()).unwrap();
    let found = evidence.discover(&machine, &Settings::default(), |_| {});
    found.unwrap().1.discovery
}

/// The only name, and whether its size is inside its interval.
fn only<'a>(told: &'a Discovery, size: &str, truth: f64) -> (&'a str, bool) {
    assert_eq!(told.verdict, Verdict::Explained, "{}", told.sentence);
    assert_eq!(told.effects.len(), 1, "{}", told.sentence);
    let effect = &told.effects[0];
    let mut sizes = effect.parameters.iter().filter(|p| p.name == size);
    // An amplitude below zero is one above, half a turn on.
    let inside = sizes.any(|p| {
        let holds = |value: f64| (p.ci95[0]..=p.ci95[1]).contains(&value);
        holds(truth) || holds(-truth)
    });
    (&effect.name, inside)
}

#[test]
fn forces_are_named_by_balance_whatever_the_drive_does() {
    let told = balanced(&SlideHidden::default());
    assert_eq!(told.verdict, Verdict::NothingMissing, "{}", told.sentence);
    let told = balanced(&RIPPLE);
    assert_eq!(only(&told, "amplitude", 9.0), ("force-ripple", true));
    let cable = SlideHidden {
        cable: 60.0,
        ..SlideHidden::default()
    };
    let told = balanced(&cable);
    assert_eq!(only(&told, "stiffness", 60.0), ("spring-force", true));
}

/// What the file's controller does not give, one with a low pass of the speed does, whatever the
/// machine hides.
#[test]
fn a_drive_with_more_in_it_than_its_file_is_told_from_its_commands() {
    let machine = axis();
    for hidden in [SlideHidden::default(), RIPPLE] {
        let [fit, check] = logs(&hidden);
        let other = better_than_own(&machine, &fit, &check).unwrap();
        assert!(other.better.contains("speed_lowpass"), "{other:?}");
        assert!(other.better_left < 1e-4 * other.left, "{other:?}");
    }
}
