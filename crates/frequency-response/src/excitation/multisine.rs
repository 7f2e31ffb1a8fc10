//! Sums of sines with a low peak.

use std::f64::consts::TAU;

use axis_fourier::Complex;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::check_amplitude;
use crate::error::ResponseError;

/// Longest period, samples.
const LONGEST: usize = 1 << 22;
/// Rounds in which the peak is lowered, and the shares of it above which the signal is clipped in the
/// first and in the last.
const ROUNDS: usize = 300;
const CLIPPED: [f64; 2] = [0.7, 0.98];

/// Sines of one amplitude on lines of a period, their phases such that the sum has a low peak.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Multisine {
    /// Greatest value, in the unit of the command.
    pub amplitude: f64,
    /// Samples of a period: the lines are the sampling rate over it apart.
    pub period: usize,
    /// Lowest frequency, Hz.
    pub from_hz: f64,
    /// Highest frequency, Hz.
    pub to_hz: f64,
    /// Ratio of one line to the next at least; 1 for all lines. With 1.02 the low frequencies have
    /// all lines and the high ones have fewer and stronger.
    pub ratio: f64,
    /// Of the phases at the start.
    pub seed: u64,
}

impl Default for Multisine {
    fn default() -> Self {
        Self {
            amplitude: 1.0,
            period: 8192,
            from_hz: 2.0,
            to_hz: 1000.0,
            ratio: 1.0,
            seed: 0,
        }
    }
}

impl Multisine {
    /// The lines that carry a sine, as multiples of the rate over the period.
    ///
    /// # Errors
    /// [`ResponseError::Setting`] where there is none, or a number is not valid.
    pub fn lines(&self, rate_hz: f64) -> Result<Vec<usize>, ResponseError> {
        let refused = |name, value, valid| Err(ResponseError::Setting { name, value, valid });
        super::check_rate(rate_hz)?;
        if !(8..=LONGEST).contains(&self.period) {
            let valid = "8 to 4194304 samples";
            return refused("the period", self.period as f64, valid);
        }
        if !(1.0..=10.0).contains(&self.ratio) {
            return refused("the ratio of lines", self.ratio, "from 1 to 10");
        }
        let step = rate_hz / self.period as f64;
        let top = self.to_hz / step;
        if !(self.from_hz >= 0.0 && self.to_hz <= 0.5 * rate_hz && self.from_hz <= self.to_hz) {
            let valid = "from the lowest frequency to half the sampling rate, Hz";
            return refused("the highest frequency", self.to_hz, valid);
        }
        let mut all: Vec<usize> = Vec::new();
        let mut next = (self.from_hz / step).ceil().max(1.0);
        // Not at half the rate: a sine there has no phase.
        while next <= top && 2.0 * next < self.period as f64 {
            all.push(next as usize);
            next = (next * self.ratio).ceil().max(next + 1.0);
        }
        match all.is_empty() {
            true => refused(
                "the highest frequency",
                self.to_hz,
                "one line of the period at least",
            ),
            false => Ok(all),
        }
    }

    /// Random phases, then clipped and the amplitudes of the lines restored, in turns: E. van der
    /// Ouderaa, J. Schoukens, J. Renneboog, IEEE Transactions on Instrumentation and Measurement 37
    /// (1988) 145–147, doi:10.1109/19.2684. The best of all rounds is taken.
    pub(super) fn samples(&self, rate_hz: f64, count: usize) -> Result<Vec<f64>, ResponseError> {
        check_amplitude(self.amplitude)?;
        let lines = self.lines(rate_hz)?;
        let n = self.period;
        let (forward, inverse) = (axis_fourier::forward(n), axis_fourier::inverse(n));
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        // 53 bits: uniform in [0, 1).
        let mut phase = || TAU * (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        let mut spectrum = vec![Complex::new(0.0, 0.0); n / 2 + 1];
        for line in &lines {
            spectrum[*line] = Complex::from_polar(1.0, phase());
        }
        let mut best = (f64::INFINITY, Vec::new());
        let mut signal = vec![0.0; n];
        for round in 0..ROUNDS {
            let mut used = spectrum.clone();
            // Its lengths are those of the plan, and its ends are real.
            let _ = inverse.process(&mut used, &mut signal);
            let peak = signal.iter().fold(0.0_f64, |peak, x| peak.max(x.abs()));
            if peak < best.0 {
                best = (peak, signal.clone());
            }
            let part = round as f64 / ROUNDS as f64;
            let most = peak * (CLIPPED[0] + part * (CLIPPED[1] - CLIPPED[0]));
            let mut clipped: Vec<f64> = signal.iter().map(|x| x.clamp(-most, most)).collect();
            let _ = forward.process(&mut clipped, &mut used);
            for line in &lines {
                spectrum[*line] = Complex::from_polar(1.0, used[*line].arg());
            }
        }
        let (peak, signal) = best;
        let scale = self.amplitude / peak;
        Ok((0..count).map(|k| scale * signal[k % n]).collect())
    }
}
