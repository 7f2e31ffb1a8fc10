//! Logs of a generator of its own: a motion that is given, LuGre's equations as printed by the classical
//! Runge–Kutta method, the torque that this takes, and sensors with steps and noise.

use std::f64::consts::{PI, TAU};

use axis_log::{Channel, Log};
use axis_pipeline::identification::{
    Identified, IdentifyLogsError, ParameterSource, identify_from_logs,
};
use axis_sim::Axis;

use super::axis;

/// Law of a machine, at the load: T_C, T_S, Ω_S, σ0, σ1, σ2 in N, m or N·m, rad.
#[derive(Clone, Copy)]
struct Law([f64; 6]);

impl Law {
    fn rate(&self, z: f64, v: f64) -> f64 {
        let [tc, ts, vs, s0, ..] = self.0;
        let g = tc + (ts - tc) * (-(v / vs).powi(2)).exp();
        v - s0 * v.abs() * z / g
    }

    fn force(&self, z: f64, v: f64) -> f64 {
        let [.., s0, s1, s2] = self.0;
        s0 * z + s1 * self.rate(z, v) + s2 * v
    }

    fn step(&self, z: f64, [v0, v1]: [f64; 2], h: f64) -> f64 {
        let middle = 0.5 * (v0 + v1);
        let a = self.rate(z, v0);
        let b = self.rate(z + 0.5 * h * a, middle);
        let c = self.rate(z + 0.5 * h * b, middle);
        let d = self.rate(z + h * c, v1);
        z + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    }
}

/// Numbers between −1 and 1, and normal ones as sums of twelve (D. E. Knuth's MMIX generator).
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn normal(&mut self) -> f64 {
        // Each has the variance 1/3.
        0.5 * (0..12).map(|_| self.uniform()).sum::<f64>()
    }
}

/// A motion: speeds with their times, ramps of a raised cosine between.
struct Course {
    /// Speed held, time to get there, time held.
    parts: Vec<[f64; 3]>,
    /// Sines at the end: amplitude, frequency, cycles.
    sines: Vec<[f64; 3]>,
}

impl Course {
    fn speeds(speeds: &[f64], hold: f64, ramp: f64) -> Self {
        let mut parts = vec![[0.0, 0.1, 0.3]];
        for &v in speeds {
            for v in [v, -v] {
                parts.push([v, ramp, hold]);
                parts.push([0.0, ramp, 0.2]);
            }
        }
        Self {
            parts,
            sines: Vec::new(),
        }
    }

    fn duration(&self) -> f64 {
        let held: f64 = self.parts.iter().map(|p| p[1] + p[2]).sum();
        held + self.sines.iter().map(|s| s[2] / s[1]).sum::<f64>()
    }

    /// Speed and acceleration.
    fn at(&self, mut t: f64) -> [f64; 2] {
        let mut before = 0.0;
        for [v, ramp, hold] in &self.parts {
            if t < *ramp {
                let turn = PI * t / ramp;
                let change = v - before;
                return [
                    before + 0.5 * change * (1.0 - turn.cos()),
                    0.5 * change * PI / ramp * turn.sin(),
                ];
            }
            t -= ramp;
            if t < *hold {
                return [*v, 0.0];
            }
            t -= hold;
            before = *v;
        }
        for [a, f, cycles] in &self.sines {
            let time = cycles / f;
            if t < time {
                // A position a sin³: at rest with its ends.
                let w = TAU * f;
                let (s, c) = (w * t).sin_cos();
                return [
                    3.0 * a * w * s * s * c,
                    3.0 * a * w * w * (2.0 * s * c * c - s.powi(3)),
                ];
            }
            t -= time;
        }
        [0.0, 0.0]
    }
}

/// What a machine is besides its friction, and how it is measured.
struct Machine {
    law: Law,
    /// Of the load, and of the motor as it is at the load, kg or kg·m².
    inertia: f64,
    motor_inertia: f64,
    /// Load's way per radian of the motor, and its way per force by wind-up.
    travel: f64,
    compliance: f64,
    /// constant load as a function of the load's position.
    load: fn(f64) -> f64,
    start: f64,
    /// Channel of the motion, its steps and noise; whether it is at the motor.
    motion: (&'static str, f64, f64, bool),
    /// Channel of the torque, what it shows of 1 N·m of the motor, noise.
    torque: (&'static str, f64, f64),
}

impl Machine {
    fn log(&self, course: &Course, seed: u64) -> Log {
        let (rate, fine) = (1000.0, 40);
        let h = 1.0 / rate / f64::from(fine);
        let samples = (course.duration() * rate) as i32;
        let (mut x, mut z) = (self.start, 0.0);
        // What the transmission carries, and where the motor is, times its travel per radian.
        let (mut carried, mut motor) = (Vec::new(), Vec::new());
        let mut load = Vec::new();
        for k in 0..samples * fine {
            let t = f64::from(k) * h;
            let [v, a] = course.at(t);
            let force = self.inertia * a + self.law.force(z, v) + (self.load)(x);
            carried.push(force);
            motor.push(x + self.compliance * force);
            load.push(x);
            let next = course.at(t + h)[0];
            z = self.law.step(z, [v, next], h);
            x += 0.5 * h * (v + next);
        }
        let mut random = Random(seed);
        let (mut t_s, mut motion, mut torque) = (Vec::new(), Vec::new(), Vec::new());
        let fine = fine as usize;
        // Where friction reverses, the motor behind the spring gets a jolt: the torque is that over a
        // sample, as a drive's converter has it.
        let force = |k: usize| {
            let bend = motor[k + 1] - 2.0 * motor[k] + motor[k - 1];
            carried[k] + self.motor_inertia * bend / (h * h)
        };
        for k in (fine..carried.len() - fine).step_by(fine) {
            let about = k - fine / 2..k + fine / 2;
            let force = about.map(force).sum::<f64>() / fine as f64;
            let (_, step, noise, at_motor) = self.motion;
            let place = match at_motor {
                true => motor[k] / self.travel,
                false => load[k],
            };
            let seen = place + noise * random.normal();
            motion.push(match step > 0.0 {
                true => (seen / step).round() * step,
                false => seen,
            });
            let (_, shows, noise) = self.torque;
            torque.push(shows * force * self.travel + noise * random.normal());
            t_s.push(k as f64 * h);
        }
        let channel = |name, samples| Channel::new(name, samples).unwrap();
        Log::new(vec![
            channel("t_s", t_s),
            channel(self.motion.0, motion),
            channel(self.torque.0, torque),
        ])
        .unwrap()
    }
}

/// Whether each value lies within its target and its interval, twice as wide, of the truth: T_C, T_S,
/// Ω_S, σ2, σ0, σ1.
fn check(found: &Identified, truth: [f64; 6], targets: [f64; 6]) {
    for (place, p) in found.parameters.iter().enumerate() {
        println!(
            "{} = {:.5e} {:?}, truth {:.5e} {:?}",
            p.name, p.value, p.interval, truth[place], p.source
        );
    }
    for (place, p) in found.parameters.iter().enumerate() {
        let off = p.value / truth[place] - 1.0;
        assert!(off.abs() <= targets[place], "{} is off by {off}", p.name);
        let [low, high] = p.interval.expect("an interval");
        let half = high - p.value;
        assert!(
            low - half <= truth[place] && truth[place] <= high + half,
            "{} {low} {high}",
            p.name
        );
    }
}

fn named(logs: Vec<Log>) -> Vec<(String, Log)> {
    logs.into_iter()
        .enumerate()
        .map(|(i, log)| (format!("log {i}"), log))
        .collect()
}

/// A slide on a linear motor, its scale in steps of 0.1 µm, its current with noise of 20 mA: forces in N,
/// friction of the load.
fn slide() -> Machine {
    Machine {
        law: Law([30.0, 42.0, 4e-3, 3e6, 9000.0, 60.0]),
        inertia: 40.0,
        motor_inertia: 0.0,
        travel: 1.0,
        compliance: 0.0,
        load: |_| 0.0,
        start: 0.2,
        motion: ("position_m", 1e-7, 2e-8, false),
        torque: ("iq_a", 1.0 / 93.0, 0.02),
    }
}

const SLIDE_SPEEDS: [f64; 10] = [
    0.3e-3, 0.6e-3, 1e-3, 2e-3, 3e-3, 6e-3, 10e-3, 30e-3, 100e-3, 200e-3,
];

/// In the order of the parameters found.
fn ordered(law: Law) -> [f64; 6] {
    let [tc, ts, vs, s0, s1, s2] = law.0;
    [tc, ts, vs, s2, s0, s1]
}

#[test]
fn a_slide_in_newtons_and_metres_per_second() {
    let machine = slide();
    let small = Course {
        parts: vec![[0.0, 0.1, 0.2]],
        sines: vec![[6e-6, 0.5, 3.0], [6e-6, 2.0, 8.0]],
    };
    let logs = named(vec![
        machine.log(&Course::speeds(&SLIDE_SPEEDS, 1.5, 0.1), 1),
        machine.log(&small, 2),
    ]);
    let found = identify_from_logs(&axis("linear-motor"), &logs).unwrap();
    check(
        &found,
        ordered(machine.law),
        [0.01, 0.02, 0.04, 0.03, 0.03, 0.10],
    );
    assert!(found.open.is_empty(), "{:?}", found.open);
}

/// Without small motions the bristles stay open, and it is said which run would show them.
#[test]
fn what_the_logs_leave_open_is_told() {
    let machine = slide();
    // Speeds far above that at which friction falls, and fast ramps.
    let speeds = [20e-3, 40e-3, 60e-3, 80e-3, 120e-3, 200e-3];
    let logs = named(vec![machine.log(&Course::speeds(&speeds, 1.0, 0.02), 3)]);
    let axis = axis("linear-motor");
    let found = identify_from_logs(&axis, &logs).unwrap();
    let of = |name: &str| found.parameters.iter().find(|p| p.name == name).unwrap();
    assert!((of("T_C").value / 30.0 - 1.0).abs() < 0.02);
    assert_eq!(of("T_S").source, ParameterSource::NoFall);
    assert_eq!(of("σ0").source, ParameterSource::AxisFile);
    // T_C over the axis file's pre-sliding distance of 10 µm.
    assert!((of("σ0").value / (of("T_C").value / 10e-6) - 1.0).abs() < 1e-9);
    let told: Vec<String> = found.open.iter().map(ToString::to_string).collect();
    assert!(
        told.iter()
            .any(|t| t.starts_with("T_S and Ω_S not identified") && t.contains("; run ")),
        "{told:?}"
    );
    assert!(
        told.iter()
            .any(|t| t.starts_with("σ0 and σ1 not identified") && t.contains("to and fro")),
        "{told:?}"
    );
    // Nothing that moves, and channels that are not there.
    let rest = machine.log(
        &Course {
            parts: vec![[0.0, 0.1, 3.0]],
            sines: Vec::new(),
        },
        4,
    );
    let error = identify_from_logs(&axis, &named(vec![rest.clone()])).unwrap_err();
    assert!(
        matches!(
            error,
            IdentifyLogsError::TooFewSpeeds {
                speeds: 0,
                needed: 4,
                ..
            }
        ),
        "{error}"
    );
    let without = Log::new(rest.channels()[..2].to_vec()).unwrap();
    let error = identify_from_logs(&axis, &named(vec![without]))
        .unwrap_err()
        .to_string();
    assert!(error.contains("log 0") && error.contains("iq_a"), "{error}");
}

/// A joint that turns, behind a gear that gives way, under gravity, seen by the motor's encoder alone:
/// N·m, rad/s at the load; the torque as it is commanded.
#[test]
fn a_joint_behind_an_elastic_gear_under_gravity() {
    let ratio: f64 = 100.0;
    let machine = Machine {
        law: Law([6.0, 7.5, 0.035, 2e4, 200.0, 8.0]),
        inertia: 2.0,
        motor_inertia: 1e-4 * ratio * ratio,
        travel: 1.0 / ratio,
        compliance: 1.0 / 2.5e4,
        load: |x| 60.0 * (x + PI / 2.0).sin(),
        start: -0.5,
        motion: ("motor_angle_rad", TAU / (4096.0 * 32.0), 0.0, true),
        torque: ("torque_n_m", 1.0, 2e-4),
    };
    let speeds = [2e-3, 5e-3, 1e-2, 2e-2, 3e-2, 6e-2, 0.1, 0.2, 0.4, 0.8];
    let small = Course {
        parts: vec![[0.0, 0.1, 0.2]],
        sines: vec![[2.2e-4, 0.5, 3.0], [2.2e-4, 2.0, 8.0]],
    };
    let logs = named(vec![
        machine.log(&Course::speeds(&speeds, 1.2, 0.15), 5),
        machine.log(&small, 6),
    ]);
    let found = identify_from_logs(&axis("joint"), &logs).unwrap();
    check(
        &found,
        ordered(machine.law),
        [0.02, 0.03, 0.08, 0.05, 0.05, 0.25],
    );
}

/// Of 40 sets of noise, the intervals of 95 % hold the truth about as often.
#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let machine = slide();
    let axis: Axis = axis("linear-motor");
    let truth = ordered(machine.law);
    let sets: u64 = 20;
    let mut hits = [0; 6];
    for seed in 0..sets {
        let speeds = Course::speeds(&SLIDE_SPEEDS, 0.8, 0.1);
        let small = Course {
            parts: vec![[0.0, 0.1, 0.2]],
            sines: vec![[6e-6, 1.0, 4.0]],
        };
        let logs = named(vec![
            machine.log(&speeds, 100 + seed),
            machine.log(&small, 200 + seed),
        ]);
        let found = identify_from_logs(&axis, &logs).unwrap();
        for (place, p) in found.parameters.iter().enumerate() {
            let [low, high] = p.interval.unwrap();
            hits[place] += u64::from(low <= truth[place] && truth[place] <= high);
        }
    }
    println!("{hits:?} of {sets}");
    // Binomial(20, 0.95) is below 15 once in 400; six of them.
    assert!(hits.iter().all(|&h| h >= 15), "{hits:?} of {sets}");
}
