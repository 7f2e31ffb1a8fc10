//! What can be wrong with the parameters of a motor, controller or inverter.

use axis_scalar::Scalar;

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
    /// A table's list has the wrong number of entries.
    #[error("{field} has {length} entries, which is not valid: must be {valid}")]
    TableShape {
        /// The list's name.
        field: &'static str,
        /// How many entries it has.
        length: usize,
        /// What would be valid, in words.
        valid: &'static str,
    },
    /// The flux linkage of a table does not grow with the current.
    #[error(
        "the cell between rows {row} and {row} + 1, columns {column} and {column} + 1 is not \
         valid: flux_d must grow with id, flux_q with iq, and both together"
    )]
    FoldedCell {
        /// The cell's first row, counted from 0.
        row: usize,
        /// The cell's first column, counted from 0.
        column: usize,
    },
}

/// Subnormal numbers are refused too: their reciprocals overflow.
pub(crate) fn positive<T: Scalar>(field: &'static str, value: T) -> Result<T, FocError> {
    let valid = "finite, greater than 0 and not subnormal";
    let normal = value.is_finite() && value >= T::MIN_POSITIVE;
    check(normal, field, value, valid)
}

pub(crate) fn not_negative<T: Scalar>(field: &'static str, value: T) -> Result<T, FocError> {
    let valid = "finite and 0 or greater";
    let ok = value.is_finite() && value >= T::ZERO;
    check(ok, field, value, valid)
}

/// A limit: infinity is allowed and means that there is none.
pub(crate) fn limit<T: Scalar>(field: &'static str, value: T) -> Result<T, FocError> {
    let valid = "greater than 0 (infinity: no limit)";
    check(value > T::ZERO, field, value, valid)
}

pub(crate) fn check<T: Scalar>(
    ok: bool,
    field: &'static str,
    value: T,
    valid: &'static str,
) -> Result<T, FocError> {
    if ok {
        return Ok(value);
    }
    Err(FocError::OutOfRange {
        field,
        value: value.to_f64(),
        valid,
    })
}
