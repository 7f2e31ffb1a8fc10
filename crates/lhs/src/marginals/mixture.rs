//! A weighted mixture of marginals.

use super::{Cumulative, Marginal, checked, is_probability};
use crate::LhsError;

/// With probability wᵢ the value comes from component i: G = Σ wᵢ Gᵢ.
///
/// The inverse has no closed form. It lies between the least and the greatest
/// of the components' quantiles and is found there by halving the f64 numbers
/// in between: at most 64 evaluations of G, exact to the last bit of the
/// computed G.
pub struct Mixture {
    components: Vec<(f64, Box<dyn Cumulative>)>,
}

impl Mixture {
    /// Takes pairs (weight, component). Weights are scaled to sum to 1.
    ///
    /// # Errors
    /// No components, a weight that is not positive and finite, or a sum of
    /// weights that is not finite.
    pub fn new(components: Vec<(f64, Box<dyn Cumulative>)>) -> Result<Self, LhsError> {
        let len = components.len();
        if len == 0 {
            return Err(LhsError::TooShort {
                marginal: "Mixture",
                len,
                least: 1,
            });
        }
        let mut sum = 0.0;
        for &(weight, _) in &components {
            let good = weight.is_finite() && weight > 0.0;
            sum += checked("Mixture", "weight", weight, good, "positive and finite")?;
        }
        checked("Mixture", "sum of weights", sum, sum.is_finite(), "finite")?;
        let scaled = components.into_iter().map(|(w, part)| (w / sum, part));
        Ok(Self {
            components: scaled.collect(),
        })
    }

    fn weighted(&self, value: impl Fn(&dyn Cumulative) -> f64) -> f64 {
        self.components.iter().map(|(w, c)| w * value(&**c)).sum()
    }

    /// The least and the greatest of the components' values.
    fn bracket(&self, value: impl Fn(&dyn Cumulative) -> f64) -> (f64, f64) {
        let values = self.components.iter().map(|(_, c)| value(&**c));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(x), b.max(x))
        })
    }
}

impl Marginal for Mixture {
    fn inverse_cdf(&self, p: f64) -> f64 {
        if !is_probability(p) {
            return f64::NAN;
        }
        if p > 0.5 && p < 1.0 {
            // There 1 − G has more digits, and 1 − p is exact.
            return self.inverse_survival(1.0 - p);
        }
        let (least, greatest) = self.bracket(|part| part.inverse_cdf(p));
        // The ends of the support: G says nothing there (it is 0 all the way
        // below the least, and rounds to 1 before the greatest).
        if p == 0.0 {
            least
        } else if p == 1.0 {
            greatest
        } else {
            first_not(least, greatest, |x| self.cdf(x) < p)
        }
    }
}

impl Cumulative for Mixture {
    fn cdf(&self, x: f64) -> f64 {
        self.weighted(|part| part.cdf(x)).min(1.0)
    }

    fn survival(&self, x: f64) -> f64 {
        self.weighted(|part| part.survival(x)).min(1.0)
    }

    fn inverse_survival(&self, q: f64) -> f64 {
        if !is_probability(q) {
            return f64::NAN;
        }
        if q > 0.5 && q < 1.0 {
            return self.inverse_cdf(1.0 - q);
        }
        let (least, greatest) = self.bracket(|part| part.inverse_survival(q));
        if q == 1.0 {
            least
        } else if q == 0.0 {
            greatest
        } else {
            first_not(least, greatest, |x| self.survival(x) > q)
        }
    }
}

/// The least f64 in [`least`, `greatest`] for which `low` is false, where
/// `low` is true up to some point; `greatest` when it never is.
fn first_not(least: f64, greatest: f64, low: impl Fn(f64) -> bool) -> f64 {
    let (mut below, mut above) = (rank(least), rank(greatest));
    while below < above {
        // The mean rounded down, without overflow: always under `above`.
        let middle = (below & above) + ((below ^ above) >> 1);
        if low(at_rank(middle)) {
            below = middle + 1;
        } else {
            above = middle;
        }
    }
    at_rank(above)
}

/// The position of a number among all f64, in order: rank(x) < rank(y)
/// exactly when x < y (zeros aside).
fn rank(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    if bits < 0 { i64::MIN - bits } else { bits }
}

fn at_rank(rank: i64) -> f64 {
    let bits = if rank < 0 { i64::MIN - rank } else { rank };
    f64::from_bits(bits as u64)
}
