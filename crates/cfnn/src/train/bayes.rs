//! Bayesian regularisation (MATLAB's `trainbr`).
//!
//! Training minimises `F = β E_D + α E_W` with `E_D = Σ r²` over the residuals
//! and `E_W = Σ w²` over the weights: the most probable weights if residuals
//! and weights are normal with variances `1/(2β)` and `1/(2α)`. At a minimum
//! of `F` α and β become the most probable ones (MacKay 1992,
//! doi 10.1162/neco.1992.4.3.415), with the Gauss–Newton approximation of the
//! Hessian ("Gauss-Newton approximation to Bayesian learning", 1997,
//! doi 10.1109/ICNN.1997.614194):
//!
//! ```text
//! γ = N - α tr (β JᵀJ + α I)⁻¹,   α = γ / (2 E_W),   β = (n - γ) / (2 E_D)
//! ```
//!
//! for `N` parameters and `n` residuals. `γ`, from 0 to `N`, is the number of
//! parameters that the data determine.
//!
//! Estimates after each step, far from a minimum, can take large residuals for
//! noise; α then draws all weights of the hidden layers to zero, from where no
//! gradient leads back. So a step must lower `F` by less than a share
//! ([`super::Bayesian::estimate_below`]) first.

use super::report::{EpochReport, Hyperparameters};

/// Epochs in a row whose changes must lie below the tolerance.
const CALM: usize = 5;
/// So large that products with sums of squares do not overflow.
const LARGEST: f64 = 1e100;

/// What the estimates follow from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    /// Residuals `n`.
    pub residuals: f64,
    /// Parameters `N`.
    pub parameters: f64,
    /// `E_D`.
    pub squares: f64,
    /// `E_W`.
    pub weights: f64,
}

/// Whether the estimates have come to a standstill; an epoch without new ones
/// says nothing about that.
pub(super) fn settled(history: &[EpochReport], tolerance: f64) -> bool {
    let Some(last) = history.len().checked_sub(CALM + 1) else {
        return false;
    };
    tolerance > 0.0
        && history[last..].windows(2).all(|pair| {
            match (pair[0].hyperparameters, pair[1].hyperparameters) {
                (Some(before), Some(after)) => after != before && after.near(&before, tolerance),
                _ => false,
            }
        })
}

/// `E_W`.
pub(super) fn squares(weights: &[f64]) -> f64 {
    weights.iter().map(|w| w * w).sum()
}

impl Hyperparameters {
    /// With all parameters effective.
    pub(super) fn initial(fit: Fit) -> Self {
        Self::of(fit.parameters, fit)
    }

    /// After a step, with the trace of `(β JᵀJ + α I)⁻¹` at these.
    pub(super) fn update(self, trace: f64, fit: Fit) -> Self {
        let most = fit.parameters.min(fit.residuals);
        Self::of((fit.parameters - self.alpha * trace).clamp(0.0, most), fit)
    }

    fn of(gamma: f64, fit: Fit) -> Self {
        // 1 where there is no estimate, as at first with fewer residuals than parameters.
        let ratio = |above: f64, below: f64| {
            if above > 0.0 && below > 0.0 {
                (above / (2.0 * below)).clamp(1.0 / LARGEST, LARGEST)
            } else {
                1.0
            }
        };
        Self {
            alpha: ratio(gamma, fit.weights),
            beta: ratio(fit.residuals - gamma, fit.squares),
            effective_parameters: gamma,
        }
    }

    /// `F` from `E_D` and `E_W`.
    pub(super) fn performance(&self, squares: f64, weights: f64) -> f64 {
        self.beta * squares + self.alpha * weights
    }

    /// Whether all three are those before, to a relative tolerance.
    pub(super) fn near(&self, before: &Self, tolerance: f64) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= tolerance * b.abs();
        near(self.alpha, before.alpha)
            && near(self.beta, before.beta)
            && near(self.effective_parameters, before.effective_parameters)
    }
}
