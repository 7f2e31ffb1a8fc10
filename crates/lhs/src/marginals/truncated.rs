//! Any marginal with known distribution function, cut to an interval.

use super::{Cumulative, Marginal, checked, is_probability};
use crate::LhsError;

/// The marginal `M` given that the value lies in [lo, hi].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truncated<M> {
    whole: M,
    lo: f64,
    hi: f64,
    /// G at lo and at hi.
    below: [f64; 2],
    /// 1 − G at lo and at hi: it has digits in the upper tail that G has lost.
    above: [f64; 2],
    /// Probability of [lo, hi] under `M`.
    mass: f64,
}

impl<M: Cumulative> Truncated<M> {
    /// `whole` cut to [`lo`, `hi`], in the unit of the variable; either bound
    /// may be infinite.
    ///
    /// # Errors
    /// `lo` or `hi` is NaN, `lo` ≥ `hi`, or `whole` gives the interval no
    /// probability that f64 can tell from zero.
    pub fn new(whole: M, lo: f64, hi: f64) -> Result<Self, LhsError> {
        checked("Truncated", "lo", lo, !lo.is_nan(), "a number or infinite")?;
        checked("Truncated", "hi", hi, hi > lo, "above lo")?;
        let below = [lo, hi].map(|x| whole.cdf(x));
        let above = [lo, hi].map(|x| whole.survival(x));
        let mass = difference(below, above);
        let valid = "such that lo to hi has probability";
        checked("Truncated", "hi", hi, mass > 0.0, valid)?;
        Ok(Self {
            whole,
            lo,
            hi,
            below,
            above,
            mass,
        })
    }

    /// Lower bound.
    pub fn lo(&self) -> f64 {
        self.lo
    }

    /// Upper bound.
    pub fn hi(&self) -> f64 {
        self.hi
    }
}

impl<M: Cumulative> Truncated<M> {
    /// The value with `p` below and `q` = 1 − p above it.
    fn quantile(&self, p: f64, q: f64) -> f64 {
        // Sums of what is not negative keep all digits, at either end.
        let share = |ends: [f64; 2]| (q * ends[0] + p * ends[1]).min(1.0);
        // The bounds themselves, or the ends of the support, without rounding.
        let x = if p == 0.0 || q == 0.0 {
            self.whole.inverse_cdf(p)
        } else if share(self.above) < 0.5 {
            self.whole.inverse_survival(share(self.above))
        } else {
            self.whole.inverse_cdf(share(self.below))
        };
        x.clamp(self.lo, self.hi)
    }

    /// The probability from a to b under `M` as a share of that of [lo, hi], from G and
    /// from 1 − G at a and b.
    fn share(&self, below: [f64; 2], above: [f64; 2]) -> f64 {
        (difference(below, above) / self.mass).clamp(0.0, 1.0)
    }
}

/// The probability of an interval from G and from 1 − G at its ends, by those that are
/// smaller and so have more digits.
fn difference(below: [f64; 2], above: [f64; 2]) -> f64 {
    if above[0] < below[1] {
        above[0] - above[1]
    } else {
        below[1] - below[0]
    }
}

impl<M: Cumulative> Marginal for Truncated<M> {
    fn inverse_cdf(&self, p: f64) -> f64 {
        if !is_probability(p) {
            return f64::NAN;
        }
        self.quantile(p, 1.0 - p)
    }
}

impl<M: Cumulative> Cumulative for Truncated<M> {
    fn cdf(&self, x: f64) -> f64 {
        let x = x.clamp(self.lo, self.hi);
        let (below, above) = (self.whole.cdf(x), self.whole.survival(x));
        self.share([self.below[0], below], [self.above[0], above])
    }

    fn survival(&self, x: f64) -> f64 {
        let x = x.clamp(self.lo, self.hi);
        let (below, above) = (self.whole.cdf(x), self.whole.survival(x));
        self.share([below, self.below[1]], [above, self.above[1]])
    }

    fn inverse_survival(&self, q: f64) -> f64 {
        if !is_probability(q) {
            return f64::NAN;
        }
        self.quantile(1.0 - q, q)
    }
}
