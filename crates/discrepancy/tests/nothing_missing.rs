//! That nothing is missing has to hold of every log.

use std::f64::consts::TAU;

use axis_log::{Channel, Log};
use axis_sim::Axis;
use discrepancy::logs::NamedLog;
use discrepancy::{Discovery, Evidence, Settings, Verdict};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

const INERTIA: f64 = 0.3;
const DRY: f64 = 1.0;

/// What a torque has beside the model's: of time and angle, N·m, and the deviation of its noise.
#[derive(Clone, Copy)]
struct Beside {
    torque: fn(f64, f64) -> f64,
    noise: f64,
}

/// A motion of two frequencies, Hz, that goes both ways.
fn log(name: &str, frequencies: [f64; 2], beside: Beside, seed: u64) -> NamedLog {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let times: Vec<f64> = (0..8000).map(|k| 1e-3 * f64::from(k)).collect();
    let sum = |t: f64, power: i32, of: fn(f64) -> f64| -> f64 {
        let one = |f: f64| (TAU * f).powi(power) * of(TAU * f * t) / f;
        frequencies.into_iter().map(one).sum()
    };
    let torque = |t: &f64| {
        let noise: f64 = StandardNormal.sample(&mut random);
        let own = -INERTIA * sum(*t, 2, f64::sin) + DRY * sum(*t, 1, f64::cos).signum();
        own + (beside.torque)(*t, sum(*t, 0, f64::sin)) + beside.noise * noise
    };
    let torques = times.iter().map(torque).collect();
    let mut random = ChaCha8Rng::seed_from_u64(seed + 100);
    let angle = |t: &f64| {
        let noise: f64 = StandardNormal.sample(&mut random);
        sum(*t, 0, f64::sin) + 1e-7 * noise
    };
    let angles = times.iter().map(angle).collect();
    let channel = |name: &str, samples: Vec<f64>| Channel::new(name, samples).unwrap();
    let log = Log::new(vec![
        channel("t_s", times),
        channel("position_rad", angles),
        channel("torque_n_m", torques),
    ]);
    (name.to_owned(), log.unwrap(), 1e-3)
}

/// What is found of a fitted and a check log.
fn discover([fitted, checked]: [Beside; 2]) -> Discovery {
    let text = format!(
        "schema = 2\nname = \"bench\"\n[mechanism]\nkind = \"torque-motor\"\ntable_inertia_kg_m2 = {INERTIA}\n[actuator]\nkind = \"torque-source\"\ntorque_limit_n_m = 1000\nbandwidth_hz = 1e6\n[friction]\nkind = \"coulomb-rotary\"\nviscous_n_m_s_per_rad = 0\ncoulomb_n_m = {DRY}\npresliding_rad = 1e-4\n[stroke]\nminimum_rad = -100\nmaximum_rad = 100\nstart_rad = 0\n"
    );
    let machine = Axis::parse("bench.toml", &text).unwrap();
    let fit = vec![log("fit.csv", [0.4, 1.1], fitted, 1)];
    let check = vec![log("check.csv", [0.3, 0.9], checked, 2)];
    let evidence = Evidence::new(&machine, fit, check, Vec::new()).unwrap();
    let (_, discovered) = evidence
        .discover(&machine, &Settings::default(), |_| ())
        .unwrap();
    let discovery = discovered.discovery;
    println!(
        "{}\n{:?}\n{:?}",
        discovery.sentence, discovery.notes, discovery.gap
    );
    discovery
}

const fn beside(torque: fn(f64, f64) -> f64, noise: f64) -> Beside {
    Beside { torque, noise }
}

const NOISY: f64 = 0.2;
/// Of the torque, 10 N·m RMS, 5e-4.
const QUIET: f64 = 0.005;

/// What is in the fitted log alone holds on no other, and has no name; but it is there, however quiet the check log is.
#[test]
fn what_only_a_fitted_log_shows_is_not_nothing() {
    let wave = |t: f64, _| (TAU * 0.7 * t + 1.0).sin();
    for noise in [NOISY, QUIET] {
        let clean = beside(|_, _| 0.0, noise);
        assert_eq!(discover([clean, clean]).verdict, Verdict::NothingMissing);
        let discovery = discover([beside(wave, noise), clean]);
        assert_eq!(discovery.verdict, Verdict::Unknown);
        let mut notes = discovery.notes.iter();
        let note = notes.find(|note| note.contains("times its noise"));
        assert!(
            note.is_some_and(|note| note.starts_with("fit.csv")),
            "{:?}",
            discovery.notes
        );
    }
}

/// A law of the angle of a thousandth of the torque is no lack of the model, and is not hidden; one of a hundredth is.
#[test]
fn a_thousandth_of_the_torque_is_immaterial() {
    let small = beside(|_, angle| 0.002 * angle * angle, 2e-4);
    let found = discover([small; 2]);
    assert_eq!(found.verdict, Verdict::NothingMissing);
    assert!(found.sentence.contains("immaterial"), "{}", found.sentence);
    let told = |note: &String| note.contains("times its noise, but within 0.2 %");
    assert!(found.notes.iter().any(told), "{:?}", found.notes);
    let large = beside(|_, angle| 0.02 * angle * angle, 2e-4);
    assert_ne!(discover([large; 2]).verdict, Verdict::NothingMissing);
}
