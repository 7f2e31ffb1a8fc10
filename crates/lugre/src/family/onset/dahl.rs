//! Dahl's onset.

use super::Onset;
use crate::exponential::Exponential;
use crate::family::error::FrictionError;
use crate::family::steady::{check_range, power};

/// `Y = sign(1 − y) |1 − y|^i`, after P. R. Dahl, AIAA Journal 14(12), 1976,
/// doi 10.2514/3.61511. i = 1 is LuGre friction without damping of the bristles, i = 0
/// an elastic contact that slides at once. The solution is exact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct DahlOnset<T = f64> {
    /// `i`, 0 to 10. Below 1 the steady state is reached after a finite displacement.
    pub exponent: T,
}

impl<T: Exponential> Onset<T> for DahlOnset<T> {
    fn slope(&self, y: T, _: T) -> T {
        let p = T::ONE - y;
        if p == T::ZERO {
            return T::ZERO;
        }
        let size = if self.exponent == T::ZERO && !p.is_nan() {
            T::ONE
        } else {
            power(p.abs(), self.exponent)
        };
        size.copysign(p)
    }

    /// The distance `m = |1 − y|` falls by `dm/dξ = −m^i`, so that
    /// `m(ξ) = m e^{−L}`, `L = ln(1 + (i − 1) ξ m^{i−1}) / (i − 1)`, and `L = ξ` for i = 1.
    fn advance(&self, y: T, xi: T, _: T) -> T {
        let p = T::ONE - y;
        if p == T::ZERO {
            return T::ZERO;
        }
        let m = p.abs();
        if self.exponent == T::ZERO {
            return if xi < m { xi.copysign(p) } else { p };
        }
        let over = self.exponent - T::ONE;
        if xi == T::INFINITY {
            return p;
        }
        if over == T::ZERO {
            return p * xi.one_minus_exp();
        }
        let x = over * xi * (over * m.ln()).exp();
        if x <= -T::ONE {
            return p;
        }
        p * (x.ln_1p() / over).one_minus_exp()
    }

    fn validate(&self) -> Result<(), FrictionError> {
        let range = [T::ZERO, T::of(10.0)];
        check_range("exponent", self.exponent, "between 0 and 10", range)
    }
}
