//! Any marginal with known distribution function, cut to an interval.

use super::{Cumulative, Marginal, checked, is_probability};
use crate::LhsError;

/// The marginal `M` given that the value lies in [lo, hi].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truncated<M> {
    whole: M,
    lo: f64,
    hi: f64,
    /// Work from the upper tail: there 1 − G has digits that G has lost.
    upper: bool,
    /// G(lo), or 1 − G(lo) in the upper tail.
    start: f64,
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
        let upper = whole.cdf(lo) > 0.5;
        let (start, end) = if upper {
            (whole.survival(lo), whole.survival(hi))
        } else {
            (whole.cdf(lo), whole.cdf(hi))
        };
        let mass = (end - start).abs();
        let valid = "such that lo to hi has probability";
        checked("Truncated", "hi", hi, mass > 0.0, valid)?;
        Ok(Self {
            whole,
            lo,
            hi,
            upper,
            start,
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

impl<M: Cumulative> Marginal for Truncated<M> {
    fn inverse_cdf(&self, p: f64) -> f64 {
        if !is_probability(p) {
            return f64::NAN;
        }
        // The bounds themselves, or the ends of the support, without rounding.
        let x = if p == 0.0 || p == 1.0 {
            self.whole.inverse_cdf(p)
        } else if self.upper {
            self.whole
                .inverse_survival((self.start - p * self.mass).max(0.0))
        } else {
            self.whole
                .inverse_cdf((self.start + p * self.mass).min(1.0))
        };
        x.clamp(self.lo, self.hi)
    }
}

impl<M: Cumulative> Cumulative for Truncated<M> {
    fn cdf(&self, x: f64) -> f64 {
        let x = x.clamp(self.lo, self.hi);
        let below = if self.upper {
            self.start - self.whole.survival(x)
        } else {
            self.whole.cdf(x) - self.start
        };
        (below / self.mass).clamp(0.0, 1.0)
    }
}
