//! A small motor with a disk on a bench, spun at one speed or swung by a sine of torque, as public
//! logs of such benches have it: slow, with a coarse encoder and cogging.
//!
//! What differs on purpose from the library: symplectic Euler in steps of 20 µs, dry friction as
//! arctan(ω / 20 mrad/s), and a speed controller whose torque is shown as it begins to be held.
//!
//! ```text
//! 5e-6 kg·m² ω' = T − T_c 2/π arctan(ω / 20 mrad/s) − T_k sin(N φ)
//! ```

use std::f64::consts::{FRAC_2_PI, TAU};

use crate::logger::Table;
use crate::random::Random;

/// Step of the machine, s, and steps in a control period, which is that of a log: 1 kHz.
const STEP: f64 = 2e-5;
const CONTROL: usize = 50;

const INERTIA: f64 = 5e-6;
const ONSET: f64 = 0.02;
/// Gain of the speed controller, N·m·s/rad, and what its integral adds of it each second, 1/s.
const GAIN: f64 = 1.5e-3;
const INTEGRAL: f64 = 60.0;
/// Noise of the torque, N·m.
const TORQUE_NOISE: f64 = 2e-4;

/// What of the motor its axis file does not know, and how well its encoder shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpunMotor {
    /// Dry friction, N·m.
    pub dry: f64,
    /// Cogging: waves a turn, and amplitude, N·m.
    pub cogging: [f64; 2],
    /// Noise of the angle, rad.
    pub angle_noise: f64,
}

/// What turns it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpunBy {
    /// A speed, rad/s.
    Speed(f64),
    /// Torque, N·m, as a sine of that frequency, Hz.
    Sine([f64; 2]),
}

/// A log of time, angle and torque, `duration` s long.
pub fn spun_log(motor: &SpunMotor, by: SpunBy, duration: f64, random: &mut Random) -> Table {
    let [order, cogging] = motor.cogging;
    let (mut angle, mut speed, mut integral) = (random.uniform(), 0.0, 0.0);
    let period = STEP * CONTROL as f64;
    let mut rows = Vec::new();
    for k in 0..(duration / period) as usize {
        let time = k as f64 * period;
        let torque = match by {
            SpunBy::Speed(wanted) => {
                integral += INTEGRAL * period * (wanted - speed);
                GAIN * (wanted - speed + integral)
            }
            SpunBy::Sine([torque, frequency]) => torque * (TAU * frequency * time).sin(),
        };
        let read = angle + motor.angle_noise * random.normal();
        rows.push(vec![time, read, torque + TORQUE_NOISE * random.normal()]);
        for _ in 0..CONTROL {
            let dry = motor.dry * FRAC_2_PI * (speed / ONSET).atan();
            speed += STEP * (torque - dry - cogging * (order * angle).sin()) / INERTIA;
            angle += STEP * speed;
        }
    }
    Table {
        names: vec!["t_s", "position_rad", "torque_n_m"],
        rows,
    }
}
