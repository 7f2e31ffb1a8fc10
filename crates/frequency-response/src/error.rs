//! Why there is no response.

use thiserror::Error;

/// Why an excitation, an estimate or a fit cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ResponseError {
    /// A number is not valid.
    #[error("{name} is {value}; valid: {valid}")]
    Setting {
        /// Of the number.
        name: &'static str,
        /// As given.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A signal has a value that is no number.
    #[error("the {signal} has {value} at sample {index}; valid: finite numbers")]
    NotFinite {
        /// Which signal.
        signal: &'static str,
        /// From 0.
        index: usize,
        /// What stands there.
        value: f64,
    },
    /// Signals are not of the same length.
    #[error("the {signal} has {found} samples and the input {wanted}; valid: as many")]
    Length {
        /// Which signal.
        signal: &'static str,
        /// Its samples.
        found: usize,
        /// Samples of the input.
        wanted: usize,
    },
    /// The record is too short.
    #[error(
        "the record has {found} samples, and {wanted} are needed for two segments; valid: a longer record, or a shorter segment (coarser lines)"
    )]
    TooShort {
        /// Samples that there are.
        found: usize,
        /// Samples that are needed.
        wanted: usize,
    },
    /// A signal that should move does not.
    #[error("the {0} is constant: it excites nothing, so there is no response to estimate")]
    Constant(&'static str),
    /// Too few lines to fit.
    #[error(
        "only {found} lines of the response are within the band and above the coherence asked for, and {wanted} are needed; valid: a wider band, a lower coherence, or a longer record"
    )]
    TooFewLines {
        /// Lines that there are.
        found: usize,
        /// Lines that are needed.
        wanted: usize,
    },
    /// No fit converged.
    #[error(
        "no rational function was found for the response; valid: a band in which its coherence is high"
    )]
    NoFit,
}

/// Refuses a number outside `least..=most`.
pub(crate) fn check(
    name: &'static str,
    value: f64,
    [least, most]: [f64; 2],
    valid: &'static str,
) -> Result<f64, ResponseError> {
    match (least..=most).contains(&value) {
        true => Ok(value),
        false => Err(ResponseError::Setting { name, value, valid }),
    }
}
