//! Laws that nobody wrote down: Gaussian processes over a variable, on the hats of its curve.

use nalgebra::DMatrix;

use crate::name::curves::{Shape, Variable};

/// Length over which a law changes, as shares of the range of its variable, that are tried.
pub const LENGTHS: [f64; 4] = [0.05, 0.12, 0.35, 1.0];

/// The one of these that is tried first.
pub const MIDDLE: usize = 2;

/// Share of a law over speed that is odd: friction is, and little else over speed.
const ODD: f64 = 0.6;

/// Factor of the covariance of the values at the knots, for unit deviation: values are it times
/// independent numbers of unit variance.
pub fn factor(shape: &Shape, length: f64) -> DMatrix<f64> {
    let n = shape.knots.len();
    let near = |d: f64| (-0.5 * (d / length).powi(2)).exp();
    let kernel = |i: usize, j: usize| match shape.variable {
        Variable::Angle => {
            let half = std::f64::consts::PI * (i.abs_diff(j) as f64 / n as f64);
            (-2.0 * half.sin().powi(2) / (2.0 * length).powi(2)).exp()
        }
        Variable::Speed => {
            let half = n / 2;
            let signed = |i: usize| shape.knots[i] > 0.0;
            let place = |i: usize| match i < half {
                true => half - 1 - i,
                false => i - half,
            };
            let apart = place(i).abs_diff(place(j)) as f64 / (half.max(2) - 1) as f64;
            let sign = if signed(i) == signed(j) { 1.0 } else { -1.0 };
            near(apart) * (ODD * sign + 1.0 - ODD)
        }
        _ => near(i.abs_diff(j) as f64 / (n.max(2) - 1) as f64),
    };
    let mut covariance = DMatrix::from_fn(n, n, kernel);
    for i in 0..n {
        covariance[(i, i)] += 1e-6;
    }
    let factor = covariance.cholesky().map(|c| c.l());
    factor.unwrap_or_else(|| DMatrix::identity(n, n))
}
