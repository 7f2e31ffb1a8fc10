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

    fn survival(&self, x: f64) -> f64 {
        ((self.hi - x) / (self.hi - self.lo)).clamp(0.0, 1.0)
    }

    fn inverse_survival(&self, q: f64) -> f64 {
        if !is_probability(q) {
            return f64::NAN;
        }
        (self.hi - q * (self.hi - self.lo)).max(self.lo)
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
        let log_ratio = log_ratio(lo, hi);
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
        self.quantile(p, 1.0 - p)
    }
}

impl LogUniform {
    /// The value with `p` below and `q` = 1 − p above it. From the nearer bound, so that
    /// neither factor overflows.
    fn quantile(&self, p: f64, q: f64) -> f64 {
        let x = if p < 0.5 {
            self.lo * libm::exp(p * self.log_ratio)
        } else {
            self.hi * libm::exp(-q * self.log_ratio)
        };
        x.clamp(self.lo, self.hi)
    }
}

impl Cumulative for LogUniform {
    fn cdf(&self, x: f64) -> f64 {
        if x <= self.lo {
            return 0.0;
        }
        (log_ratio(self.lo, x) / self.log_ratio).clamp(0.0, 1.0)
    }

    fn survival(&self, x: f64) -> f64 {
        if x <= self.lo {
            return 1.0;
        }
        (log_ratio(x, self.hi) / self.log_ratio).clamp(0.0, 1.0)
    }

    fn inverse_survival(&self, q: f64) -> f64 {
        if !is_probability(q) {
            return f64::NAN;
        }
        self.quantile(1.0 - q, q)
    }
}

/// ln(b/a) of two positive numbers.
fn log_ratio(a: f64, b: f64) -> f64 {
    let share = (b - a) / a;
    if share.abs() < 0.5 {
        libm::log1p(share)
    } else {
        // Two logarithms, because b / a may overflow.
        libm::log(b) - libm::log(a)
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

impl Triangular {
    /// The value with `p` below and `q` = 1 − p above it.
    fn quantile(&self, p: f64, q: f64) -> f64 {
        let Self { lo, mode, hi } = *self;
        let width = hi - lo;
        if p * width < mode - lo {
            lo + width * (p * ((mode - lo) / width)).sqrt()
        } else {
            hi - width * (q * ((hi - mode) / width)).sqrt()
        }
    }

    /// G(x) of an x between `lo` and `mode`.
    fn rising(&self, x: f64) -> f64 {
        ((x - self.lo) / (self.hi - self.lo)) * ((x - self.lo) / (self.mode - self.lo))
    }

    /// 1 − G(x) of an x between `mode` and `hi`.
    fn falling(&self, x: f64) -> f64 {
        ((self.hi - x) / (self.hi - self.lo)) * ((self.hi - x) / (self.hi - self.mode))
    }
}

impl Marginal for Triangular {
    fn inverse_cdf(&self, p: f64) -> f64 {
        if !is_probability(p) {
            return f64::NAN;
        }
        self.quantile(p, 1.0 - p)
    }
}

impl Cumulative for Triangular {
    fn cdf(&self, x: f64) -> f64 {
        if x <= self.lo {
            0.0
        } else if x >= self.hi {
            1.0
        } else if x < self.mode {
            self.rising(x)
        } else {
            1.0 - self.falling(x)
        }
    }

    fn survival(&self, x: f64) -> f64 {
        if x <= self.lo {
            1.0
        } else if x >= self.hi {
            0.0
        } else if x < self.mode {
            1.0 - self.rising(x)
        } else {
            self.falling(x)
        }
    }

    fn inverse_survival(&self, q: f64) -> f64 {
        if !is_probability(q) {
            return f64::NAN;
        }
        self.quantile(1.0 - q, q)
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
