//! What motions need of their scalar beyond arithmetic.

use scalar::Scalar;

/// A scalar that motions can be planned and sampled in: `f64` or `f32`.
pub trait Real: Scalar {
    /// Most cycles of one sine or chirp. Above, the phase has lost a millionth of a cycle to
    /// rounding, in `f32` a thousandth.
    const MAX_CYCLES: Self;

    /// [`MAX_CYCLES`](Self::MAX_CYCLES) for the error of an oscillation with more.
    const VALID_CYCLES: &'static str;

    /// By which fraction an oscillation's bounds lie above its exact ones, for what its evaluation
    /// rounds.
    const BOUND_MARGIN: Self;

    /// Whether `0 ≤ self < end`, for an `end` that is not negative; false for NaN and for a zero
    /// with its sign set.
    ///
    /// The bits of numbers that are not negative order as the numbers do; a sign bit or NaN makes
    /// them greater than any number. So it is one comparison of integers.
    #[must_use]
    fn is_before(self, end: Self) -> bool;

    /// The number of so many.
    #[must_use]
    fn count(number: u32) -> Self;

    /// `ln(1 + x)`, without cancellation near 0.
    #[must_use]
    fn ln_1p(self) -> Self;

    /// `√(x² + y²)`, without overflow on the way.
    #[must_use]
    fn hypot(self, other: Self) -> Self;
}

macro_rules! real {
    ($t:ident, $log1p:ident, $hypot:ident, $cycles:literal, $margin:literal) => {
        impl Real for $t {
            const MAX_CYCLES: Self = $cycles;
            const VALID_CYCLES: &'static str = concat!("at most ", stringify!($cycles));
            const BOUND_MARGIN: Self = $margin;

            #[inline(always)]
            fn is_before(self, end: Self) -> bool {
                self.to_bits() < end.to_bits()
            }

            #[inline(always)]
            fn count(number: u32) -> Self {
                number as $t
            }

            #[inline]
            fn ln_1p(self) -> Self {
                libm::$log1p(self)
            }

            #[inline]
            fn hypot(self, other: Self) -> Self {
                libm::$hypot(self, other)
            }
        }
    };
}

real!(f64, log1p, hypot, 1e9, 1e-12);
real!(f32, log1pf, hypotf, 1e4, 1e-5);
