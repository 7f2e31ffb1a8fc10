//! Marginals with closed forms on a finite interval.

use super::{Cumulative, Marginal, checked, is_probability};
use crate::LhsError;

/// Equal density on [lo, hi]; the paper's choice for all four inputs
/// (Table 5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uniform {
    lo: f64,
    hi: f64,
}

impl Uniform {
    /// Uniform on [`lo`, `hi`], both in the unit of the variable.
    ///
    /// # Errors
    /// A bound or `hi` − `lo` is not finite, or `lo` ≥ `hi`.
    pub fn new(lo: f64, hi: f64) -> Result<Self, LhsError> {
        let (lo, hi) = interval("Uniform", lo, hi)?;
        Ok(Self { lo, hi })
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

impl Marginal for Uniform {
    fn inverse_cdf(&self, p: f64) -> f64 {
        if !is_probability(p) {
            return f64::NAN;
        }
        // Rounding could step over the bound by one unit in the last place.
        (self.lo + p * (self.hi - self.lo)).min(self.hi)
    }
}

impl Cumulative for Uniform {
    fn cdf(&self, x: f64) -> f64 {
        ((x - self.lo) / (self.hi - self.lo)).clamp(0.0, 1.0)
    }
}

/// ln v uniform on [ln lo, ln hi]: every ratio equally likely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogUniform {
    lo: f64,
    hi: f64,
    log_ratio: f64,
}

impl LogUniform {
    /// Log-uniform on [`lo`, `hi`], both in the unit of the variable.
    ///
    /// # Errors
    /// A bound is not finite, `lo` is not positive, or `lo` ≥ `hi`.
    pub fn new(lo: f64, hi: f64) -> Result<Self, LhsError> {
        let (lo, hi) = interval("LogUniform", lo, hi)?;
        checked("LogUniform", "lo", lo, lo > 0.0, "positive")?;
        // Two logarithms, because hi / lo may overflow.
        let log_ratio = libm::log(hi) - libm::log(lo);
        checked(
            "LogUniform",
            "hi",
            hi,
            log_ratio > 0.0,
            "above lo by more than rounding",
        )?;
        Ok(Self { lo, hi, log_ratio })
    }
}

impl Marginal for LogUniform {
    fn inverse_cdf(&self, p: f64) -> f64 {
        if !is_probability(p) {
            return f64::NAN;
        }
        // From the nearer bound, so that neither factor overflows.
        let x = if p < 0.5 {
            self.lo * libm::exp(p * self.log_ratio)
        } else {
            self.hi * libm::exp((p - 1.0) * self.log_ratio)
        };
        x.clamp(self.lo, self.hi)
    }
}

impl Cumulative for LogUniform {
    fn cdf(&self, x: f64) -> f64 {
        if x <= self.lo {
            return 0.0;
        }
        ((libm::log(x) - libm::log(self.lo)) / self.log_ratio).clamp(0.0, 1.0)
    }
}

/// Density rising linearly from `lo` to `mode`, falling linearly to `hi`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangular {
    lo: f64,
    mode: f64,
    hi: f64,
}

impl Triangular {
    /// Triangular on [`lo`, `hi`] with its peak at `mode`, which may be a
    /// bound; all in the unit of the variable.
    ///
    /// # Errors
    /// A bound or `hi` − `lo` is not finite, `lo` ≥ `hi`, or `mode` lies
    /// outside [`lo`, `hi`].
    pub fn new(lo: f64, mode: f64, hi: f64) -> Result<Self, LhsError> {
        let (lo, hi) = interval("Triangular", lo, hi)?;
        let inside = (lo..=hi).contains(&mode);
        checked("Triangular", "mode", mode, inside, "within lo to hi")?;
        Ok(Self { lo, mode, hi })
    }
}

impl Marginal for Triangular {
    fn inverse_cdf(&self, p: f64) -> f64 {
        let Self { lo, mode, hi } = *self;
        let width = hi - lo;
        if !is_probability(p) {
            f64::NAN
        } else if p * width < mode - lo {
            lo + width * (p * ((mode - lo) / width)).sqrt()
        } else {
            hi - width * ((1.0 - p) * ((hi - mode) / width)).sqrt()
        }
    }
}

impl Cumulative for Triangular {
    fn cdf(&self, x: f64) -> f64 {
        let Self { lo, mode, hi } = *self;
        let width = hi - lo;
        if x <= lo {
            0.0
        } else if x >= hi {
            1.0
        } else if x < mode {
            ((x - lo) / width) * ((x - lo) / (mode - lo))
        } else {
            1.0 - ((hi - x) / width) * ((hi - x) / (hi - mode))
        }
    }
}

fn interval(marginal: &'static str, lo: f64, hi: f64) -> Result<(f64, f64), LhsError> {
    checked(marginal, "lo", lo, lo.is_finite(), "finite")?;
    let wide = hi.is_finite() && hi > lo && (hi - lo).is_finite();
    checked(
        marginal,
        "hi",
        hi,
        wide,
        "finite, above lo, and hi - lo finite",
    )?;
    Ok((lo, hi))
}
