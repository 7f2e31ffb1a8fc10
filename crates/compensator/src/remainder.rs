//! What is left between two positions and a way.

use axis_scalar::Scalar;

/// `to − (from + way)` for positions (m) that lie a few µm apart.
///
/// In `f32` the last place of 0.9 m is 0.06 µm, more than a cycle's way rounds
/// to: there the difference of the positions comes first, which is exact (both
/// lie within a factor of two). In `f64` it is 1e-16 m, and the order is that of
/// the equations.
#[inline]
pub(crate) fn remainder<T: Scalar>(to: T, from: T, way: T) -> T {
    let coarse = T::EPSILON > T::of(1e-10);
    if coarse {
        (to - from) - way
    } else {
        to - (from + way)
    }
}
