//! Decaying exponentials, inlined and the same to the bit on every platform.
//!
//! `1 − e^{−a} = a + a² Q(a)`, with `Q` the interpolant at Chebyshev nodes up to
//! 0.125 and another up to 0.7. The leading term is exact, so small `a` lose
//! nothing. Above, `1 − e^{−a}` itself cancels nothing.
//!
//! `e^{−u} = 2^{−k/64} e^{−r}` with `|r| ≤ ln 2 / 128`: a table of the 64
//! fractions and a polynomial.
//!
//! Greatest relative errors: of the formulas in exact arithmetic (50 digits),
//! and of the functions in units in the last place (the tests; for `f32`
//! against the `f64` functions of `libm`, 8.6 million arguments):
//!
//! | | degrees, `f64` | formula | degrees, `f32` | formula | function, `f32` |
//! |---|---|---|---|---|---|
//! | `1 − e^{−a}`, a < 0.125 | 6 | 2.1e-17 | 3 | 5.2e-10 | 0.61 |
//! | `1 − e^{−a}`, a < 0.7 | 10 | 1.1e-18 | 5 | 1.7e-9 | 1.34 |
//! | `1 − e^{−a}`, a ≥ 0.7 | table, 5 | 4.4e-18 | table, 3 | 3.6e-11 | 1.00 |
//! | `(1 − e^{−a}) / a` | as above | | as above | | 1.82 |
//! | `e^{−u}` | table, 5 | 4.4e-18 | table, 3 | 3.6e-11 | 1.00 |
//!
//! The `f64` functions agree with `libm`, itself within 1 unit, to 3 (test).
//!
//! They are here because they pay: with `libm`'s `exp` and `expm1` instead a
//! step takes 1.2 to 1.8 times as long and axis-sim's closed loop 7 to 15 %
//! longer; the standard library's cost the loop 2 to 10 %, need `std` and are
//! not the same on every platform (`benches/step.rs` sets the three side by
//! side).
//!
//! All are forced inline, as are their callers inside the crate: left to itself
//! the compiler calls them, which made a step 10 to 25 % slower.

mod double;
mod single;
#[cfg(test)]
mod tests;

use axis_scalar::Scalar;

/// A scalar that the law can be computed in, `f64` or `f32`: decaying
/// exponentials made for its precision, and the range of its laws.
pub trait Exponential: Scalar {
    /// `ln(4/ε)`: from `u` on `1 + e^{−u}` is 1, wherever the 1 lies between two
    /// powers of two.
    const LOST: Self;

    /// What `u` and [`LOST`](Self::LOST) may be off by rounding, with room.
    const MARGIN: Self;

    /// Least and greatest `T_C/σ0` and `T_S/σ0` of a law, rad: no step overflows.
    const DEFLECTIONS: (Self, Self);

    /// [`DEFLECTIONS`](Self::DEFLECTIONS) for the error of parameters outside.
    const VALID_STIFFNESS: &'static str;

    /// The coefficients behind the functions below, for code that is generated from them.
    #[must_use]
    fn decays() -> Decays<Self>;

    /// `e^{−u}` of `u ≥ 0`, 0 below the least normal number; NaN for NaN.
    #[must_use]
    fn exp_minus(self) -> Self;

    /// `1 − e^{−a}` of `a ≥ 0` (also infinite), in `[0, 1]`; NaN for NaN.
    #[must_use]
    fn one_minus_exp(self) -> Self;

    /// `(1 − e^{−a}) / a` of `a ≥ 0`, continued to 1 at `a = 0`; NaN for NaN.
    #[must_use]
    fn mean_decay(self) -> Self;

    /// Arctangent of any number, rad, as [`libm`] has it.
    #[must_use]
    fn arctan(self) -> Self;
}

/// Coefficients of the decaying exponentials in one precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decays<T: 'static> {
    /// Those of `Q(a)` up to 0.125, the constant one first.
    pub short: &'static [T],
    /// Those of `Q(a)` up to 0.7.
    pub long: &'static [T],
    /// `2^{−j/64}`.
    pub fractions: &'static [T; 64],
}

macro_rules! exponential {
    ($t:ident, $module:ident, $arctan:ident, $bits:literal, $margin:literal, $least:literal, $greatest:literal) => {
        impl Exponential for $t {
            const LOST: Self = $bits * core::$t::consts::LN_2;
            const MARGIN: Self = $margin;
            const DEFLECTIONS: (Self, Self) = ($least, $greatest);
            const VALID_STIFFNESS: &'static str = concat!(
                "such that `coulomb` and `stiction` divided by it are between ",
                stringify!($least),
                " and ",
                stringify!($greatest),
                " rad"
            );

            fn decays() -> Decays<Self> {
                $module::DECAYS
            }

            #[inline(always)]
            fn exp_minus(self) -> Self {
                $module::exp_minus(self)
            }

            #[inline(always)]
            fn one_minus_exp(self) -> Self {
                $module::one_minus_exp(self)
            }

            #[inline(always)]
            fn mean_decay(self) -> Self {
                $module::mean_decay(self)
            }

            fn arctan(self) -> Self {
                libm::$arctan(self)
            }
        }
    };
}

// Margins: u is rounded twice, to 2 units in the last place of at most 750 and 105.
exponential!(f64, double, atan, 54.0, 1e-6, 1e-150, 1e150);
exponential!(f32, single, atanf, 25.0, 1e-4, 1e-18, 1e18);

/// The two functions that one source serves, on `q_short`, `q_long`,
/// `exp_minus` and `SATURATED` of the module that it is used in.
macro_rules! decays {
    ($t:ident) => {
        /// Below it the short polynomial serves: every step of a control loop.
        const SHORT: $t = 0.125;

        /// Below it the long polynomial serves; above it `1 − e^{−a}` cancels nothing.
        const LONG: $t = 0.7;

        pub(super) const DECAYS: super::Decays<$t> = super::Decays {
            short: &Q_SHORT,
            long: &Q_LONG,
            fractions: &FRACTIONS,
        };

        /// `1 − e^{−a}` for `a ≥ 0` (also infinite), in `[0, 1]`; NaN for NaN.
        #[inline(always)]
        pub(super) fn one_minus_exp(a: $t) -> $t {
            if a < SHORT {
                a + a * a * q_short(a)
            } else if a < LONG {
                a + a * a * q_long(a)
            } else if a < SATURATED {
                1.0 - exp_minus(a)
            } else if a.is_nan() {
                a
            } else {
                1.0
            }
        }

        /// `(1 − e^{−a}) / a` for `a ≥ 0`, continued to 1 at `a = 0`; NaN for NaN.
        #[inline(always)]
        pub(super) fn mean_decay(a: $t) -> $t {
            if a < SHORT {
                1.0 + a * q_short(a)
            } else if a < LONG {
                1.0 + a * q_long(a)
            } else {
                one_minus_exp(a) / a
            }
        }
    };
}
use decays;
