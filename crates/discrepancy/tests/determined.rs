//! What is named where logs leave more than one explanation: logs of made motors, integrated here.

use std::f64::consts::TAU;

use axis_log::{Channel, Log};
use axis_sim::Axis;
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

/// A motor: its inertia, and the torque against its motion at an angle and a speed.
struct Motor<F: Fn(f64, f64) -> f64> {
    inertia: f64,
    against: F,
}

impl<F: Fn(f64, f64) -> f64> Motor<F> {
    /// A log at 1 kHz of a motor that begins with this speed under this torque in time: Runge's and
    /// Kutta's method of fourth order, 40 steps a sample; white noise in angle (rad) and torque (N·m).
    fn log(
        &self,
        drive: impl Fn(f64) -> f64,
        speed: f64,
        seconds: f64,
        seed: u64,
    ) -> (String, Log, f64) {
        const PERIOD: f64 = 1e-3;
        const STEPS: usize = 40;
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut noise = |size: f64| -> f64 {
            let normal: f64 = StandardNormal.sample(&mut random);
            size * normal
        };
        let slope =
            |t: f64, [x, v]: [f64; 2]| [v, (drive(t) - (self.against)(x, v)) / self.inertia];
        let h = PERIOD / STEPS as f64;
        let mut at = [0.0, speed];
        let (mut time, mut angle, mut torque) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..(seconds / PERIOD) as usize {
            let t = k as f64 * PERIOD;
            time.push(t);
            angle.push(at[0] + noise(2e-5));
            torque.push(drive(t) + noise(2e-5));
            for step in 0..STEPS {
                let t = t + h * step as f64;
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

fn discover(axis: &Axis, fit: (String, Log, f64), check: (String, Log, f64)) -> Discovery {
    let evidence = Evidence::new(axis, vec![fit], vec![check], Vec::new()).unwrap();
    let (_, found) = evidence
        .discover(axis, &Settings::default(), |_| ())
        .unwrap();
    println!(
        "{}\n{}",
        found.discovery.gap_line(),
        found.discovery.sentence
    );
    found.discovery
}

/// Value of an effect's first number; none where it is not named.
fn value(found: &Discovery, name: &str) -> Option<f64> {
    let effect = found.effects.iter().find(|e| e.name == name)?;
    Some(effect.parameters[0].value)
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
    let sine = |size: f64| move |t: f64| size * (TAU * 1.7 * t).sin();
    let [fit, check] =
        [(8.5e-3, 1), (6.5e-3, 2)].map(|(size, seed)| motor.log(sine(size), 0.0, 5.3, seed));
    let found = discover(&bench(1.1e-5, 60.0), fit, check);
    let names: Vec<&str> = found.effects.iter().map(|e| e.name.as_str()).collect();
    for in_time in ["cyclic-load", "process-force"] {
        assert!(!names.contains(&in_time), "{names:?}");
    }
    let found_friction = value(&found, "coulomb-friction").unwrap();
    assert!(
        (found_friction / friction - 1.0).abs() < 0.03,
        "{found_friction}"
    );
    let inertia = found
        .recalibrated
        .iter()
        .find(|k| k.name == "table-inertia")
        .unwrap();
    let inertia = 1.1e-5 * (1.0 + inertia.share);
    assert!((inertia / 8.3e-6 - 1.0).abs() < 0.03, "{inertia}");
}

/// A motor that coasts over its cogging of order 12 under a nearly steady torque. With next to no inertia
/// no cogging is needed, but then the inertia is at the edge of "unknown": cogging is named, and the
/// parameter is said beside it.
#[test]
fn an_exact_cogging_is_not_dropped_for_an_inertia_at_its_edge() {
    let (friction, cogging) = (2.1e-3, 3.9e-3);
    let motor = Motor {
        inertia: 3.2e-5,
        against: |x: f64, v: f64| friction * (v / 0.05).tanh() + cogging * (12.0 * x + 0.7).sin(),
    };
    let drive = |slow: f64| move |t: f64| friction + 2.5e-4 * (TAU * slow * t).sin();
    let [fit, check] = [(0.31, 23.0, 3), (0.43, 27.0, 4)]
        .map(|(slow, speed, seed)| motor.log(drive(slow), speed, 5.0, seed));
    let found = discover(&bench(4.1e-5, 100.0), fit, check);
    let effect = found.effects.iter().find(|e| e.name == "cogging-torque");
    let effect = effect.unwrap_or_else(|| panic!("{}", found.sentence));
    assert_eq!(effect.parameters[1].value, 12.0);
    let size = effect.parameters[0].value;
    assert!((size / cogging - 1.0).abs() < 0.3, "{size}");
    let inertia = found
        .recalibrated
        .iter()
        .find(|k| k.name == "table-inertia")
        .unwrap();
    assert!(!inertia.is_at_edge(), "{inertia:?}");
}
