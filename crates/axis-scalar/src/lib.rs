//! `f32` and `f64` behind one trait, for laws that run on a controller.
//!
//! A Cortex-M4F computes `f32` in hardware and `f64` in software, so control
//! laws are generic over their scalar. [`Scalar`] has the arithmetic that they
//! need and the elementary functions of [`libm`], which are the same to the bit
//! on every platform and need no `std`. Of an `f32`, sine, cosine, cube root and hypotenuse
//! are this crate's own, in `f32` and whole numbers, since those of `libm` compute in `f64`.
//!
//! # Errors
//! Of every number, however large, as measured on a hundred million of them, relative
//! to the result (a subnormal one: to the least normal number), in ε = 2⁻²³ for `f32`:
//! square root 0.5, cube root 0.51, eˣ 0.63, eˣ − 1 0.69, logarithm 0.69, hyperbolic
//! tangent 1.4, sine and cosine 1.02. Those of an `f64` are off by 1 ε, ε = 2⁻⁵², or
//! less; its hyperbolic tangent by 2 ε.
//!
//! ```
//! use axis_scalar::Scalar;
//!
//! fn stopping_distance<T: Scalar>(speed: T, deceleration: T) -> T {
//!     T::HALF * speed * speed / deceleration
//! }
//!
//! assert_eq!(stopping_distance(2.0_f32, 4.0), 0.5);
//! assert_eq!(stopping_distance(2.0_f64, 4.0), 0.5);
//! ```
//!
//! This crate knows nothing of vectors, units or control.
#![no_std]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

use core::fmt::{Debug, Display, LowerExp};
use core::iter::Sum;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

mod single;

use libm::{cbrt as double_cbrt, hypot as double_hypot, sincos as double_sin_cos};
use single::{cbrt as single_cbrt, hypot as single_hypot, sin_cos as single_sin_cos};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A binary floating-point number: `f32` or `f64`.
pub trait Scalar:
    sealed::Sealed
    + Copy
    + Debug
    + Default
    + Display
    + LowerExp
    + PartialEq
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + SubAssign
    + Mul<Output = Self>
    + MulAssign
    + Div<Output = Self>
    + DivAssign
    + Neg<Output = Self>
    + Sum
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;
    /// 1/2.
    const HALF: Self;
    /// π, rounded.
    const PI: Self;
    /// Infinity.
    const INFINITY: Self;
    /// Not a number.
    const NAN: Self;
    /// Distance from 1 to the next larger number.
    const EPSILON: Self;
    /// The least positive normal number.
    const MIN_POSITIVE: Self;
    /// The greatest finite number.
    const MAX: Self;

    /// The nearest number to `value`; beyond the range, infinity.
    #[must_use]
    fn of(value: f64) -> Self;

    /// The same number as `f64`, exactly.
    #[must_use]
    fn to_f64(self) -> f64;

    /// Magnitude.
    #[must_use]
    fn abs(self) -> Self;

    /// The magnitude of this number with the sign of another.
    #[must_use]
    fn copysign(self, sign: Self) -> Self;

    /// The lesser of two; the other one where one is not a number.
    #[must_use]
    fn min(self, other: Self) -> Self;

    /// The greater of two; the other one where one is not a number.
    #[must_use]
    fn max(self, other: Self) -> Self;

    /// Square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;

    /// Sine and cosine of an angle in rad, of any size; NaN of an infinite one.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);

    /// eˣ.
    #[must_use]
    fn exp(self) -> Self;

    /// eˣ − 1, without cancellation near 0.
    #[must_use]
    fn exp_m1(self) -> Self;

    /// Natural logarithm.
    #[must_use]
    fn ln(self) -> Self;

    /// ln(1 + x), without cancellation near 0.
    #[must_use]
    fn ln_1p(self) -> Self;

    /// √(x² + y²), without overflow on the way.
    #[must_use]
    fn hypot(self, other: Self) -> Self;

    /// Hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self;

    /// Cube root.
    #[must_use]
    fn cbrt(self) -> Self;

    /// The greatest whole number that is not above.
    #[must_use]
    fn floor(self) -> Self;

    /// The least whole number that is not below.
    #[must_use]
    fn ceil(self) -> Self;

    /// Whether it is neither infinite nor NaN.
    #[must_use]
    fn is_finite(self) -> bool;

    /// Whether it is not a number.
    #[must_use]
    fn is_nan(self) -> bool;
}

macro_rules! scalar {
    ($t:ident, $sqrt:ident, $sincos:ident, $exp:ident, $expm1:ident, $log:ident, $log1p:ident, $hypot:ident, $tanh:ident, $cbrt:ident, $floor:ident, $ceil:ident) => {
        impl Scalar for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const TWO: Self = 2.0;
            const HALF: Self = 0.5;
            const PI: Self = core::$t::consts::PI;
            const INFINITY: Self = $t::INFINITY;
            const NAN: Self = $t::NAN;
            const EPSILON: Self = $t::EPSILON;
            const MIN_POSITIVE: Self = $t::MIN_POSITIVE;
            const MAX: Self = $t::MAX;

            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $t
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                $t::abs(self)
            }

            #[inline(always)]
            fn copysign(self, sign: Self) -> Self {
                $t::copysign(self, sign)
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                $t::min(self, other)
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                $t::max(self, other)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                libm::$sqrt(self)
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                $sincos(self)
            }

            #[inline]
            fn exp(self) -> Self {
                libm::$exp(self)
            }

            #[inline]
            fn exp_m1(self) -> Self {
                libm::$expm1(self)
            }

            #[inline]
            fn ln(self) -> Self {
                libm::$log(self)
            }

            #[inline]
            fn ln_1p(self) -> Self {
                libm::$log1p(self)
            }

            #[inline]
            fn hypot(self, other: Self) -> Self {
                $hypot(self, other)
            }

            #[inline]
            fn tanh(self) -> Self {
                libm::$tanh(self)
            }

            #[inline]
            fn cbrt(self) -> Self {
                $cbrt(self)
            }

            #[inline]
            fn floor(self) -> Self {
                libm::$floor(self)
            }

            #[inline]
            fn ceil(self) -> Self {
                libm::$ceil(self)
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                $t::is_finite(self)
            }

            #[inline(always)]
            fn is_nan(self) -> bool {
                $t::is_nan(self)
            }
        }
    };
}

scalar!(
    f32,
    sqrtf,
    single_sin_cos,
    expf,
    expm1f,
    logf,
    log1pf,
    single_hypot,
    tanhf,
    single_cbrt,
    floorf,
    ceilf
);
scalar!(
    f64,
    sqrt,
    double_sin_cos,
    exp,
    expm1,
    log,
    log1p,
    double_hypot,
    tanh,
    double_cbrt,
    floor,
    ceil
);

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
