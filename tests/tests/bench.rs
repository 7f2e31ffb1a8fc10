//! A bench that never rests, simulated by code that shares none with the library, and a file that
//! knows its inertia alone.

use axis_sim::Axis;
use discrepancy::{Discovery, Evidence, Settings, Verdict};
use independent_axis::{BenchFriction, Random, bench_log};

use crate::slide::as_log;

/// Sampling period of its logs, s, and the column of their torque.
const PERIOD: f64 = 2e-3;
const TORQUE: usize = 2;

/// By how much the bench shows its torque early, s: as it begins to be held, for a control period.
const HELD: f64 = 5e-4;

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

/// What is told of logs of the bench whose torque is shown so many samples too early.
fn found(friction: &BenchFriction, early: usize) -> Discovery {
    let machine = Axis::parse("bench.toml", FILE).unwrap();
    let log = |seed: u64, pace: f64| {
        let mut table = bench_log(friction, pace, &mut Random::new(seed, 2));
        for row in 0..table.rows.len() - early {
            table.rows[row][TORQUE] = table.rows[row + early][TORQUE];
        }
        table.rows.truncate(table.rows.len() - early);
        vec![(format!("log {seed}"), as_log(&table), PERIOD)]
    };
    let evidence = Evidence::new(&machine, log(1, 1.0), log(2, 0.7), log(3, 1.2)).unwrap();
    let found = evidence.discover(&machine, &Settings::default(), |_| {});
    let told = found.unwrap().1.discovery;
    println!("{}", told.sentence);
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
        let told = found(&BenchFriction { dry, viscous: 0.02 }, 0);
        assert_eq!(told.verdict, Verdict::Explained);
        let named = named(&told);
        let [(first, dry), ("viscous-friction", viscous)] = named.as_slice() else {
            panic!("{}", told.sentence);
        };
        assert_eq!(*first, name, "{}", told.sentence);
        println!("{named:?}, {} of a sample", skew(&told));
        assert!(near(dry, levels, 0.005), "{named:?}");
        // By the time by which the torque is early alone it would be 8 % too small.
        assert!(near(viscous, &[0.02], 0.02), "{named:?}");
        assert!((skew(&told) - HELD / PERIOD).abs() < 0.06);
    }
}

/// Share of a sampling period by which the torque was found to be ahead of the motion.
fn skew(told: &Discovery) -> f64 {
    let mut known = told.recalibrated.iter();
    known.find(|k| k.name == "torque-skew").unwrap().share
}

/// What is less than half a sample is a matter of how the log was taken.
#[test]
fn a_torque_that_is_early_by_a_part_of_a_sample_is_nothing_missing() {
    let nothing = BenchFriction {
        dry: [0.0; 2],
        viscous: 0.0,
    };
    let told = found(&nothing, 0);
    assert_eq!(told.verdict, Verdict::NothingMissing);
    println!("{} of a sample", skew(&told));
    assert!((skew(&told) - HELD / PERIOD).abs() < 0.02);
}

#[test]
fn a_torque_that_is_early_by_two_samples_is_named_beside_the_friction() {
    let friction = BenchFriction {
        dry: [0.5; 2],
        viscous: 0.02,
    };
    let told = found(&friction, 2);
    assert_eq!(told.verdict, Verdict::Explained);
    let named = named(&told);
    println!("{named:?}");
    let [
        ("clock-offset", time),
        ("coulomb-friction", dry),
        ("viscous-friction", viscous),
    ] = named.as_slice()
    else {
        panic!("{}", told.sentence);
    };
    assert!(near(dry, &[0.5], 0.005) && near(viscous, &[0.02], 0.02));
    // Half a sample of it may be a matter of how the log was taken.
    let early = HELD + 2.0 * PERIOD;
    assert!(
        (time[0] + skew(&told) * PERIOD - early).abs() < 2e-4,
        "{time:?}"
    );
}
