//! Step 3: from cumulative probabilities to physical values.

mod levels;
mod mixture;
mod normal;
mod simple;
mod tabulated;
mod truncated;

pub use levels::{DesignVariable, Integers, Levels, map_balanced};
pub use mixture::Mixture;
pub use normal::Normal;
pub use simple::{LogUniform, Triangular, Uniform};
pub use tabulated::Tabulated;
pub use truncated::Truncated;

use crate::{Design, LhsError};
use rayon::prelude::*;

/// The distribution of one input variable, as far as sampling needs it.
///
/// Any function or closure `Fn(f64) -> f64` is a marginal too.
pub trait Marginal: Send + Sync {
    /// The value that the variable stays below with probability `p`, in the
    /// unit of the variable: v = G⁻¹(p), Eq. (24). Not falling in `p`.
    ///
    /// The marginals of this crate answer for 0 ≤ p ≤ 1 (at the ends perhaps
    /// with an infinity) and return NaN elsewhere.
    fn inverse_cdf(&self, p: f64) -> f64;
}

impl<F: Fn(f64) -> f64 + Send + Sync> Marginal for F {
    fn inverse_cdf(&self, p: f64) -> f64 {
        self(p)
    }
}

/// A marginal whose distribution function is known as well.
pub trait Cumulative: Marginal {
    /// G(x): the probability of a value at or below `x`.
    fn cdf(&self, x: f64) -> f64;

    /// 1 − G(x). To be written out where the subtraction would lose the
    /// digits of a thin upper tail.
    fn survival(&self, x: f64) -> f64 {
        1.0 - self.cdf(x)
    }

    /// The x with 1 − G(x) = `q`. To be written out together with
    /// [`survival`](Self::survival).
    fn inverse_survival(&self, q: f64) -> f64 {
        self.inverse_cdf(1.0 - q)
    }
}

/// Sends column j of a design of probabilities through `marginals[j]`:
/// V of Eq. (25) from Q of Eq. (23). The result is n × m, in physical units.
///
/// # Errors
/// There is not exactly one marginal for each column, a value of `design` is
/// not in [0, 1), or a marginal returns a value that is not finite.
pub fn map(design: &Design, marginals: &[&dyn Marginal]) -> Result<Design, LhsError> {
    let dims = design.dims();
    if marginals.len() != dims {
        return Err(LhsError::MarginalCount {
            marginals: marginals.len(),
            dims,
        });
    }
    let wrong = |v: &f64| !(0.0..1.0).contains(v);
    if let Some(at) = design.values().iter().position(wrong) {
        return Err(LhsError::NotProbability {
            row: at / dims,
            dim: at % dims,
            value: design.values()[at],
        });
    }
    let mut values = design.values().to_vec();
    values.par_chunks_mut(1024 * dims).for_each(|rows| {
        for row in rows.chunks_exact_mut(dims) {
            for (value, marginal) in row.iter_mut().zip(marginals) {
                *value = marginal.inverse_cdf(*value);
            }
        }
    });
    Design::from_rows(dims, values)
}

/// `Ok(value)` when `good`, else the error that says what would be valid.
fn checked(
    marginal: &'static str,
    field: &'static str,
    value: f64,
    good: bool,
    valid: &'static str,
) -> Result<f64, LhsError> {
    if good {
        return Ok(value);
    }
    Err(LhsError::Parameter {
        marginal,
        field,
        value,
        valid,
    })
}

/// True when `p` is a probability; false for NaN.
fn is_probability(p: f64) -> bool {
    (0.0..=1.0).contains(&p)
}
