//! Figures of an error sequence: greatest, mean and root-mean-square magnitude.
//!
//! Each is taken over the samples as they stand, every sample counting alike
//! (no integration over time): the definition that tables of maximum and mean
//! tracking error use. Sums run in order, so that the same samples give the
//! same bits.

use thiserror::Error;

/// Samples from which no figure can be taken.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum MetricError {
    /// No samples.
    #[error("no samples: an error figure needs at least one")]
    Empty,
    /// A sample, or a difference of two samples, that is NaN or infinite.
    #[error("sample {index} is {value}: it must be a finite number")]
    NotFinite {
        /// Index of the sample, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Reference and actual of unequal length.
    #[error("{reference} reference samples and {actual} actual samples: the numbers must agree")]
    Length {
        /// Samples of the reference.
        reference: usize,
        /// Samples of the actual.
        actual: usize,
    },
}

/// Greatest, mean and root-mean-square magnitude of an error, in its own unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorSummary {
    /// max |e|.
    pub max: f64,
    /// (1/N) Σ |e|.
    pub mean: f64,
    /// sqrt((1/N) Σ e²).
    pub rms: f64,
}

impl ErrorSummary {
    /// The figures of an error sequence of any length from 1.
    ///
    /// # Errors
    /// [`MetricError::Empty`] or [`MetricError::NotFinite`].
    pub fn of(errors: &[f64]) -> Result<Self, MetricError> {
        Ok(Self {
            max: max_abs(errors)?,
            mean: mean_abs(errors)?,
            rms: rms(errors)?,
        })
    }

    /// The figures of `reference − actual`, sample by sample.
    ///
    /// # Errors
    /// [`MetricError::Length`] if the two differ in length, and those of
    /// [`of`](Self::of).
    pub fn between(reference: &[f64], actual: &[f64]) -> Result<Self, MetricError> {
        if reference.len() != actual.len() {
            return Err(MetricError::Length {
                reference: reference.len(),
                actual: actual.len(),
            });
        }
        let errors: Vec<f64> = reference.iter().zip(actual).map(|(r, a)| r - a).collect();
        Self::of(&errors)
    }
}

/// max |e| over the samples.
///
/// # Errors
/// [`MetricError::Empty`] or [`MetricError::NotFinite`].
pub fn max_abs(errors: &[f64]) -> Result<f64, MetricError> {
    check(errors)?;
    Ok(errors.iter().fold(0.0, |m, e| e.abs().max(m)))
}

/// (1/N) Σ |e| over the samples.
///
/// # Errors
/// [`MetricError::Empty`] or [`MetricError::NotFinite`].
pub fn mean_abs(errors: &[f64]) -> Result<f64, MetricError> {
    let max = max_abs(errors)?;
    Ok(max * mean_of(errors, max, f64::abs))
}

/// sqrt((1/N) Σ e²) over the samples.
///
/// # Errors
/// [`MetricError::Empty`] or [`MetricError::NotFinite`].
pub fn rms(errors: &[f64]) -> Result<f64, MetricError> {
    let max = max_abs(errors)?;
    Ok(max * mean_of(errors, max, |r| r * r).sqrt())
}

/// Mean of `term(e / max)`, in [0, 1]. Taken relative to the greatest
/// magnitude, squares and sums neither overflow nor vanish, whatever the unit.
/// Capped at 1 because the rounded sum may exceed it by an ulp, and a mean
/// above the maximum would look wrong in a table.
fn mean_of(errors: &[f64], max: f64, term: impl Fn(f64) -> f64) -> f64 {
    if max == 0.0 {
        return 0.0;
    }
    let sum: f64 = errors.iter().map(|e| term(e / max)).sum();
    (sum / errors.len() as f64).min(1.0)
}

fn check(errors: &[f64]) -> Result<(), MetricError> {
    if errors.is_empty() {
        return Err(MetricError::Empty);
    }
    match errors.iter().position(|e| !e.is_finite()) {
        Some(index) => Err(MetricError::NotFinite {
            index,
            value: errors[index],
        }),
        None => Ok(()),
    }
}
