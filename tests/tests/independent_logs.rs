//! The search on short logs of a simulator that shares no code with the library; the whole table is
//! `cargo xtask independent`.

use std::path::Path;

use axis_log::{Channel, Log};
use axis_sim::Axis;
use discrepancy::{Discovery, LogSet, Settings, State, Verdict, discovery, search};
use independent_axis::cases::named;
use independent_axis::{
    Columns, Hidden, Logger, LoopNoise, Motion, Parameters, Random, Rough, Table, exercises, log,
    run,
};
use nalgebra::Complex;

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
    discovered_on(axis(), case)
}

fn discovered_on(axis: Axis, case: &str) -> Discovery {
    discovered_in(axis, case, 1.0)
}

/// With the current of the logs in another unit, or with another sign.
fn discovered_in(axis: Axis, case: &str, current: f64) -> Discovery {
    let case = named(case).unwrap();
    let set = |name: &str, motion: &Motion, seed: u64| {
        let (p, mut random) = (Parameters::paper(), Random::new(seed, case.stream));
        let table = log(&p, case, Rough::default(), motion, &mut random).unwrap();
        let scaled = |c: &Channel| {
            let by = if c.name == "iq_a" { current } else { 1.0 };
            let samples = c.samples.iter().map(|v| by * v).collect();
            Channel::new(c.name.clone(), samples).unwrap()
        };
        let log = as_log(&table);
        let log = Log::new(log.channels().iter().map(scaled).collect()).unwrap();
        LogSet::new(vec![(name.to_owned(), log, 1e-3)], &axis).unwrap()
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

/// Without a controller, what lies between motor and load is seen where both are measured, and nothing is
/// named where there is nothing.
#[test]
fn what_lies_between_motor_and_load_is_named_by_balance() {
    let balanced = |case: &str| discovered_on(axis().without_control().unwrap(), case);
    let nothing = balanced("loop-nothing");
    assert_eq!(
        nothing.verdict,
        Verdict::NothingMissing,
        "{}",
        nothing.sentence
    );
    for (case, name, truth) in [
        ("loop-backlash", "backlash", 8e-6),
        ("loop-lead", "periodic-lead-error", 3e-6),
        ("loop-thermal", "thermal-expansion", 6e-5),
    ] {
        let told = balanced(case);
        let names: Vec<&str> = told.effects.iter().map(|e| e.name.as_str()).collect();
        assert_eq!(names, [name], "{}", told.sentence);
        let asks = |note: &String| note.contains(CHECK_THE_CURRENT);
        assert!(!told.notes.iter().any(asks), "{:?}", told.notes);
        let [low, high] = told.effects[0].parameters[0].ci95;
        assert!((low..=high).contains(&truth), "{case}: {low} to {high}");
        // A gap takes some milliseconds to cross, and is taken to be crossed at once.
        let reduction = told.gap.check.reduction;
        assert!(reduction > 0.9, "{case}: {reduction}");
        let is_explained = told.verdict == Verdict::Explained;
        assert!(is_explained || name == "backlash", "{}", told.sentence);
    }
}

/// What says that a current may be in another unit or of another sign.
const CHECK_THE_CURRENT: &str = "check the column's unit, factor and sign";

/// A current in mA, or counted the other way, is no machine.
#[test]
fn a_current_in_another_unit_or_direction_is_said() {
    for current in [-1.0, 1e-3] {
        let told = discovered_in(axis().without_control().unwrap(), "loop-viscous", current);
        let mut notes = told.notes.iter();
        assert!(
            notes.any(|note| note.contains(CHECK_THE_CURRENT)),
            "{current}: {:?} {}",
            told.notes,
            told.sentence
        );
    }
}

/// By balance as well: what two simulations of one machine make of torque and transmission error. Measured:
/// 4e-4 of the torque's, where the one is slow motion, and 6e-5 of the transmission error's.
#[test]
fn two_simulations_of_one_machine_balance_alike() {
    let axis = axis().without_control().unwrap();
    let (set, rest) = quiet_on(&axis, &motion(0.6, 0.12, 0.1));
    let about_the_mean = |all: &[f64]| {
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        (all.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / all.len() as f64).sqrt()
    };
    assert_eq!(set.channels, ["iq_a", "transmission_error_m"]);
    for (c, most) in [8e-4, 1.5e-4].into_iter().enumerate() {
        let [rest, all] =
            [&rest[0][c], &set.logs[0].measured[c]].map(|series| about_the_mean(series));
        println!("{}: {:.1e}", set.channels[c], rest / all);
        assert!(rest < most * all, "{}: {}", set.channels[c], rest / all);
    }
}

/// A log of the second simulator without any noise, nothing hidden, compared with this one.
fn quiet(motion: &Motion) -> (LogSet, Rest) {
    quiet_on(&axis(), motion)
}

fn quiet_on(axis: &Axis, motion: &Motion) -> (LogSet, Rest) {
    let (p, mut random) = (Parameters::paper(), Random::new(1, 1));
    let mut samples = Vec::new();
    let (hidden, none) = (Hidden::default(), LoopNoise::default());
    run((&p, &hidden), motion, (&none, &mut random), |s| {
        samples.push(*s)
    })
    .unwrap();
    let table = Logger::default().log(&samples, Columns::All, &mut random);
    let set = LogSet::new(vec![("quiet".to_owned(), as_log(&table), 1e-3)], axis).unwrap();
    let rest = set.rest(&set.simulate(axis, &State::initial(axis)).unwrap());
    (set, rest)
}

/// Series per log and channel.
type Rest = Vec<Vec<Vec<f64>>>;

/// What a channel shows of the dynamics: the tracking error, or departures from the mean.
fn dynamics(set: &LogSet, channel: usize) -> Vec<f64> {
    let (log, measured) = (&set.logs[0], &set.logs[0].measured[channel]);
    let mean = measured.iter().sum::<f64>() / measured.len() as f64;
    match set.channels[channel] {
        "position_m" => {
            let reference = log.log.channel("position_ref_m").unwrap();
            reference.iter().zip(measured).map(|(r, p)| r - p).collect()
        }
        _ => measured.iter().map(|v| v - mean).collect(),
    }
}

/// The search takes simulations for exact to 3e-4 of this.
#[test]
fn two_simulations_of_one_machine_differ_by_little() {
    let (set, rest) = quiet(&motion(0.6, 0.12, 0.1));
    let rms = |all: &[f64]| (all.iter().map(|v| v * v).sum::<f64>() / all.len() as f64).sqrt();
    for (c, name) in set.channels.iter().enumerate() {
        let share = rms(&rest[0][c]) / rms(&dynamics(&set, c));
        println!("{name}: {share:.1e}");
        assert!(share < 1e-5, "{name}: {share}");
    }
}

/// Intervals take simulations for exact to 1.5e-4 of this, with any phase, band by band.
#[test]
fn under_a_chirp_two_simulations_differ_by_little_in_each_band() {
    let [(_, motion), ..] = exercises();
    let (set, rest) = quiet(&motion);
    let shown = (0..set.channels.len()).map(|c| dynamics(&set, c)).collect();
    let (rest, shown) = (set.amplitudes(&rest), set.amplitudes(&[shown]));
    for (band, (edges, _)) in set
        .layout
        .bands()
        .enumerate()
        .filter(|(_, b)| b.0[1] < 130.0)
    {
        for (c, &channel) in set.fitted.iter().enumerate() {
            let power = |of: &Vec<Vec<_>>| -> f64 {
                let bins = set.layout.bins_of(band, of);
                bins.map(|bin: &[Complex<f64>]| bin[c].norm_sqr()).sum()
            };
            let name = set.channels[channel];
            let share = (power(&rest) / power(&shown)).sqrt();
            println!("{name} {edges:.0?} Hz: {share:.1e}");
            if ["iq_ref_a", "iq_a", "uq_v"].contains(&name) {
                assert!(share < 1.5e-4, "{name} {edges:?} Hz: {share}");
            }
        }
    }
}
