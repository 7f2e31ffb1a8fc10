//! From a sampled record at constant speed to the numbers that a fit needs.

use super::error::{FrictionIdentifyError, check_finite, check_positive};
use super::series::Series;

/// One run at (nominally) constant speed, at the friction's location.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantSpeedRun {
    /// Mean speed with its sign, rad/s.
    pub speed: f64,
    /// Standard error of `speed`, rad/s, greater than 0; `None` if it is not
    /// known.
    pub speed_standard_error: Option<f64>,
    /// Mean friction torque with its sign, N·m.
    pub torque: f64,
    /// Standard error of `torque`, N·m, greater than 0; `None` if it is not
    /// known.
    pub torque_standard_error: Option<f64>,
    /// Amplitude of the coherent oscillation of the speed, as a fraction of
    /// the mean speed; 0 if there is nothing but noise.
    pub vibration: f64,
    /// Frequency of that oscillation, Hz; 0 if there is none.
    pub vibration_frequency: f64,
}

/// Samples below which neither a standard error nor a vibration shows.
const FEWEST: usize = 64;

impl ConstantSpeedRun {
    /// Condenses the settled part of a record: `speeds` (rad/s) and `torques`
    /// (N·m), sampled together at `sample_rate` (Hz).
    ///
    /// *Standard errors.* Neighbouring samples are correlated, so the mean of
    /// `n` of them is as good as that of `n / τ` independent ones, with
    /// `τ = 1 + 2 Σ ρ_k` summed up to the first lag beyond `5 τ` (A. Sokal's
    /// window); `τ ≥ 1` for the torque, `τ ≥ 5/√n` for the speed, which may be
    /// a position's differences and its noise then cancel. Samples that are
    /// all equal show no scatter, which may be the sensor's resolution: their
    /// standard error is not known.
    ///
    /// *Vibration.* Noise forgets, an oscillation does not: at lags of 32 to
    /// 128 ms the autocovariance of noise that is white, differenced or
    /// filtered (above some 20 Hz) has decayed, while that of an oscillation of
    /// amplitude `A` still swings by `A²/2`. Its largest magnitude there gives
    /// `A`. Noise itself leaves correlations of standard deviation
    /// `√(Σ ρ_j² / n)` there (M. S. Bartlett's formula, summed over the lags up
    /// to 32 ms, less what the oscillation found contributes); below 4.5 of
    /// these `vibration` is 0 (at most 97 lags are looked at: less than one
    /// false alarm in a thousand records). More than half of the variance is
    /// always a vibration. The lags are at least 8 to 32 samples, and end at a
    /// quarter of the record where that is sooner. The frequency is that of the
    /// cosine that fits the autocovariance at these lags best; up to half the
    /// sample rate or 500 Hz.
    ///
    /// # Errors
    /// [`FrictionIdentifyError`] when the channels differ in length, are shorter than
    /// 64 samples, hold a number that is not finite or beyond 1e100, or when
    /// `sample_rate` is not positive.
    pub fn from_record(
        speeds: &[f64],
        torques: &[f64],
        sample_rate: f64,
    ) -> Result<Self, FrictionIdentifyError> {
        check_positive("sample_rate", sample_rate)?;
        if speeds.len() != torques.len() {
            return Err(FrictionIdentifyError::LengthMismatch {
                motion: speeds.len(),
                torque: torques.len(),
            });
        }
        if speeds.len() < FEWEST {
            return Err(FrictionIdentifyError::TooFewSamples {
                found: speeds.len(),
                needed: FEWEST,
            });
        }
        check_finite("speeds", speeds)?;
        check_finite("torques", torques)?;
        let (speed, torque) = (Series::of(speeds), Series::of(torques));
        let (vibration, frequency) = match speed.oscillation(sample_rate) {
            Some(found) => (found.amplitude / speed.mean.abs(), found.frequency),
            None => (0.0, 0.0),
        };
        Ok(Self {
            speed: speed.mean,
            speed_standard_error: speed.standard_error(true),
            torque: torque.mean,
            torque_standard_error: torque.standard_error(false),
            vibration,
            vibration_frequency: frequency,
        })
    }

    /// Whether the mean speed cannot be told from zero: it is zero, or at most
    /// five of its standard errors.
    ///
    /// A sensor's noise and its resolution both scatter the samples and so
    /// raise the standard error: one count that flickers at rest leaves a mean
    /// of about one standard error, and a creep of `k` counts, all one way, one
    /// of √k. A constant offset of the sensor is not seen.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.speed.abs() <= 5.0 * self.speed_standard_error.unwrap_or(0.0)
    }
}
