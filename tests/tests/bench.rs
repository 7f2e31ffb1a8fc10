//! A bench that never rests, simulated by code that shares none with the library, and a file that
//! knows its inertia alone.

use axis_sim::Axis;
use discrepancy::{Discovery, Evidence, Settings, Verdict};
use independent_axis::{BenchFriction, Random, bench_log};

use crate::slide::as_log;

/// The way on which friction comes on is a guess, a hundred times too long.
const FILE: &str = r#"
schema = 2
name = "bench"

[mechanism]
kind = "torque-motor"
table_inertia_kg_m2 = 0.02

[actuator]
kind = "torque-source"
torque_limit_n_m = 20
bandwidth_hz = 1000

[friction]
kind = "coulomb-rotary"
viscous_n_m_s_per_rad = 0
coulomb_n_m = 0
presliding_rad = 0.001

[stroke]
minimum_rad = -10
maximum_rad = 10
start_rad = 0

[tolerances]
table_inertia = "20 %"
"#;

fn found(friction: &BenchFriction) -> Discovery {
    let machine = Axis::parse("bench.toml", FILE).unwrap();
    let log = |seed: u64, pace: f64| {
        let table = bench_log(friction, pace, &mut Random::new(seed, 2));
        vec![(format!("log {seed}"), as_log(&table), 2e-3)]
    };
    let evidence = Evidence::new(&machine, log(1, 1.0), log(2, 0.7), log(3, 1.2)).unwrap();
    let found = evidence.discover(&machine, &Settings::default(), |_| {});
    let told = found.unwrap().1.discovery;
    println!("{}", told.sentence);
    assert_eq!(told.verdict, Verdict::Explained, "{}", told.sentence);
    told
}

/// What is named and its numbers, by the names.
fn named(told: &Discovery) -> Vec<(&str, Vec<f64>)> {
    let effects = told.effects.iter();
    let mut all: Vec<(&str, Vec<f64>)> = effects
        .map(|e| (&*e.name, e.parameters.iter().map(|p| p.value).collect()))
        .collect();
    all.sort_by(|a, b| a.0.cmp(b.0));
    all
}

fn near(found: &[f64], expected: &[f64], within: f64) -> bool {
    let off = |(found, expected): (&f64, &f64)| (found / expected - 1.0).abs();
    found.len() == expected.len() && found.iter().zip(expected).map(off).all(|off| off < within)
}

/// Friction that comes on sooner than the file says has no memory: it was slip with a memory that
/// takes up no way, and viscous friction that the form of the dry one had made up for was not named.
#[test]
fn dry_and_viscous_friction_are_named_whatever_the_file_says_of_their_onset() {
    for (dry, name, levels) in [
        ([0.5, 0.5], "coulomb-friction", &[0.5][..]),
        ([0.6, 0.4], "asymmetric-friction", &[0.6, 0.4]),
    ] {
        let told = found(&BenchFriction { dry, viscous: 0.02 });
        let named = named(&told);
        let [(first, dry), ("viscous-friction", viscous)] = named.as_slice() else {
            panic!("{}", told.sentence);
        };
        assert_eq!(*first, name, "{}", told.sentence);
        println!("{named:?}");
        assert!(near(dry, levels, 0.01), "{named:?}");
        // The form of the dry friction takes up some of it.
        assert!(near(viscous, &[0.02], 0.1), "{named:?}");
    }
}
