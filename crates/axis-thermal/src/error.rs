//! What is refused, and what would be valid.

use thiserror::Error;

/// Why a thermal model or a duty was refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ThermalError {
    /// A number is outside its range.
    #[error("{name} is {value} {unit}; valid: {valid}")]
    Invalid {
        /// Which number.
        name: &'static str,
        /// As given.
        value: f64,
        /// Its unit; empty for none.
        unit: &'static str,
        /// What would be valid.
        valid: &'static str,
    },
    /// A value of a log is not a number.
    #[error("the {channel} in stretch {stretch} of the log is {value}; valid: finite")]
    Log {
        /// Number of the stretch, from 1.
        stretch: usize,
        /// Which of its values.
        channel: &'static str,
        /// As given.
        value: f64,
    },
    /// A duty was recorded for another screw.
    #[error(
        "the duty has {found} places along the screw, and the model has {expected}; valid: a duty that begins as ThermalModel::duty of this model"
    )]
    OtherPlaces {
        /// Of the duty.
        found: usize,
        /// Of the model.
        expected: usize,
    },
    /// A duty has no time in it.
    #[error("the duty has no duration; valid: at least one part that lasts longer than 0 s")]
    NoDuration,
    /// The heat does not settle: losses that grow faster with temperature than they are carried off.
    #[error(
        "after {time} s the losses grow faster than they are carried off ({temperature} °C); valid: laws of friction and resistance that let the temperature settle, or larger conductances"
    )]
    RunsAway {
        /// When it was given up, s.
        time: f64,
        /// Greatest temperature then, °C.
        temperature: f64,
    },
}

/// A number that must lie in a range.
pub(crate) fn check(
    inside: bool,
    name: &'static str,
    value: f64,
    unit: &'static str,
    valid: &'static str,
) -> Result<(), ThermalError> {
    match inside {
        true => Ok(()),
        false => Err(ThermalError::Invalid {
            name,
            value,
            unit,
            valid,
        }),
    }
}
