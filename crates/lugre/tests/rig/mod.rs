//! A bench to measure friction on: a table on a spring, drawn at constant
//! speed, and noise. Shared by the identification tests.
#![allow(dead_code)] // each test binary uses its part

use lugre::{LuGre, Parameters};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

pub const PAPER: Parameters = Parameters::LIU_2025;

/// rad of screw per m of table, lead 10 mm.
pub const RAD_PER_M: f64 = 2.0 * std::f64::consts::PI / 0.010;

/// Table speeds in mm/s on both sides of the range that vibrates.
pub const QUIET_MM_S: [f64; 18] = [
    0.2, 0.4, 0.7, 1.0, 1.3, 1.6, 1.9, 2.2, 2.5, 8.0, 10.0, 14.0, 20.0, 40.0, 80.0, 150.0, 220.0,
    300.0,
];

pub fn paper() -> LuGre {
    LuGre::new(PAPER).expect("valid")
}

/// Normal deviates (Box and Muller), from a seed.
pub struct Noise(StdRng);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(StdRng::seed_from_u64(seed))
    }

    pub fn normal(&mut self) -> f64 {
        let (a, b): (f64, f64) = (self.0.random(), self.0.random());
        (-2.0 * (1.0 - a).ln()).sqrt() * (2.0 * std::f64::consts::PI * b).cos()
    }
}

/// The settled end of a run, sampled at 1 kHz.
pub struct Record {
    pub speeds: Vec<f64>,
    pub torques: Vec<f64>,
}

pub const SAMPLE_RATE: f64 = 1000.0;

/// Damping of the drawing spring, N·m·s/rad. The law's `vibration_damping` at
/// 62 Hz is more negative than this in the middle of the Stribeck curve only.
pub const DRIVE_DAMPING: f64 = 0.07;

/// 515 kg seen from the screw (1.3045e-3 kg·m²) on a spring of 62 Hz, drawn at `speed` rad/s; the
/// torque is that of the drawing spring.
pub fn drawn_table(law: &LuGre, speed: f64, seconds: f64) -> Record {
    let inertia = 515.0 / (RAD_PER_M * RAD_PER_M);
    let stiffness = inertia * (2.0 * std::f64::consts::PI * 62.0_f64).powi(2);
    let h = 25e-6;
    let per_sample = (1.0 / (SAMPLE_RATE * h)).round() as usize;
    // From steady sliding, 5 % too fast: what grows from there is the axis's
    // own vibration. 4 s are enough for it.
    let settle = 4.0;
    let total = ((settle + seconds) / h) as usize;
    let mut lag = law.steady_state(speed) / stiffness;
    let (mut w, mut z) = (1.05 * speed, law.steady_bristle(speed));
    let mut record = Record {
        speeds: Vec::new(),
        torques: Vec::new(),
    };
    for i in 0..total {
        let spring = stiffness * lag + DRIVE_DAMPING * (speed - w);
        let w1 = w + h / inertia * (spring - law.torque(z, w));
        z = law.step(z, w, w1, h);
        lag += h * (speed - w1);
        w = w1;
        if i as f64 * h >= settle && i % per_sample == 0 {
            record.speeds.push(w);
            record
                .torques
                .push(stiffness * lag + DRIVE_DAMPING * (speed - w));
        }
    }
    record
}

/// White torque noise of `fraction` of each sample's torque.
pub fn with_noise(torques: &[f64], fraction: f64, noise: &mut Noise) -> Vec<f64> {
    torques
        .iter()
        .map(|t| t + fraction * t * noise.normal())
        .collect()
}
