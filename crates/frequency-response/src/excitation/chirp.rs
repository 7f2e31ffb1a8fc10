//! Sines of rising frequency.

use std::f64::consts::TAU;

use super::check_amplitude;
use crate::error::{ResponseError, check};

/// How the frequency of a [`ChirpExcitation`] goes over time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum ChirpSweep {
    /// f = f₀ + (f₁ − f₀) t/T: the same power for each Hz.
    #[default]
    Linear,
    /// f = f₀ (f₁/f₀)^(t/T): the same power for each octave.
    Logarithmic,
}

/// A sine whose frequency goes once from one end to the other; it begins with 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ChirpExcitation {
    /// In the unit of the command.
    pub amplitude: f64,
    /// Frequency at the start, Hz.
    pub from_hz: f64,
    /// Frequency at the end, Hz.
    pub to_hz: f64,
    /// How it goes from one to the other.
    pub sweep: ChirpSweep,
}

impl Default for ChirpExcitation {
    fn default() -> Self {
        Self {
            amplitude: 1.0,
            from_hz: 2.0,
            to_hz: 1000.0,
            sweep: ChirpSweep::Linear,
        }
    }
}

impl ChirpExcitation {
    pub(super) fn samples(&self, rate_hz: f64, count: usize) -> Result<Vec<f64>, ResponseError> {
        check_amplitude(self.amplitude)?;
        let valid = "above 0 and at most half the sampling rate, Hz";
        for (name, value) in [
            ("the frequency at the start", self.from_hz),
            ("the frequency at the end", self.to_hz),
        ] {
            check(name, value, [f64::MIN_POSITIVE, 0.5 * rate_hz], valid)?;
        }
        let duration = count as f64 / rate_hz;
        let [from, to] = [self.from_hz, self.to_hz];
        // Integrals of the two frequencies.
        let rate = (to / from).ln() / duration;
        let cycles = |t: f64| match self.sweep {
            ChirpSweep::Logarithmic if rate != 0.0 => from * (rate * t).exp_m1() / rate,
            ChirpSweep::Logarithmic => from * t,
            ChirpSweep::Linear => t * (from + 0.5 * (to - from) * t / duration),
        };
        let value = |k: usize| self.amplitude * (TAU * cycles(k as f64 / rate_hz).fract()).sin();
        Ok((0..count).map(value).collect())
    }
}
