//! The noise of one channel, sample by sample.

use axis_sim::NormalNumbers;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha20Rng;

use super::rough_kind::{NoiseColour, Rough};

/// What one channel gets.
pub(super) struct Stream {
    rough: Rough,
    /// Standard deviation, resolution or size of outliers, in the channel's unit.
    size: f64,
    normal: NormalNumbers,
    uniform: ChaCha20Rng,
    /// Of the filter, from one sample to the next.
    keeps: f64,
    filtered: f64,
    /// Of the line: turn per sample, and where it is, rad.
    turn: f64,
    at: f64,
}

impl Stream {
    pub(super) fn new(rough: Rough, deviation: f64, period: f64, seed: u64) -> Self {
        use std::f64::consts::TAU;
        let mut uniform = ChaCha20Rng::seed_from_u64(seed ^ 0x756e_6966);
        let times = match rough.colour {
            NoiseColour::Outliers => rough.far,
            _ => rough.share,
        };
        Self {
            rough,
            size: times * deviation,
            normal: NormalNumbers::new(seed),
            keeps: (-TAU * rough.corner * period).exp(),
            filtered: 0.0,
            turn: TAU * rough.line * period,
            at: TAU * uniform.random::<f64>(),
            uniform,
        }
    }

    /// What is shown of a value.
    pub(super) fn show(&mut self, value: f64) -> f64 {
        match self.rough.colour {
            NoiseColour::White => value + self.size * self.normal.draw(),
            NoiseColour::Coloured => value + self.size * self.coloured(),
            NoiseColour::Quantised if self.size > 0.0 => self.size * (value / self.size).round(),
            NoiseColour::Quantised => value,
            NoiseColour::Outliers => {
                let out = self.uniform.random::<f64>() < self.rough.rare;
                let sign = if self.uniform.random::<f64>() < 0.5 {
                    -1.0
                } else {
                    1.0
                };
                value + if out { sign * self.size } else { 0.0 }
            }
        }
    }

    /// Filtered noise of variance 1/2 and a line of as much.
    fn coloured(&mut self) -> f64 {
        let gain = (0.5 * (1.0 - self.keeps * self.keeps)).sqrt();
        self.filtered = self.keeps * self.filtered + gain * self.normal.draw();
        self.at += self.turn;
        self.filtered + self.at.sin()
    }
}
