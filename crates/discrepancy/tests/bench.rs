//! A bench that turns a table: its logs, made by formula, and what is found of them.

use std::f64::consts::TAU;

use axis_log::{Channel, Log};
use axis_sim::Axis;
use discrepancy::logs::NamedLog;
use discrepancy::{Discovery, Evidence, Settings};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

const INERTIA: f64 = 0.3;
const DRY: f64 = 1.0;

/// What a torque has beside the model's: of time, angle and speed, N·m, and the deviation of its noise.
#[derive(Clone, Copy)]
pub struct Beside {
    torque: fn(f64, f64, f64) -> f64,
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
        let [angle, speed] = [sum(*t, 0, f64::sin), sum(*t, 1, f64::cos)];
        let own = -INERTIA * sum(*t, 2, f64::sin) + DRY * speed.signum();
        own + (beside.torque)(*t, angle, speed) + beside.noise * noise
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
pub fn discover([fitted, checked]: [Beside; 2]) -> Discovery {
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

pub const fn beside(torque: fn(f64, f64, f64) -> f64, noise: f64) -> Beside {
    Beside { torque, noise }
}
