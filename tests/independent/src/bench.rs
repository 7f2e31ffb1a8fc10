//! A motor on a torque-controlled bench that is driven by a sum of sines and never rests.
//!
//! Its axis file knows the inertia alone, and a way on which friction comes on that is far too long, as
//! such files do. What differs on purpose from the library: symplectic Euler in steps of 50 µs, and dry
//! friction that comes on with the speed, as tanh(ω / 10 mrad/s). The torque is shown as it begins to be
//! held for a control period, as drives do: half of that early.
//!
//! ```text
//! 0.02 kg·m² ω' = T − T₊₋ tanh(ω / 10 mrad/s) − d ω,   T = 60 N·m/rad (r − φ) + 1.2 N·m·s/rad (r' − ω)
//! ```

use std::f64::consts::TAU;

use crate::logger::Table;
use crate::random::Random;

/// Step of the machine, s.
const STEP: f64 = 5e-5;
/// Steps in a control period: 1 kHz.
const CONTROL: usize = 20;
/// Control periods from one sample of a log to the next: 500 Hz.
const EVERY: usize = 2;
/// Length of a log, s.
const DURATION: f64 = 20.0;

const INERTIA: f64 = 0.02;
const ONSET: f64 = 0.01;
const STIFFNESS: f64 = 60.0;
const DAMPING: f64 = 1.2;
const TORQUE_LIMIT: f64 = 20.0;
/// Noise of the torque, N·m, and of the angle, rad; step of the angle, rad.
const TORQUE_NOISE: f64 = 0.01;
const ANGLE_NOISE: f64 = 2e-5;
const ANGLE_STEP: f64 = 1e-5;

/// Friction of the bench.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchFriction {
    /// Dry, forward and backward, N·m.
    pub dry: [f64; 2],
    /// Viscous, N·m·s/rad.
    pub viscous: f64,
}

/// Frequency (Hz), phase and amplitude (rad) of the reference's sines, `pace` times as fast as 0.15 Hz.
fn sines(pace: f64, random: &mut Random) -> [[f64; 3]; 7] {
    [1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 21.0].map(|order| {
        let frequency = 0.15 * pace * order * (1.0 + 0.07 * random.uniform());
        [frequency, TAU * random.uniform(), 1.2 / order]
    })
}

/// Place and speed of the reference.
fn reference(sines: &[[f64; 3]], time: f64) -> [f64; 2] {
    let one = |&[frequency, phase, amplitude]: &[f64; 3]| {
        let omega = TAU * frequency;
        let (sin, cos) = (omega * time + phase).sin_cos();
        [amplitude * sin, amplitude * omega * cos]
    };
    let all = sines.iter().map(one);
    all.fold([0.0; 2], |[r, v], [one, rate]| [r + one, v + rate])
}

/// A log of time, angle and torque at 500 Hz.
pub fn bench_log(friction: &BenchFriction, pace: f64, random: &mut Random) -> Table {
    let sines = sines(pace, random);
    let [mut angle, mut speed] = [reference(&sines, 0.0)[0], 0.0];
    let mut rows = Vec::new();
    for period in 0..(DURATION / (STEP * CONTROL as f64)) as usize {
        let time = period as f64 * STEP * CONTROL as f64;
        let [wanted, rate] = reference(&sines, time);
        let torque = STIFFNESS * (wanted - angle) + DAMPING * (rate - speed);
        let torque = torque.clamp(-TORQUE_LIMIT, TORQUE_LIMIT);
        if period % EVERY == 0 {
            let read = angle + ANGLE_NOISE * random.normal();
            let read = (read / ANGLE_STEP).round() * ANGLE_STEP;
            rows.push(vec![time, read, torque + TORQUE_NOISE * random.normal()]);
        }
        for _ in 0..CONTROL {
            let [forward, backward] = friction.dry;
            let level = if speed > 0.0 { forward } else { backward };
            let against = level * (speed / ONSET).tanh() + friction.viscous * speed;
            speed += STEP * (torque - against) / INERTIA;
            angle += STEP * speed;
        }
    }
    Table {
        names: vec!["t_s", "position_rad", "torque_n_m"],
        rows,
    }
}
