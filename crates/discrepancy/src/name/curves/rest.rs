//! The rest of the fitted logs, and what columns do about it.

use nalgebra::{DMatrix, DVector};

use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::known::pinned;
use crate::estimate::projector::Projector;
use crate::spectrum::{Amplitudes, Whitener};

/// The fitted logs' rest, with known parameters and effects fitted out.
pub struct Rest<'a> {
    fitter: &'a Fitter<'a>,
    whitener: Whitener,
    projector: Projector,
    rest: DVector<f64>,
    noise: Vec<DVector<f64>>,
}

/// What columns explain of a residual.
pub struct Solved {
    /// Fall of D.
    pub gain: f64,
    /// Mean fall of D that noise alone would bring.
    pub of_noise: f64,
    /// Factor of each column.
    pub values: DVector<f64>,
    /// Standard deviation of each.
    pub deviations: Vec<f64>,
}

impl<'a> Rest<'a> {
    /// Of a fit with the derivatives of its own parameters, beside runs with noise.
    pub fn new(fitter: &'a Fitter<'a>, fit: &Fit, own: &Columns, noise: &[Amplitudes]) -> Self {
        let layout = &fitter.set.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(&fit.rest));
        let own = own.iter();
        let own: Vec<DVector<f64>> = own.map(|c| layout.whiten(&whitener, c)).collect();
        let shares = &fit.state.shares;
        let projector = Projector::new(fitter.machine, &own, &pinned(fitter.machine, shares));
        let rest = projector.reject_at(&layout.whiten(&whitener, &fit.rest), shares);
        let white = |run| projector.reject(&layout.whiten(&whitener, run));
        let noise = noise.iter().map(white).collect();
        Self {
            noise,
            fitter,
            whitener,
            projector,
            rest,
        }
    }

    /// The factors of columns that explain most of it.
    pub fn solve(&self, columns: &Columns) -> Solved {
        let layout = &self.fitter.set.layout;
        let seen: Vec<DVector<f64>> = columns
            .iter()
            .map(|c| self.projector.reject(&layout.whiten(&self.whitener, c)))
            .collect();
        let n = seen.len();
        let normal = DMatrix::from_fn(n, n, |i, j| seen[i].dot(&seen[j]));
        let right = DVector::from_fn(n, |i, _| seen[i].dot(&self.rest));
        // A hat that the motion hardly visits, or that the model's own
        // parameters can do, stays near 0.
        let ridge = 1e-6 * normal.diagonal().max();
        let inverse = (normal + DMatrix::identity(n, n) * ridge)
            .cholesky()
            .map(|c| c.inverse());
        let inverse = inverse.unwrap_or_else(|| DMatrix::zeros(n, n));
        let values = &inverse * &right;
        let gain_of_noise = |run: &DVector<f64>| {
            let right = DVector::from_fn(n, |i, _| seen[i].dot(run));
            right.dot(&(&inverse * &right))
        };
        let of_noise = self.noise.iter().map(gain_of_noise).sum::<f64>();
        let share = (values.dot(&right) / self.rest.norm_squared()).clamp(0.0, 0.999_999);
        Solved {
            gain: -(self.rest.len() as f64) * (1.0 - share).ln(),
            of_noise: of_noise / self.noise.len().max(1) as f64,
            deviations: (0..n).map(|i| inverse[(i, i)].max(0.0).sqrt()).collect(),
            values,
        }
    }
}
