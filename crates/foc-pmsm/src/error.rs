//! What can be wrong with the parameters of a motor, controller or inverter.

/// Why a law could not be built. Nothing after construction can fail.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FocError {
    /// A number is NaN, infinite or outside the range that has a meaning.
    #[error("{field} = {value} is not valid: must be {valid}")]
    OutOfRange {
        /// The field's name, as in the parameter struct.
        field: &'static str,
        /// The value that was given, in the field's unit.
        value: f64,
        /// What would be valid, in words.
        valid: &'static str,
    },
    /// A motor needs at least one pole pair.
    #[error("pole_pairs = 0 is not valid: must be 1 or more")]
    NoPolePairs,
}

/// Subnormal numbers are refused too: their reciprocals overflow.
pub(crate) fn positive(field: &'static str, value: f64) -> Result<f64, FocError> {
    let valid = "finite, greater than 0 and not subnormal";
    check(value.is_normal() && value > 0.0, field, value, valid)
}

pub(crate) fn not_negative(field: &'static str, value: f64) -> Result<f64, FocError> {
    let valid = "finite and 0 or greater";
    check(value.is_finite() && value >= 0.0, field, value, valid)
}

/// A limit: infinity is allowed and means that there is none.
pub(crate) fn limit(field: &'static str, value: f64) -> Result<f64, FocError> {
    check(
        value > 0.0,
        field,
        value,
        "greater than 0 (infinity: no limit)",
    )
}

pub(crate) fn check(
    ok: bool,
    field: &'static str,
    value: f64,
    valid: &'static str,
) -> Result<f64, FocError> {
    if ok {
        Ok(value)
    } else {
        Err(FocError::OutOfRange {
            field,
            value,
            valid,
        })
    }
}
