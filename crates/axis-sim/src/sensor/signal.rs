//! What all position sensors get wrong: late, periodic, noisy, in steps.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::{Sensing, Sensor};
use crate::freedom::Freedom;

/// A sensor by its numbers, in m or rad.
#[derive(Clone, Copy, Debug)]
pub(super) struct Signal {
    pub freedom: Freedom,
    /// Step of what it shows; 0 for none.
    pub resolution: f64,
    /// Amplitude of the error that repeats with the signal period, and that period.
    pub periodic_error: f64,
    pub signal_period: f64,
    /// Phase of that error at position 0, rad.
    pub phase: f64,
    /// Standard deviation of white noise at the control rate.
    pub noise: f64,
    /// s.
    pub delay: f64,
}

impl Sensor for Signal {
    fn freedom(&self) -> Freedom {
        self.freedom
    }

    fn resolution(&self) -> f64 {
        self.resolution
    }

    fn delay(&self) -> f64 {
        self.delay
    }

    fn is_exact(&self) -> bool {
        self.resolution == 0.0 && self.noise == 0.0
    }

    fn start(&self, period: f64, noise: Option<u64>) -> Box<dyn Sensing> {
        let exact = Self {
            resolution: 0.0,
            noise: 0.0,
            ..*self
        };
        Box::new(State {
            law: if noise.is_some() { *self } else { exact },
            random: ChaCha8Rng::seed_from_u64(noise.unwrap_or(0)),
            late: self.delay / period,
            period,
            past: VecDeque::new(),
        })
    }
}

#[derive(Clone, Debug)]
struct State {
    law: Signal,
    random: ChaCha8Rng,
    /// Delay in control cycles.
    late: f64,
    period: f64,
    /// The last positions, the newest first.
    past: VecDeque<f64>,
}

impl State {
    /// The position a delay ago, linear between samples.
    fn delayed(&mut self, position: f64) -> f64 {
        if self.late == 0.0 {
            return position;
        }
        let whole = self.late.floor();
        self.past.push_front(position);
        self.past.truncate(whole as usize + 2);
        let at = |i: usize| self.past.get(i).or(self.past.back());
        let at = |i: usize| at(i).copied().unwrap_or(position);
        let part = self.late - whole;
        (1.0 - part) * at(whole as usize) + part * at(whole as usize + 1)
    }
}

impl Sensing for State {
    fn read(&mut self, position: f64) -> f64 {
        let mut seen = self.delayed(position);
        let law = &self.law;
        if law.periodic_error != 0.0 {
            let turn = TAU * seen / law.signal_period + law.phase;
            seen += law.periodic_error * turn.sin();
        }
        if law.noise != 0.0 {
            let unit: f64 = StandardNormal.sample(&mut self.random);
            seen += law.noise * unit;
        }
        if law.resolution != 0.0 {
            seen = (seen / law.resolution).round() * law.resolution;
        }
        seen
    }

    fn settle(&mut self, position: f64, speed: f64) {
        let cycles = self.late.floor() as usize + 2;
        let before = |k: usize| position - speed * self.period * (k + 1) as f64;
        self.past = match self.late {
            0.0 => VecDeque::new(),
            _ => (0..cycles).map(before).collect(),
        };
    }

    fn copy(&self) -> Box<dyn Sensing> {
        Box::new(self.clone())
    }
}
