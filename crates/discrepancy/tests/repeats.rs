//! What repeats with the motor's turn, at a speed at which it is as fast as noise.

use std::f64::consts::TAU;

use axis_log::{Channel, Log};
use axis_sim::Axis;
use discrepancy::logs::{NamedLog, admit};
use discrepancy::{Discovery, Evidence, Settings};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

const PERIOD: f64 = 1e-3;
/// Of the rotor, kg·m².
const INERTIA: f64 = 4e-6;
/// N·m.
const DRY: f64 = 3e-3;

/// A rotor on a bench, without control, with its inertia guessed.
fn bench(inertia: f64, more: &str) -> Axis {
    let text = format!(
        "schema = 2\nname = \"bench\"\n[mechanism]\nkind = \"torque-motor\"\ntable_inertia_kg_m2 = {inertia:e}\n[actuator]\nkind = \"torque-source\"\ntorque_limit_n_m = 0.1\nbandwidth_hz = 1e4\n[friction]\nkind = \"coulomb-rotary\"\nviscous_n_m_s_per_rad = 0\ncoulomb_n_m = 0\npresliding_rad = 1e-3\n[stroke]\nminimum_rad = -9000\nmaximum_rad = 9000\nstart_rad = 0\n[tolerances]\ntable_inertia = \"unknown\"\n{more}"
    );
    Axis::parse("bench.toml", &text).unwrap()
}

/// One that turns at a speed that hardly swings, the torque that keeps it so, and noise of both.
fn log(name: &str, speed: f64, [order, cogging]: [f64; 2], seed: u64) -> NamedLog {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let swing = TAU * 1.3;
    let times: Vec<f64> = (0..5000).map(|k| f64::from(k) * PERIOD).collect();
    let angle = |t: f64| speed * t + 0.02 * speed * (swing * t).sin() / swing;
    let acceleration = |t: f64| -0.02 * speed * swing * (swing * t).sin();
    let torque = |t: &f64| {
        let own = INERTIA * acceleration(*t) + DRY * speed.signum();
        own + cogging * (order * angle(*t) + 0.7).sin()
    };
    let torques = times.iter().map(|t| torque(t) + 4e-4 * normal()).collect();
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let angles = times.iter().map(|t| angle(*t) + 1e-3 * normal()).collect();
    let channel = |name: &str, samples: Vec<f64>| Channel::new(name, samples).unwrap();
    let log = Log::new(vec![
        channel("t_s", times),
        channel("position_rad", angles),
        channel("torque_n_m", torques),
    ])
    .unwrap();
    (name.to_owned(), log, PERIOD)
}

fn discover(machine: &Axis, waves: [f64; 2]) -> Discovery {
    let logs = |all: [(&str, f64, u64); 2]| -> Vec<NamedLog> {
        let one = |(name, speed, seed)| {
            let (name, log, _) = log(name, speed, waves, seed);
            admit(name, log, machine, &mut Vec::new()).unwrap()
        };
        all.map(one).into()
    };
    let fit = logs([("there", 30.0, 1), ("back", -30.0, 2)]);
    let check = logs([("faster", 36.0, 3), ("faster back", -36.0, 4)]);
    let evidence = Evidence::new(machine, fit, check, Vec::new()).unwrap();
    let (_, discovered) = evidence
        .discover(machine, &Settings::default(), |_| ())
        .unwrap();
    let discovery = discovered.discovery;
    println!(
        "{}\n{:#?}\n{:?}",
        discovery.sentence, discovery.notes, discovery.gap
    );
    for effect in &discovery.effects {
        println!("{} {:?}", effect.name, effect.parameters);
    }
    discovery
}

fn cogging(discovery: &Discovery) -> Option<[f64; 2]> {
    let found = discovery
        .effects
        .iter()
        .find(|e| e.name == "cogging-torque")?;
    Some([1, 0].map(|p: usize| found.parameters[p].value))
}

/// 12 a turn at 30 rad/s are 57 Hz, 36 are 172 Hz: of a log at 1 kHz, low-passed at 40 Hz as usual, nothing
/// of either is left. Inertia makes next to nothing of the torque, and the file's may be far off.
#[test]
fn cogging_is_named_at_one_speed_whatever_the_inertia_is_guessed_to_be() {
    for (guess, wave) in [(INERTIA, [12.0, 1.5e-3]), (4e-7, [36.0, 1.2e-3])] {
        let discovery = discover(&bench(guess, ""), wave);
        let [order, size] = cogging(&discovery).unwrap();
        assert!((order - wave[0]).abs() < 1e-2, "{order}");
        assert!((size / wave[1] - 1.0).abs() < 0.05, "{size}");
        let gap = &discovery.gap.check.channels[0];
        assert!(
            gap.after < 1.2 * gap.floor && gap.floor < 1.2 * gap.after,
            "{gap:?}"
        );
    }
}
