//! A robot joint behind a strain wave gear, under gravity, with an encoder on the motor whose zero is not that of the arm.
//!
//! What differs on purpose from the library: symplectic Euler in steps of 25 µs, friction that comes on as
//! arctan(v / 3 mrad/s), and an encoder that was set with the arm hanging down, so that it knows nothing of the gear's
//! wind-up where a log begins.
//!
//! ```text
//! 1 kg·m² m'' = T − (1 + 200 e cos(200 m + φ)) S          2 kg·m² x'' = S − (6 + e^−(v/35 mrad/s)²) N·m arctan(…) − 8 N·m·s/rad v − G cos(x − x₀) − F
//! S = 2.5e4 N·m/rad (m − x + e sin(200 m + φ)) + 5 N·m·s/rad (m' − x')
//! ```
//! at the arm, `m` being the motor's angle over 100.

use std::f64::consts::{FRAC_2_PI, TAU};

use crate::logger::Table;
use crate::random::Random;

/// Step of the machine, s; steps in a period of the controller, and in one of the log, which is at 1 kHz.
const STEP: f64 = 2.5e-5;
const CONTROL: usize = 10;
const LOGGED: usize = 40;

const RATIO: f64 = 100.0;
/// Amplitude of the kinematic error, rad: half a minute of arc.
const ERROR: f64 = 1.454e-4;
/// An encoder of 14 bits, rad.
const RESOLUTION: f64 = TAU / 16384.0;
/// Noise of the commanded torque, N·m at the motor.
const TORQUE_NOISE: f64 = 5e-4;

/// What no axis file knows of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Where the arm lies level by the encoder, rad.
    pub level_at: f64,
    /// Phase of the kinematic error, rad.
    pub error_phase: f64,
    /// Gravity of the arm, N·m.
    pub gravity: f64,
    /// A force on the arm against positive motion that stiffens as a spring about level does, N·m/rad.
    pub spring: f64,
    /// A force on the arm against positive motion that is always there, N·m.
    pub load: f64,
}

/// A log of time, motor angle and commanded torque on motion by `moves`, each a distance (rad), a speed (rad/s) and an
/// acceleration (rad/s²), with 0.15 s before and after each.
pub fn joint_log(joint: &Joint, moves: &[[f64; 3]], random: &mut Random) -> Table {
    let start = -0.52;
    let motion = reference(start, moves);
    let gravity = |x: f64| joint.gravity * (x - joint.level_at).cos();
    let held = gravity(start) + joint.spring * start + joint.load;
    // The gear's error at the motor's angle, and what a force on the arm has for a lever there.
    let gear = |m: f64| {
        let (sin, cos) = (2.0 * RATIO * m + joint.error_phase).sin_cos();
        (ERROR * sin, 1.0 + 2.0 * RATIO * ERROR * cos)
    };
    let (mut x, mut v, mut w) = (start, 0.0, 0.0);
    let mut m = (0..20).fold(start, |m, _| start + held / 2.5e4 - gear(m).0);
    let holding = gear(m).1 * held;
    let (mut integral, mut command, mut torque, mut last) = (holding, holding, holding, m);
    let mut rows = Vec::new();
    for (k, &[wanted, speed]) in motion.iter().enumerate() {
        if k % CONTROL == 0 {
            let shown = (m - last) / (STEP * CONTROL as f64);
            let off = 6.0 * (wanted - m) + speed - shown;
            integral += 200.0 / 0.05 * off * STEP * CONTROL as f64;
            command = 200.0 * off + integral;
            last = m;
        }
        if k % LOGGED == 0 {
            let angle = (RATIO * m / RESOLUTION).round() * RESOLUTION;
            let noise = TORQUE_NOISE * random.normal();
            rows.push(vec![k as f64 * STEP, angle, command / RATIO + noise]);
        }
        torque += (command - torque) * STEP * TAU * 500.0;
        let (error, lever) = gear(m);
        let spring = 2.5e4 * (m - x + error) + 5.0 * (w - v);
        let dry = 6.0 + (-(v / 0.035) * (v / 0.035)).exp();
        let friction = dry * FRAC_2_PI * (v / 3e-3).atan() + 8.0 * v;
        let load = friction + gravity(x) + joint.spring * x + joint.load;
        w += STEP * (torque - lever * spring);
        m += STEP * w;
        v += STEP * (spring - load) / 2.0;
        x += STEP * v;
    }
    Table {
        names: vec!["t_s", "motor_angle_rad", "torque_ref_n_m"],
        rows,
    }
}

/// Wanted angle and speed each step: trapezoids of speed, each raised by a cosine instead of a corner.
fn reference(start: f64, moves: &[[f64; 3]]) -> Vec<[f64; 2]> {
    let still = (0.15 / STEP) as usize;
    let mut motion = vec![[start, 0.0]; still];
    let mut from = start;
    for &[distance, most, acceleration] in moves {
        let way = distance.abs();
        // Half a cosine takes 1/2 of its time at full speed.
        let speed = most.min((way * acceleration).sqrt());
        let (rise, total) = (speed / acceleration, way / speed + speed / acceleration);
        let (mut at, steps) = (0.0, (total / STEP) as usize);
        for k in 0..steps {
            let t = k as f64 * STEP;
            let near = t.min(total - t).clamp(0.0, rise) / rise;
            let v = speed * 0.5 * (1.0 - (0.5 * TAU * near).cos());
            at += v * STEP;
            motion.push([from + distance.signum() * at, distance.signum() * v]);
        }
        from += distance.signum() * at;
        motion.extend(std::iter::repeat_n([from, 0.0], still));
    }
    motion
}
