//! What candidates explain of a residual, alone and in pairs.

use axis_sim::effects::Effect;
use nalgebra::{Complex, DMatrix, DVector};
use rayon::prelude::*;

use super::response::{Response, responses_in};
use super::screened::Screened;
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::known::pinned;
use crate::estimate::projector::Projector;
use crate::estimate::thin::{Thin, products};
use crate::name::library::{Candidate, values_at};
use crate::spectrum::Amplitudes;

/// A residual, and what the candidates can do about it, both without what the
/// fit's own parameters can.
pub struct Screening {
    rest: DVector<f64>,
    responses: Vec<Response>,
}

impl Screening {
    /// Of the candidates that are `wanted`, beside the residual of `fit` and the
    /// columns of its own parameters (`own`), weighed by these spectral matrices.
    pub fn new(
        fitter: &Fitter<'_>,
        fit: &Fit,
        own: &Columns,
        library: &[Candidate],
        matrices: &[DMatrix<Complex<f64>>],
        wanted: impl Fn(&Effect) -> bool + Sync,
    ) -> Self {
        let layout = &fitter.set.layout;
        let whitener = layout.whitener(matrices);
        let white = |a: &Amplitudes| layout.whiten(&whitener, a);
        let own: Vec<DVector<f64>> = own.iter().map(white).collect();
        let projector = Projector::new(
            fitter.machine,
            &own,
            &pinned(fitter.machine, &fit.state.shares),
        );
        let rest = projector.reject_at(&white(&fit.rest), &fit.state.shares);
        let seen = |column: &Amplitudes| projector.reject(&white(column));
        Self::of(library, wanted, seen, rest)
    }

    /// Of the candidates that are `wanted`, `seen` through some projection, beside a residual
    /// that was seen so.
    pub fn of(
        library: &[Candidate],
        wanted: impl Fn(&Effect) -> bool + Sync,
        seen: impl Fn(&Amplitudes) -> DVector<f64> + Sync,
        rest: DVector<f64>,
    ) -> Self {
        let responses = responses_in(library, wanted, seen, &rest);
        Self { rest, responses }
    }

    /// What each candidate explains alone.
    pub fn one_by_one(&self) -> Vec<Screened> {
        self.responses.par_iter().map(|r| self.alone(r)).collect()
    }

    /// The pairs that explain most, best first, one entry a pair of effects.
    pub fn two_by_two(&self) -> Vec<[Screened; 2]> {
        let columns = self.responses.iter().flat_map(|r| &r.columns);
        let columns: Vec<DVector<f64>> = columns.cloned().collect();
        if columns.is_empty() {
            return Vec::new();
        }
        let right = DVector::from_fn(columns.len(), |i, _| columns[i].dot(&self.rest));
        let normal = products(&DMatrix::from_columns(&columns));
        let mut first = 0;
        let places: Vec<Vec<usize>> = (self.responses.iter())
            .map(|r| {
                let own = first..first + r.columns.len();
                first = own.end;
                own.collect()
            })
            .collect();
        let n = self.responses.len();
        let together = |(i, j): (usize, usize)| {
            let [a, b] = [&self.responses[i], &self.responses[j]];
            let both = [places[i].as_slice(), &places[j]].concat();
            let (solution, explained) = solved(&normal, &right, &both)?;
            let gain = self.gain_of(explained);
            let (of_a, of_b) = solution.split_at(places[i].len());
            let worth =
                a.effect.name != b.effect.name && within_bounds(a, of_a) && within_bounds(b, of_b);
            worth.then(|| (gain, (i, of_a.to_vec()), (j, of_b.to_vec())))
        };
        let all: Vec<(usize, usize)> = (0..n)
            .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
            .collect();
        let mut found: Vec<_> = all.into_par_iter().filter_map(together).collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut seen: Vec<[&str; 2]> = Vec::new();
        found.retain(|(_, (i, _), (j, _))| {
            let names = [i, j].map(|k| self.responses[*k].effect.name);
            let new = !seen.contains(&names);
            seen.push(names);
            new
        });
        let part = |gain: f64, (i, solution): &(usize, Vec<f64>)| {
            let response = &self.responses[*i];
            self.with(response, Thin::of(&response.columns), solution, gain)
        };
        (found.iter().take(PAIRS))
            .map(|(gain, a, b)| [part(*gain, a), part(*gain, b)])
            .collect()
    }

    fn alone(&self, response: &Response) -> Screened {
        let thin = Thin::of(&response.columns);
        let solution = thin.solve(&self.rest);
        let mut screened = self.with(response, thin, solution.as_slice(), 0.0);
        let does = &screened.fingerprint;
        screened.gain = self.gain_of(2.0 * self.rest.dot(does) - does.norm_squared());
        screened
    }

    fn with(&self, response: &Response, thin: Thin, solution: &[f64], gain: f64) -> Screened {
        let mut fingerprint = DVector::zeros(self.rest.len());
        for (column, &by) in response.columns.iter().zip(solution) {
            fingerprint.axpy(by, column, 1.0);
        }
        Screened {
            gain,
            values: values_at(
                response.effect,
                &response.values,
                solution,
                &response.scales,
            ),
            scales: response.scales,
            candidate: response.candidate,
            fingerprint,
            basis: thin.basis,
            strengths: thin.strengths,
            sizes: thin.parts,
            effect: response.effect,
        }
    }

    /// Share of the residual's whitened power that a screened effect explains.
    pub fn share(&self, screened: &Screened) -> f64 {
        1.0 - (-screened.gain / self.rest.len() as f64).exp()
    }

    /// Fall of D where this much of the residual's whitened power goes.
    fn gain_of(&self, explained: f64) -> f64 {
        let share = (explained / self.rest.norm_squared()).clamp(0.0, 0.999_999);
        -(self.rest.len() as f64) * (1.0 - share).ln()
    }
}

/// Most pairs of effects that a screening gives.
const PAIRS: usize = 12;

/// Sizes at which some columns explain most, and how much, from the normal
/// equations of all; `None` if they are one and the same.
fn solved(
    normal: &DMatrix<f64>,
    right: &DVector<f64>,
    places: &[usize],
) -> Option<(Vec<f64>, f64)> {
    let n = places.len();
    let scale = |i: usize| normal[(places[i], places[i])].max(f64::MIN_POSITIVE).sqrt();
    let own = DMatrix::from_fn(n, n, |i, j| {
        normal[(places[i], places[j])] / (scale(i) * scale(j))
    });
    let along = DVector::from_fn(n, |i, _| right[places[i]] / scale(i));
    let factor = own.cholesky()?;
    // Below this the sine of the angle between two is a hundredth.
    if factor.l_dirty().diagonal().min() < 0.01 {
        return None;
    }
    let x = factor.solve(&along);
    let explained = x.dot(&along);
    Some(((0..n).map(|i| x[i] / scale(i)).collect(), explained))
}

/// Whether sizes, as multiples of the typical, are such as the effect may have.
fn within_bounds(response: &Response, solution: &[f64]) -> bool {
    let scales = &response.scales;
    let values = values_at(response.effect, &response.values, solution, scales);
    let sizes = response.effect.parameters.iter().zip(&values);
    let mut sizes = sizes.filter(|(p, _)| p.is_size());
    sizes.all(|(p, v)| {
        let [low, high] = p.bounds(scales);
        low < *v && *v < high
    })
}
