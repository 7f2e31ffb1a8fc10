//! The functions that [`Scalar`] lacks.

use axis_scalar::Scalar;

/// `x` between two bounds; what is not a number passes, which `min` and `max`
/// would hide.
#[inline]
pub(crate) fn clamp<T: Scalar>(x: T, low: T, high: T) -> T {
    let above = if x < low { low } else { x };
    if above > high { high } else { above }
}
