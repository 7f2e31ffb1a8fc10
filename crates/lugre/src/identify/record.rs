//! From a sampled record at constant speed to the numbers that a fit needs.

use super::error::{IdentifyError, check_finite, check_positive};

/// One run at (nominally) constant speed, at the friction's location.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantSpeedRun {
    /// Mean speed with its sign, rad/s.
    pub speed: f64,
    /// Mean friction torque with its sign, N·m.
    pub torque: f64,
    /// Standard error of `torque`, N·m; 0 where it is not known.
    pub torque_standard_error: f64,
    /// Amplitude of the coherent oscillation of the speed, as a fraction of
    /// the mean speed; 0 where there is nothing but noise.
    pub vibration: f64,
    /// Frequency of that oscillation, Hz; 0 where there is none.
    pub vibration_frequency: f64,
}

/// Samples below which neither a standard error nor a vibration shows.
const FEWEST: usize = 64;

impl ConstantSpeedRun {
    /// Condenses the settled part of a record: `speeds` (rad/s) and `torques`
    /// (N·m), sampled together at `sample_rate` (Hz).
    ///
    /// *Standard error.* Neighbouring samples are correlated, so the mean of
    /// `n` of them is as good as that of `n / τ` independent ones, with
    /// `τ = 1 + 2 Σ ρ_k` summed up to the first lag beyond `5 τ` (A. Sokal's
    /// window), and `τ ≥ 1`.
    ///
    /// *Vibration.* Noise forgets, an oscillation does not: at lags of 32 to
    /// 128 samples the autocovariance of noise that is white, differenced or
    /// shortly filtered has decayed, while that of an oscillation of amplitude
    /// `A` still swings by `A²/2`. Its largest magnitude there gives `A`. Noise
    /// itself leaves correlations of standard deviation `√(Σ ρ_j² / n)` there
    /// (M. S. Bartlett's formula, summed over |j| ≤ 4); below 4.5 of these
    /// `vibration` is 0 (97 lags: less than one false alarm in a thousand
    /// records). More than half of the variance is always a vibration.
    ///
    /// # Errors
    /// [`IdentifyError`] when the channels differ in length, are shorter than
    /// 64 samples, hold a number that is not finite, or when `sample_rate` is
    /// not positive.
    pub fn from_record(
        speeds: &[f64],
        torques: &[f64],
        sample_rate: f64,
    ) -> Result<Self, IdentifyError> {
        check_positive("sample_rate", sample_rate)?;
        if speeds.len() != torques.len() {
            return Err(IdentifyError::LengthMismatch {
                motion: speeds.len(),
                torque: torques.len(),
            });
        }
        if speeds.len() < FEWEST {
            return Err(IdentifyError::TooFewSamples {
                found: speeds.len(),
                needed: FEWEST,
            });
        }
        check_finite("speeds", speeds)?;
        check_finite("torques", torques)?;
        let (speed, speed_rest) = centred(speeds);
        let (torque, torque_rest) = centred(torques);
        let amplitude = oscillation(&speed_rest);
        let frequency = if amplitude > 0.0 {
            oscillation_frequency(&speed_rest, 0.5 * amplitude, sample_rate)
        } else {
            0.0
        };
        Ok(Self {
            speed,
            torque,
            torque_standard_error: standard_error(&torque_rest),
            vibration: if amplitude > 0.0 {
                amplitude / speed.abs()
            } else {
                0.0
            },
            vibration_frequency: frequency,
        })
    }
}

/// The mean, and the samples without it.
fn centred(samples: &[f64]) -> (f64, Vec<f64>) {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    (mean, samples.iter().map(|s| s - mean).collect())
}

/// Autocovariance of centred samples at one lag, divided by `n` (biased, so
/// that it stays positive definite).
fn autocovariance(rest: &[f64], lag: usize) -> f64 {
    let shifted = &rest[lag..];
    let sum: f64 = rest.iter().zip(shifted).map(|(a, b)| a * b).sum();
    sum / rest.len() as f64
}

/// Standard error of the mean of correlated samples.
pub(super) fn standard_error(rest: &[f64]) -> f64 {
    let n = rest.len();
    let variance = autocovariance(rest, 0);
    if variance <= 0.0 {
        return 0.0;
    }
    let mut tau = 1.0_f64;
    for lag in 1..n / 4 {
        if lag as f64 > 5.0 * tau.max(1.0) {
            break;
        }
        tau += 2.0 * autocovariance(rest, lag) / variance;
    }
    // n − 1: one degree of freedom went into the mean.
    (variance * tau.max(1.0) / (n - 1) as f64).sqrt()
}

/// Amplitude of what is still correlated after noise has been forgotten.
fn oscillation(rest: &[f64]) -> f64 {
    let n = rest.len();
    let variance = autocovariance(rest, 0);
    if variance <= 0.0 {
        return 0.0;
    }
    let last = (n / 4).min(128);
    let lags = last.min(32).min(last / 2)..=last;
    let coherent = lags
        .map(|lag| autocovariance(rest, lag).abs())
        .fold(0.0, f64::max);
    if coherent <= variance * noise_correlation(rest, variance) {
        0.0
    } else {
        (2.0 * coherent).sqrt()
    }
}

/// The largest correlation at long lags that noise alone may leave.
fn noise_correlation(rest: &[f64], variance: f64) -> f64 {
    let squares: f64 = (1..=4)
        .map(|lag| (autocovariance(rest, lag) / variance).powi(2))
        .sum();
    let deviation = ((1.0 + 2.0 * squares) / rest.len() as f64).sqrt();
    (4.5 * deviation).min(0.5)
}

/// Frequency from the upward crossings of `+threshold` that follow one below
/// `−threshold`; 0 if there are fewer than two.
fn oscillation_frequency(rest: &[f64], threshold: f64, sample_rate: f64) -> f64 {
    let mut armed = false;
    let mut crossings = Vec::new();
    for (i, &value) in rest.iter().enumerate() {
        if value < -threshold {
            armed = true;
        } else if armed && value > threshold {
            armed = false;
            crossings.push(i);
        }
    }
    match (crossings.first(), crossings.last()) {
        (Some(&first), Some(&last)) if last > first => {
            (crossings.len() - 1) as f64 * sample_rate / (last - first) as f64
        }
        _ => 0.0,
    }
}
