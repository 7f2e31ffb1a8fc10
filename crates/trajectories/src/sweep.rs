//! How the frequency of an oscillation runs over time.

use core::f64::consts::TAU;

use crate::Real;

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
pub(crate) enum Phase<T> {
    /// Constant frequency, or one that changes at `slope` Hz/s.
    Linear { frequency: T, slope: T },
    /// Frequency that grows at the relative `rate` 1/s, not zero.
    Exponential { frequency: T, rate: T },
}

impl<T: Real> Phase<T> {
    /// From frequency `f0` to `f1` (Hz, greater than zero) over `duration` (s).
    pub fn new(f0: T, f1: T, duration: T, sweep: Sweep) -> Self {
        // log1p keeps the digits of a ratio near one.
        let rate = ((f1 - f0) / f0).ln_1p() / duration;
        if sweep == Sweep::Logarithmic && rate != T::ZERO {
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
    pub fn cycles(&self, t: T) -> T {
        match *self {
            Self::Linear { frequency, slope } => t * (frequency + T::HALF * slope * t),
            Self::Exponential { frequency, rate } => frequency * (rate * t).exp_m1() / rate,
        }
    }

    /// First three time derivatives of the phase in radians, at `t` (s).
    ///
    /// Each is monotone in t, on which the bounds of an oscillation rely.
    #[inline]
    pub fn derivatives(&self, t: T) -> [T; 3] {
        let tau = T::of(TAU);
        match *self {
            Self::Linear { frequency, slope } => {
                [tau * (frequency + slope * t), tau * slope, T::ZERO]
            }
            Self::Exponential { frequency, rate } => {
                let omega = tau * frequency * (rate * t).exp();
                [omega, omega * rate, omega * rate * rate]
            }
        }
    }

    /// Sine and cosine of the phase at `t`.
    ///
    /// Whole cycles are dropped before multiplying by 2π, which keeps the digits of long runs.
    #[inline]
    pub fn sin_cos(&self, t: T) -> (T, T) {
        let cycles = self.cycles(t);
        (cycles - cycles.floor()).sin_cos_turn()
    }
}
