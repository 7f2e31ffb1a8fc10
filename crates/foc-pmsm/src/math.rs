//! The three functions that `core` lacks.

/// Square root. IEEE 754 rounds it correctly, so both versions give the same
/// bits; `std` only spares the call.
#[cfg(feature = "std")]
#[inline]
pub(crate) fn sqrt(x: f64) -> f64 {
    x.sqrt()
}

/// Square root, without `std`.
#[cfg(not(feature = "std"))]
#[inline]
pub(crate) fn sqrt(x: f64) -> f64 {
    libm::sqrt(x)
}

/// Sine and cosine, `(sin x, cos x)`, always from `libm`: the system's own
/// differ in the last bit from one platform to the next.
#[inline]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}
