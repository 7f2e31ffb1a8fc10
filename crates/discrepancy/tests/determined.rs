//! What is named where logs leave more than one explanation: logs of made motors, integrated here.

use std::f64::consts::TAU;

use axis_log::{Channel, Log};
use axis_sim::Axis;
use discrepancy::logs::NamedLog;
use discrepancy::{Discovery, Evidence, Settings};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// A motor on a bench, without a controller; its inertia (kg·m²) is hardly known.
fn bench(inertia: f64, cutoff: f64) -> Axis {
    let text = format!(
        r#"
schema = 2
name = "bench"
[mechanism]
kind = "torque-motor"
table_inertia_kg_m2 = {inertia:e}
[actuator]
kind = "torque-source"
torque_limit_n_m = 0.05
bandwidth_hz = 1000
[friction]
kind = "coulomb-rotary"
viscous_n_m_s_per_rad = 0
coulomb_n_m = 0
presliding_rad = 0.001
[stroke]
minimum_rad = -9000
maximum_rad = 9000
start_rad = 0
[[trajectory]]
displacement_rad = 40
speed_rad_per_s = 120
acceleration_rad_per_s2 = 2500
jerk_rad_per_s3 = 60000
[tolerances]
table_inertia = "unknown"
[balance]
cutoff_hz = {cutoff}
"#
    );
    Axis::parse("bench", &text).unwrap()
}

/// Sampling period of the logs, s, and their samples.
const PERIOD: f64 = 1e-3;
const SAMPLES: usize = 5300;

/// Steps of integration a sample.
const STEPS: usize = 40;

/// A motor: its inertia, and the torque against its motion at an angle and a speed.
struct Motor<F: Fn(f64, f64) -> f64> {
    inertia: f64,
    against: F,
}

impl<F: Fn(f64, f64) -> f64> Motor<F> {
    /// A log of a motor that begins with this speed under a torque of time and speed: Runge's and Kutta's
    /// method of fourth order, and white noise in angle (rad) and torque (N·m).
    fn log(&self, drive: impl Fn(f64, f64) -> f64, speed: f64, seed: u64) -> NamedLog {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut noise = |size: f64| -> f64 {
            let normal: f64 = StandardNormal.sample(&mut random);
            size * normal
        };
        let accelerated =
            |t: f64, [x, v]: [f64; 2]| (drive(t, v) - (self.against)(x, v)) / self.inertia;
        let slope = |t: f64, at: [f64; 2]| [at[1], accelerated(t, at)];
        let h = PERIOD / STEPS as f64;
        let mut at = [0.0, speed];
        let (mut time, mut angle, mut torque) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..SAMPLES {
            let begin = k as f64 * PERIOD;
            time.push(begin);
            angle.push(at[0] + noise(2e-6));
            torque.push(drive(begin, at[1]) + noise(2e-4));
            for step in 0..STEPS {
                let t = begin + h * step as f64;
                let moved = |by: [f64; 2], h: f64| [at[0] + h * by[0], at[1] + h * by[1]];
                let a = slope(t, at);
                let b = slope(t + 0.5 * h, moved(a, 0.5 * h));
                let c = slope(t + 0.5 * h, moved(b, 0.5 * h));
                let d = slope(t + h, moved(c, h));
                at = [0, 1].map(|i| at[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
            }
        }
        let channel = |name: &str, samples: Vec<f64>| Channel::new(name, samples).unwrap();
        let log = Log::new(vec![
            channel("t_s", time),
            channel("position_rad", angle),
            channel("torque_n_m", torque),
        ]);
        (format!("run {seed}"), log.unwrap(), PERIOD)
    }
}

fn discover(axis: &Axis, fit: NamedLog, check: NamedLog) -> Discovery {
    let evidence = Evidence::new(axis, vec![fit], vec![check], Vec::new()).unwrap();
    let settings = Settings::default();
    let (_, found) = evidence.discover(axis, &settings, |_| ()).unwrap();
    let found = found.discovery;
    println!("{}\n{}", found.gap_line(), found.sentence);
    found
}

/// The inertia of the fitted bench, whose file has this one.
fn inertia(found: &Discovery, of_file: f64) -> f64 {
    let mut all = found.recalibrated.iter();
    let known = all.find(|k| k.name == "table-inertia").unwrap();
    of_file * (1.0 + known.share)
}

/// A motor that is driven by a sine of torque, with dry friction and nothing else. With next to no inertia
/// the torque would be a load in time with the drive's own period, to the noise: it is what the drive does.
#[test]
fn what_repeats_with_the_drive_is_no_load_in_time() {
    let friction = 1.7e-3;
    let motor = Motor {
        inertia: 8.3e-6,
        against: |_: f64, v: f64| friction * (v / 0.05).tanh(),
    };
    let sine = |size: f64| move |t: f64, _: f64| size * (TAU * 1.7 * t).sin();
    let sizes = [(8.5e-3, 1), (6.5e-3, 2)];
    let [fit, check] = sizes.map(|(size, seed)| motor.log(sine(size), 0.0, seed));
    let found = discover(&bench(1.1e-5, 60.0), fit, check);
    let names: Vec<&str> = found.effects.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["coulomb-friction"]);
    let size = found.effects[0].parameters[0].value;
    assert!((size / friction - 1.0).abs() < 0.02, "{size}");
    let fitted = inertia(&found, 1.1e-5);
    assert!((fitted / 8.3e-6 - 1.0).abs() < 0.02, "{fitted}");
}

/// A motor with a cogging of order 12 in a speed loop that hardly holds against it. With next to no inertia
/// hardly any cogging is needed, but then the inertia is at the edge of "unknown". The other way round, both
/// come out as they are.
#[test]
fn an_exact_cogging_is_not_dropped_for_an_inertia_at_its_edge() {
    let (friction, cogging) = (2.1e-3, 3.9e-3);
    let motor = Motor {
        inertia: 3.2e-5,
        against: |x: f64, v: f64| friction * (v / 0.05).tanh() + cogging * (12.0 * x + 0.7).sin(),
    };
    let held = |speed: f64, slow: f64| {
        let asked = move |t: f64| speed * (1.0 + 0.25 * (TAU * slow * t).sin());
        move |t: f64, v: f64| friction + 1e-3 * (asked(t) - v)
    };
    let runs = [(23.0, 0.31, 3), (27.0, 0.43, 4)];
    let [fit, check] = runs.map(|(speed, slow, seed)| motor.log(held(speed, slow), speed, seed));
    let found = discover(&bench(4.1e-5, 100.0), fit, check);
    let effect = found.effects.iter().find(|e| e.name == "cogging-torque");
    let effect = effect.unwrap_or_else(|| panic!("{}", found.sentence));
    assert_eq!(effect.parameters[1].value, 12.0);
    let size = effect.parameters[0].value.abs();
    assert!((size / cogging - 1.0).abs() < 0.05, "{size}");
    let fitted = inertia(&found, 4.1e-5);
    assert!((fitted / 3.2e-5 - 1.0).abs() < 0.05, "{fitted}");
}
