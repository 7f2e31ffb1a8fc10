//! Why a motion was refused.

use crate::maximum;

/// Why limits, a step or a program were refused. All checks are made at construction: evaluation
/// cannot fail.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrajectoryError {
    /// One value lies outside what is valid for it.
    #[error("{field} is {value} {unit}, but must be {valid}")]
    Invalid {
        /// Name of the field, as in this crate's structs.
        field: &'static str,
        /// The value given, in SI units.
        value: f64,
        /// SI unit of the value; empty for a pure number.
        unit: &'static str,
        /// What would be valid.
        valid: &'static str,
    },
    /// Each value is valid alone, but the motion they describe overflows or underflows `f64`.
    #[error("{what} does not fit a 64-bit float: the values given are too far apart in magnitude")]
    Unrepresentable {
        /// The quantity that has no finite (or no non-zero) value.
        what: &'static str,
    },
    /// A step of a program was refused.
    #[cfg(feature = "alloc")]
    #[error("step {number} ({kind}): {source}")]
    Step {
        /// Which step, counted from 1.
        number: usize,
        /// Kind of the step: `move`, `move_by`, `dwell`, `sine` or `chirp`.
        kind: &'static str,
        /// What is wrong with it.
        source: alloc::boxed::Box<TrajectoryError>,
    },
}

/// `value` (m) if it lies within [`maximum::POSITION`] of zero.
pub(crate) fn position(field: &'static str, value: f64) -> Result<f64, TrajectoryError> {
    let inside = value.abs() <= maximum::POSITION;
    check(inside, field, value, "m", "from -1e6 to 1e6")
}

/// `value` (Hz) if it is a frequency of an oscillation.
pub(crate) fn frequency(field: &'static str, value: f64) -> Result<f64, TrajectoryError> {
    let inside = (1e-9..=maximum::FREQUENCY).contains(&value);
    check(inside, field, value, "Hz", "from 1e-9 to 1e6")
}

/// `value` (s) if it is greater than zero and at most [`maximum::DURATION`].
pub(crate) fn duration(value: f64) -> Result<f64, TrajectoryError> {
    let inside = value > 0.0 && value <= maximum::DURATION;
    let valid = "greater than zero and at most 1e7";
    check(inside, "duration", value, "s", valid)
}

/// `value` if `holds`, else an error that says what would be valid.
pub(crate) fn check(
    holds: bool,
    field: &'static str,
    value: f64,
    unit: &'static str,
    valid: &'static str,
) -> Result<f64, TrajectoryError> {
    if holds {
        Ok(value)
    } else {
        Err(TrajectoryError::Invalid {
            field,
            value,
            unit,
            valid,
        })
    }
}
