//! The search on short logs of a simulator that shares no code with the library; the whole table is
//! `cargo xtask independent`.

use std::path::Path;

use axis_log::{Channel, Log};
use axis_sim::Axis;
use discrepancy::{Discovery, LogSet, Settings, Verdict, discovery, search};
use independent_axis::cases::named;
use independent_axis::{Motion, Parameters, Random, Rough, Table, log};

fn axis() -> Axis {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    Axis::read(&root.join("data/axes/liu2025.toml")).unwrap()
}

fn as_log(table: &Table) -> Log {
    let column = |i: usize| table.rows.iter().map(|row| row[i]).collect();
    let channel = |(i, name): (usize, &&str)| Channel::new(*name, column(i)).unwrap();
    Log::new(table.names.iter().enumerate().map(channel).collect()).unwrap()
}

/// There and back with a rest between, at two speeds.
fn motion(start: f64, way: f64, speed: f64) -> Motion {
    Motion::from(start)
        .rest(0.2)
        .by(way, speed, 0.25)
        .rest(0.2)
        .by(-way, 0.7 * speed, 0.25)
        .rest(0.2)
        .by(0.1 * way, 0.2 * speed, 0.15)
        .rest(0.2)
}

fn discovered(case: &str) -> Discovery {
    let (axis, case) = (axis(), named(case).unwrap());
    let set = |name: &str, motion: &Motion, seed: u64| {
        let (p, mut random) = (Parameters::paper(), Random::new(seed, case.stream));
        let table = log(&p, case, Rough::default(), motion, &mut random).unwrap();
        LogSet::new(vec![(name.to_owned(), as_log(&table), 1e-3)], &axis).unwrap()
    };
    let fit = set("fit", &motion(0.6, 0.12, 0.1), 1);
    let check = set("check", &motion(0.66, -0.1, 0.12), 2);
    let found = search(&axis, &fit, &check, &Settings::default(), |_| {}).unwrap();
    discovery(&axis, &fit, &check, &found).unwrap().discovery
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    let told = discovered("loop-nothing");
    assert_eq!(told.verdict, Verdict::NothingMissing, "{}", told.sentence);
    assert!(told.effects.is_empty());
}

#[test]
fn viscous_friction_is_named_with_its_size() {
    let told = discovered("loop-viscous");
    assert_eq!(told.verdict, Verdict::Explained, "{}", told.sentence);
    let names: Vec<&str> = told.effects.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["viscous-friction"]);
    let size = &told.effects[0].parameters[0];
    let [low, high] = size.ci95;
    assert!((low..=high).contains(&5000.0), "{low} to {high}");
}
