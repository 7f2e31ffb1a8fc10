//! Why a motion was refused.

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

/// `value` if it is finite.
pub(crate) fn finite(
    field: &'static str,
    value: f64,
    unit: &'static str,
) -> Result<f64, TrajectoryError> {
    check(value.is_finite(), field, value, unit, "finite")
}

/// `value` if it is finite and greater than zero.
pub(crate) fn positive(
    field: &'static str,
    value: f64,
    unit: &'static str,
) -> Result<f64, TrajectoryError> {
    let valid = value.is_finite() && value > 0.0;
    check(valid, field, value, unit, "finite and greater than zero")
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
