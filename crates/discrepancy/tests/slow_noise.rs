//! Slow noise that a recorder adds to a drive's command, which nothing moves by.

use axis_log::{Channel, Log};
use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, ClosedLoop, Measured, Recorder};
use compensator::NoCompensation;
use discrepancy::logs::NamedLog;
use discrepancy::{Discovery, Evidence, Settings, Verdict};
use trajectories::{Limits, Program, Step};

/// RMS of the recorder's noise, N·m: a quarter of the dry friction at the motor.
const NOISE: f64 = 0.07;

/// Numbers of mean 0 and variance 1, nearly normal, from a congruence.
fn white(seed: u64) -> impl FnMut() -> f64 {
    let mut state = 2 * seed + 1;
    move || {
        let mut sum = -6.0;
        for _ in 0..12 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            sum += (state >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum
    }
}

/// The same, each following the one before by 0.9.
fn slow(seed: u64) -> impl FnMut() -> f64 {
    let (mut next, mut value) = (white(seed), 0.0);
    move || {
        value = 0.9 * value + f64::sqrt(1.0 - 0.81) * next();
        value
    }
}

/// A rack there and back, as a recorder at 1 kHz shows it.
fn recorded(machine: &Axis, name: &str, [by, speed]: [f64; 2], seed: u64) -> NamedLog {
    let from = machine.stroke.start;
    let rest = Step::Dwell { duration: 0.4 };
    let limits = |speed: f64| Limits::new(speed, 3.0, 30.0).unwrap();
    let to = |to: f64, speed: f64| Step::Move {
        to,
        limits: limits(speed),
    };
    let steps = vec![
        rest,
        to(from + by, speed),
        rest,
        to(from, 0.4 * speed),
        rest,
    ];
    let mut recorder = Recorder::new(machine);
    let mut normal = white(100 + seed);
    // 10 nm and 2 µrad, which the loop sees as well.
    let sense = |seen: &mut Measured| {
        seen.position += 1e-8 * normal();
        seen.motor_angle += 2e-6 * normal();
    };
    ClosedLoop::new(machine)
        .unwrap()
        .run_sensed(
            &Program::new(from, steps).unwrap(),
            &mut NoCompensation,
            sense,
            |c| recorder.push(c),
        )
        .completed()
        .unwrap();
    let log = recorder.log().unwrap();
    let every = 8;
    let mut noise = slow(seed);
    let shown = |c: &Channel| {
        let samples = c.samples.iter().step_by(every);
        let samples = match c.name == "torque_ref_n_m" {
            true => samples.map(|v| v + NOISE * noise()).collect(),
            false => samples.copied().collect(),
        };
        Channel::new(c.name.clone(), samples).unwrap()
    };
    let channels: Vec<Channel> = log.channels().iter().map(shown).collect();
    let period = every as f64 * machine.period;
    (name.to_owned(), Log::new(channels).unwrap(), period)
}

/// What is found in a rack without sensors' errors in which this is hidden.
fn discovered(hidden: &[(&str, f64)]) -> Discovery {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/rack.toml");
    let text = std::fs::read_to_string(file).unwrap();
    let (before, after) = text.split_once("[sensors.load]").unwrap();
    let (_, after) = after.split_once("[stroke]").unwrap();
    let machine = Axis::parse("rack.toml", &format!("{before}[stroke]{after}")).unwrap();
    let mut real = machine.clone();
    real.effects
        .extend(hidden.iter().map(|(name, size)| ActiveEffect {
            effect: Effect::named(name).unwrap(),
            values: vec![*size],
        }));
    let fit = vec![recorded(&real, "fit.csv", [0.5, 1.0], 3)];
    let check = vec![recorded(&real, "check.csv", [0.4, 0.7], 4)];
    let evidence = Evidence::new(&machine, fit, check, Vec::new()).unwrap();
    let settings = Settings::default();
    let (_, found) = evidence.discover(&machine, &settings, |_| ()).unwrap();
    let found = found.discovery;
    println!("{} {:?} {:?}", found.sentence, found.notes, found.gap);
    found
}

fn names_the_recorder(found: &Discovery) -> bool {
    let mut notes = found.notes.iter();
    notes.any(|note| note.starts_with("torque_ref_n_m: ") && note.contains("logger"))
}

/// It was "unknown"; and its mean over the standstill began the replay with friction that held a sixth of its level.
#[test]
fn slow_noise_of_a_recorded_command_is_no_lack() {
    let found = discovered(&[]);
    assert_eq!(found.verdict, Verdict::NothingMissing, "{}", found.sentence);
    assert!(names_the_recorder(&found), "{:?}", found.notes);
}

/// What moves the axis is no noise, though the command shows less of it than of its noise.
#[test]
fn friction_beside_slow_noise_of_the_command_is_named() {
    let found = discovered(&[("coulomb-friction", 10.0)]);
    assert_eq!(found.verdict, Verdict::Explained, "{}", found.sentence);
    let [friction] = &found.effects[..] else {
        panic!("{}", found.sentence);
    };
    assert_eq!(friction.name, "coulomb-friction");
    let [low, high] = friction.parameters[0].ci95;
    assert!(
        (low..=high).contains(&10.0) && high - low < 3.0,
        "{low} to {high}"
    );
}
