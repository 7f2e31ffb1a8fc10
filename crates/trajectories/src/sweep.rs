//! How the frequency of an oscillation runs over time.

use core::f64::consts::TAU;

/// Course of a chirp's frequency from its first to its last value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Sweep {
    /// f(t) = f₀ + (f₁ − f₀) t / T: equal time per hertz.
    #[default]
    Linear,
    /// f(t) = f₀ (f₁ / f₀)^(t / T): equal time per octave.
    Logarithmic,
}

/// Phase of an oscillation, counted in cycles from 0 at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Phase {
    /// Constant frequency, or one that changes at `slope` Hz/s.
    Linear { frequency: f64, slope: f64 },
    /// Frequency that grows at the relative `rate` 1/s, not zero.
    Exponential { frequency: f64, rate: f64 },
}

impl Phase {
    /// From frequency `f0` to `f1` (Hz, greater than zero) over `duration` (s).
    pub fn new(f0: f64, f1: f64, duration: f64, sweep: Sweep) -> Self {
        // log1p keeps the digits of a ratio near one.
        let rate = libm::log1p((f1 - f0) / f0) / duration;
        if sweep == Sweep::Logarithmic && rate != 0.0 {
            return Self::Exponential {
                frequency: f0,
                rate,
            };
        }
        Self::Linear {
            frequency: f0,
            slope: (f1 - f0) / duration,
        }
    }

    /// Cycles passed at time `t` ≥ 0 (s).
    #[inline]
    pub fn cycles(&self, t: f64) -> f64 {
        match *self {
            Self::Linear { frequency, slope } => t * (frequency + 0.5 * slope * t),
            Self::Exponential { frequency, rate } => frequency * libm::expm1(rate * t) / rate,
        }
    }

    /// First three time derivatives of the phase in radians, at `t` (s).
    ///
    /// Each is monotone in t, on which the bounds of an oscillation rely.
    #[inline]
    pub fn derivatives(&self, t: f64) -> [f64; 3] {
        match *self {
            Self::Linear { frequency, slope } => [TAU * (frequency + slope * t), TAU * slope, 0.0],
            Self::Exponential { frequency, rate } => {
                let omega = TAU * frequency * libm::exp(rate * t);
                [omega, omega * rate, omega * rate * rate]
            }
        }
    }

    /// Sine and cosine of the phase at `t`.
    ///
    /// Whole cycles are dropped before multiplying by 2π, which keeps the digits of long runs.
    #[inline]
    pub fn sin_cos(&self, t: f64) -> (f64, f64) {
        let cycles = self.cycles(t);
        libm::sincos(TAU * (cycles - libm::floor(cycles)))
    }
}
