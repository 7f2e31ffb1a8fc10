//! A candidate with what it explains.

use axis_sim::effects::{ActiveEffect, Effect, Scales};
use nalgebra::{DMatrix, DVector};

use crate::name::library::values_at;

/// A candidate with what it explains, if it is added alone.
#[derive(Clone, Debug)]
pub struct Screened {
    /// Which.
    pub effect: &'static Effect,
    /// By how much D falls in the linearised problem.
    pub gain: f64,
    /// Starting values for a fit.
    pub values: Vec<f64>,
    /// How large things are on the axis.
    pub scales: Scales,
    /// Its place in the library; `None` of a force over several slots of time.
    pub candidate: Option<usize>,
    /// Response to these values, whitened, known parameters fitted out.
    pub fingerprint: DVector<f64>,
    /// Orthonormal basis of what the effect can do, in the same space, the
    /// strongest first.
    pub basis: DMatrix<f64>,
    /// How strongly it does each of them.
    pub strengths: DVector<f64>,
    /// With which sizes, as multiples of the typical: a row each.
    pub sizes: DMatrix<f64>,
}

impl Screened {
    /// The effect with its starting values.
    pub fn active(&self) -> ActiveEffect {
        ActiveEffect {
            effect: self.effect,
            values: self.values.clone(),
        }
    }

    /// Whether the logs would show all that this can do beyond what `own` does: by a
    /// fall of D of `least`, were it as large, in typical sizes, as what was found and
    /// brought `most`. Dry friction of the way back cannot be seen in a log without one.
    pub fn more_is_shown(&self, own: &Self, most: f64, least: f64) -> bool {
        // Products of its columns, less what lies along what was found.
        let Some(along) = own.fingerprint.try_normalize(0.0) else {
            return true;
        };
        let along = (self.basis.tr_mul(&along)).component_mul(&self.strengths);
        let squares = DMatrix::from_diagonal(&self.strengths.map(|s| s * s));
        let mut beyond = (squares - &along * along.transpose()).symmetric_eigenvalues();
        beyond.as_mut_slice().sort_by(|a, b| b.total_cmp(a));
        let more = self.basis.ncols().saturating_sub(own.basis.ncols());
        let shows = |power: &f64| power * most >= least * own.strengths.max().powi(2);
        beyond.iter().take(more).all(shows)
    }

    /// Values with which it comes nearest to what something else `does`, with nothing of
    /// what it does less than a tenth as strongly as the most.
    pub fn nearest(&self, does: &DVector<f64>) -> Vec<f64> {
        let nothing = DVector::zeros(self.strengths.len());
        let strong = |i: &usize| self.strengths[*i] > 0.1 * self.strengths.max();
        let parts = (0..self.strengths.len()).filter(strong);
        let sizes = parts.fold(nothing, |sum, i| {
            let along = self.basis.column(i).dot(does) / self.strengths[i];
            sum + self.sizes.row(i).transpose() * along
        });
        values_at(self.effect, &self.values, sizes.as_slice(), &self.scales)
    }
}
