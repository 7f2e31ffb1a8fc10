//! Why a motion was refused.

use axis_scalar::Scalar;

use crate::{Real, maximum};

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
        /// The value given, in SI units, exactly, whatever the scalar.
        value: f64,
        /// SI unit of the value; empty for a pure number.
        unit: &'static str,
        /// What would be valid.
        valid: &'static str,
    },
    /// Each value is valid alone, but the motion they describe overflows or underflows the
    /// scalar.
    #[error(
        "{what} does not fit a {bits}-bit float: the values given are too far apart in magnitude"
    )]
    Unrepresentable {
        /// The quantity that has no finite (or no non-zero) value.
        what: &'static str,
        /// Size of the scalar, bits.
        bits: usize,
    },
    /// A motion leaves the positions that it is allowed.
    #[error(
        "the motion reaches {position} m, but must stay from {position_min} to {position_max} m"
    )]
    LeavesRange {
        /// The farthest position that lies outside, m.
        position: f64,
        /// Least position allowed, m.
        position_min: f64,
        /// Greatest position allowed, m.
        position_max: f64,
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
pub(crate) fn position<T: Scalar>(field: &'static str, value: T) -> Result<T, TrajectoryError> {
    let inside = value.abs() <= T::of(maximum::POSITION);
    check(inside, field, value, "m", "from -1e9 to 1e9")
}

/// `value` if its magnitude is at most `most`.
pub(crate) fn bounded<T: Scalar>(
    field: &'static str,
    value: T,
    most: f64,
    unit: &'static str,
    valid: &'static str,
) -> Result<T, TrajectoryError> {
    check(value.abs() <= T::of(most), field, value, unit, valid)
}

/// `value` (Hz) if it is a frequency of an oscillation.
pub(crate) fn frequency<T: Scalar>(field: &'static str, value: T) -> Result<T, TrajectoryError> {
    let inside = (T::of(1e-9)..=T::of(maximum::FREQUENCY)).contains(&value);
    check(inside, field, value, "Hz", "from 1e-9 to 1e6")
}

/// `value` (s) if it is greater than zero and at most [`maximum::DURATION`].
pub(crate) fn duration<T: Scalar>(value: T) -> Result<T, TrajectoryError> {
    let inside = value > T::ZERO && value <= T::of(maximum::DURATION);
    let valid = "greater than zero and at most 1e7";
    check(inside, "duration", value, "s", valid)
}

/// `value` (s) if it is the duration of a motion that was planned; `what` says which.
pub(crate) fn planned<T: Real>(value: T, what: &'static str) -> Result<T, TrajectoryError> {
    if !value.is_finite() {
        return Err(unrepresentable::<T>(what));
    }
    let inside = value <= T::of(maximum::DURATION);
    check(inside, "duration", value, "s", "at most 1e7")
}

/// `value` if `holds`, else an error that says what would be valid.
pub(crate) fn check<T: Scalar>(
    holds: bool,
    field: &'static str,
    value: T,
    unit: &'static str,
    valid: &'static str,
) -> Result<T, TrajectoryError> {
    if holds {
        Ok(value)
    } else {
        Err(TrajectoryError::Invalid {
            field,
            value: value.to_f64(),
            unit,
            valid,
        })
    }
}

/// That `what` has no finite, or no non-zero, value in the scalar.
pub(crate) fn unrepresentable<T>(what: &'static str) -> TrajectoryError {
    let bits = 8 * size_of::<T>();
    TrajectoryError::Unrepresentable { what, bits }
}
