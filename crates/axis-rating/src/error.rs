//! Why a rating cannot be computed.

use thiserror::Error;

/// A number that makes no rating.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RatingError {
    /// A number outside what it can be.
    #[error("{name} is {value}; valid: {valid}")]
    Invalid {
        /// The quantity, with its unit.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A motor curve that is no curve.
    #[error(
        "the motor curve {what}; valid: at least one point, speeds from 0 upwards without doubles, torques of 0 or above, one of them above 0"
    )]
    Curve {
        /// What is wrong.
        what: &'static str,
    },
}

/// A number above 0.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, RatingError> {
    let valid = "a finite number above 0";
    match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => Err(RatingError::Invalid { name, value, valid }),
    }
}

/// A number that is 0 or above.
pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<f64, RatingError> {
    let valid = "a finite number, 0 or above";
    match value.is_finite() && value >= 0.0 {
        true => Ok(value),
        false => Err(RatingError::Invalid { name, value, valid }),
    }
}

/// A finite number.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, RatingError> {
    let valid = "a finite number";
    match value.is_finite() {
        true => Ok(value),
        false => Err(RatingError::Invalid { name, value, valid }),
    }
}
