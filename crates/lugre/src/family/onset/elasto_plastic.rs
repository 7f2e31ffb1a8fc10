//! The elasto-plastic onset.

use super::{Onset, approach};
use crate::exponential::Exponential;
use crate::family::error::FrictionError;
use crate::family::steady::check_range;

/// `Y = 1 − α(y) y`: purely elastic up to a deflection `z_ba`, so that small oscillating loads
/// do not let it drift. P. Dupont, V. Hayward, B. Armstrong, F. Altpeter, IEEE Trans.
/// Automatic Control 47(5), 2002, doi 10.1109/TAC.2002.1000274; with `b = z_ba/z_ss`,
///
/// ```text
/// α = 0                                        y ≤ b, and below 0
/// α = ½ sin(π (y − (1 + b)/2)/(1 − b)) + ½     b < y < 1
/// α = 1                                        y ≥ 1
/// ```
///
/// Exact at `y ≤ b` and `y ≥ 1`; in between a fourth-order solution that cannot leave (b, 1).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ElastoPlasticOnset<T = f64> {
    /// `σ0 z_ba / F_C`, the elastic share of the Coulomb level, 0 to 0.99.
    pub elastic_share: T,
}

/// `1 − α` of `p = 1 − y`, with `x = p/(1 − b)` between 0 and 1: `sin²(π x/2)`.
#[inline]
fn elastic<T: Exponential>(p: T, width: T) -> T {
    let sin = (T::HALF * T::PI * (p / width)).sin_cos().0;
    sin * sin
}

impl<T: Exponential> Onset<T> for ElastoPlasticOnset<T> {
    fn slope(&self, y: T, coulomb: T) -> T {
        let b = self.elastic_share * coulomb;
        if y <= b {
            return T::ONE;
        }
        let p = T::ONE - y;
        if p <= T::ZERO || p.is_nan() {
            return p;
        }
        p + y * elastic(p, T::ONE - b)
    }

    fn advance(&self, y: T, xi: T, coulomb: T) -> T {
        let b = self.elastic_share * coulomb;
        let p = T::ONE - y;
        if p <= T::ZERO {
            return p * xi.one_minus_exp();
        }
        let (elastically, p) = if y < b {
            (b - y, T::ONE - b)
        } else {
            (T::ZERO, p)
        };
        if xi <= elastically {
            return xi;
        }
        // (1 − α y)/(1 − y) = 1 + y (1 − α)/(1 − y)
        let rate = |p: T| T::ONE + (T::ONE - p) * elastic(p, T::ONE - b) / p;
        elastically + approach(p, xi - elastically, T::ONE, rate)
    }

    fn validate(&self) -> Result<(), FrictionError> {
        check_range(
            "elastic_share",
            self.elastic_share,
            "between 0 and 0.99",
            [T::ZERO, T::of(0.99)],
        )
    }
}
