//! What can be wrong with a drive, and the checks that say so.

use beam_fem::BeamError;
use thiserror::Error;

/// What can be wrong with a drive or with a question about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DriveError {
    /// A parameter lies outside its range.
    #[error("{name} = {value} is not valid: it must be {valid}")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// The value given.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A table position beyond the screw's ends.
    #[error("table position {position} m is off the screw: it must lie between 0 and {length} m")]
    OffScrew {
        /// The position asked for, m.
        position: f64,
        /// Length of the screw, m.
        length: f64,
    },
    /// The beam model refused its input or did not solve.
    #[error(transparent)]
    Beam(#[from] BeamError),
    /// The dynamic stiffness is singular (a resonance without damping, or zero frequency).
    #[error(
        "the dynamic stiffness at {angular_frequency} rad/s is singular: ask off the resonance, above zero"
    )]
    Singular {
        /// The frequency asked for, rad/s.
        angular_frequency: f64,
    },
}

/// Refuses each value that is not finite and above zero.
pub(crate) fn positive<const N: usize>(fields: [(&'static str, f64); N]) -> Result<(), DriveError> {
    let bad = |value: f64| !(value.is_finite() && value > 0.0);
    refuse_first(fields, bad, "finite and above zero")
}

/// Refuses each value that is not finite, or below zero.
pub(crate) fn not_negative<const N: usize>(
    fields: [(&'static str, f64); N],
) -> Result<(), DriveError> {
    let bad = |value: f64| !(value.is_finite() && value >= 0.0);
    refuse_first(fields, bad, "finite and not negative")
}

/// Refuses each value that is not finite.
pub(crate) fn finite<const N: usize>(fields: [(&'static str, f64); N]) -> Result<(), DriveError> {
    refuse_first(fields, |value| !value.is_finite(), "finite")
}

/// Refuses an angular frequency, rad/s, of which no response can be computed: one that is
/// no number, infinite, or whose fourth power, which goes into a response, is.
pub(crate) fn frequency(value: f64) -> Result<f64, DriveError> {
    if value.powi(4).is_finite() {
        return Ok(value);
    }
    Err(DriveError::Parameter {
        name: "angular frequency",
        value,
        valid: "finite, and so its fourth power",
    })
}

fn refuse_first<const N: usize>(
    fields: [(&'static str, f64); N],
    bad: impl Fn(f64) -> bool,
    valid: &'static str,
) -> Result<(), DriveError> {
    match fields.into_iter().find(|(_, value)| bad(*value)) {
        None => Ok(()),
        Some((name, value)) => Err(DriveError::Parameter { name, value, valid }),
    }
}
