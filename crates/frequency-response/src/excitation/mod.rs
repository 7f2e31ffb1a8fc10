//! What is added to the command so that the machine shows its response.

mod chirp;
mod multisine;
mod prbs;

pub use chirp::{ChirpExcitation, ChirpSweep};
pub use multisine::Multisine;
pub use prbs::Prbs;

use crate::error::{ResponseError, check};

/// Longest signal, samples.
const MOST_SAMPLES: usize = 1 << 27;

/// A signal that is added to the command; its amplitude is in the command's unit.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Excitation {
    /// Pseudo-random binary sequence: all lines, the whole amplitude at every instant.
    Prbs(Prbs),
    /// Sine of rising frequency.
    Chirp(ChirpExcitation),
    /// Sum of sines on chosen lines.
    Multisine(Multisine),
}

impl Excitation {
    /// `count` samples at `rate_hz`. A [`ChirpExcitation`] sweeps once over all of them, the others repeat.
    ///
    /// # Errors
    /// [`ResponseError::Setting`] for a number that is not valid.
    pub fn samples(&self, rate_hz: f64, count: usize) -> Result<Vec<f64>, ResponseError> {
        check_rate(rate_hz)?;
        if count > MOST_SAMPLES {
            let (name, value) = ("the number of samples", count as f64);
            let valid = "at most 134 million";
            return Err(ResponseError::Setting { name, value, valid });
        }
        match self {
            Self::Prbs(prbs) => prbs.samples(count),
            Self::Chirp(chirp) => chirp.samples(rate_hz, count),
            Self::Multisine(sines) => sines.samples(rate_hz, count),
        }
    }

    /// Samples after which it repeats; none for a [`ChirpExcitation`].
    #[must_use]
    pub fn period(&self) -> Option<usize> {
        match self {
            Self::Prbs(prbs) => Some(prbs.period()),
            Self::Chirp(_) => None,
            Self::Multisine(sines) => Some(sines.period),
        }
    }
}

pub(crate) fn check_rate(rate_hz: f64) -> Result<f64, ResponseError> {
    let valid = "above 0 and at most 1e9 Hz";
    check(
        "the sampling rate",
        rate_hz,
        [f64::MIN_POSITIVE, 1e9],
        valid,
    )
}

pub(crate) fn check_amplitude(amplitude: f64) -> Result<f64, ResponseError> {
    let valid = "above 0 and at most 1e9, in the unit of the command";
    check("the amplitude", amplitude, [f64::MIN_POSITIVE, 1e9], valid)
}

/// Smallest number of samples after which a signal repeats itself, where it does so at least twice.
///
/// By the prefix function of Knuth, Morris and Pratt (SIAM Journal on Computing 6 (1977) 323–350,
/// doi:10.1137/0206024): a series of n samples whose longest border (beginning that is its end too)
/// has b samples repeats after n − b.
#[must_use]
pub fn period_of(signal: &[f64]) -> Option<usize> {
    let n = signal.len();
    let mut border = vec![0usize; n];
    for i in 1..n {
        let mut b = border[i - 1];
        while b > 0 && signal[i] != signal[b] {
            b = border[b - 1];
        }
        border[i] = b + usize::from(signal[i] == signal[b]);
    }
    let period = n - border.last()?;
    (period > 1 && 2 * period <= n).then_some(period)
}
