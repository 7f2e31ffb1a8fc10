//! Screening: how much of a rest each effect of the library explains, and each
//! pair.

use std::ops::Range;

use axis_sim::effects::Effect;
use nalgebra::{Complex, DMatrix, DVector};
use rayon::prelude::*;

use crate::fit::{Columns, Fit, Fitter, pinned};
use crate::library::{Candidate, FORCE, values_at};
use crate::projector::Projector;
use crate::spectrum::Amplitudes;

/// A candidate with what it explains, if it is added alone.
#[derive(Clone, Debug)]
pub struct Screened {
    /// Which.
    pub effect: &'static Effect,
    /// By how much D falls in the linearised problem.
    pub gain: f64,
    /// Starting values for a fit.
    pub values: Vec<f64>,
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
        values_at(self.effect, &self.values, sizes.as_slice())
    }
}

/// A rest, and what the candidates can do about it, both without what the
/// fit's own parameters can.
pub struct Screening {
    rest: DVector<f64>,
    responses: Vec<Response>,
}

impl Screening {
    /// Of the candidates that are `wanted`, beside the rest of `fit` and the
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
        let matrix = DMatrix::from_columns(&columns);
        // As a product of two matrices, which is far faster than `tr_mul`.
        let transposed = matrix.transpose();
        let (normal, right) = (&transposed * &matrix, &transposed * &self.rest);
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
            self.with(&self.responses[*i], solution, gain)
        };
        (found.iter().take(PAIRS))
            .map(|(gain, a, b)| [part(*gain, a), part(*gain, b)])
            .collect()
    }

    fn alone(&self, response: &Response) -> Screened {
        let matrix = DMatrix::from_columns(&response.columns);
        let svd = matrix.svd(true, true);
        let largest = svd.singular_values.max();
        let solution = svd
            .solve(&self.rest, 1e-6 * largest.max(1e-300))
            .unwrap_or_else(|_| DVector::zeros(response.columns.len()));
        let mut screened = self.with(response, solution.as_slice(), 0.0);
        let does = &screened.fingerprint;
        screened.gain = self.gain_of(2.0 * self.rest.dot(does) - does.norm_squared());
        screened
    }

    fn with(&self, response: &Response, solution: &[f64], gain: f64) -> Screened {
        let rows = self.rest.len();
        let matrix = DMatrix::from_columns(&response.columns);
        let fingerprint = &matrix * DVector::from_column_slice(solution);
        let svd = matrix.svd(true, true);
        let columns = response.columns.len();
        Screened {
            gain,
            values: values_at(response.effect, &response.values, solution),
            candidate: response.candidate,
            fingerprint,
            basis: svd.u.unwrap_or_else(|| DMatrix::zeros(rows, 1)),
            strengths: svd.singular_values,
            sizes: svd.v_t.unwrap_or_else(|| DMatrix::zeros(columns, columns)),
            effect: response.effect,
        }
    }

    /// Fall of D where this much of the rest's whitened power goes.
    fn gain_of(&self, explained: f64) -> f64 {
        let share = (explained / self.rest.norm_squared()).clamp(0.0, 0.999_999);
        -(self.rest.len() as f64) * (1.0 - share).ln()
    }
}

/// Most pairs of effects that a screening gives.
const PAIRS: usize = 12;

/// Sizes at which some columns explain most, and how much, from the normal
/// equations of all; `None` where they are one and the same.
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
    let values = values_at(response.effect, &response.values, solution);
    let sizes = response.effect.parameters.iter().zip(&values);
    let mut sizes = sizes.filter(|(p, _)| p.size);
    sizes.all(|(p, v)| p.bounds[0] < *v && *v < p.bounds[1])
}

/// What a candidate does, in a space where other parameters are fitted out.
pub struct Response {
    /// Which.
    pub effect: &'static Effect,
    /// As of its [`Candidate`].
    pub values: Vec<f64>,
    /// Place of that in the library; `None` of a sum of several.
    pub candidate: Option<usize>,
    /// One entry a size; two of an effect with a phase.
    pub columns: Vec<DVector<f64>>,
}

/// Responses of those candidates that are `wanted`, `seen` through some
/// projection; of a force in time, the stretches that explain most of `rest`.
pub fn responses_in(
    library: &[Candidate],
    wanted: impl Fn(&Effect) -> bool + Sync,
    seen: impl Fn(&Amplitudes) -> DVector<f64> + Sync,
    rest: &DVector<f64>,
) -> Vec<Response> {
    let one = |(place, c): (usize, &Candidate)| Response {
        effect: c.effect,
        values: c.values.clone(),
        candidate: Some(place),
        columns: c.columns.iter().map(&seen).collect(),
    };
    let all: Vec<Response> = library
        .par_iter()
        .enumerate()
        .filter(|(_, c)| wanted(c.effect))
        .map(one)
        .collect();
    let (slots, mut all): (Vec<_>, Vec<_>) = all.into_iter().partition(|r| r.effect.name == FORCE);
    all.extend(windows(&slots, rest));
    all
}

/// The stretches of neighbouring slots in which a force explains most, the best
/// first: what a force does over several is the sum of what it does in each. None
/// of them is the whole motion, as it is a constant load then.
fn windows(slots: &[Response], rest: &DVector<f64>) -> Vec<Response> {
    let columns: Vec<&DVector<f64>> = slots.iter().filter_map(|s| s.columns.first()).collect();
    let n = columns.len();
    let along: Vec<f64> = columns.iter().map(|c| c.dot(rest)).collect();
    let mut gram = DMatrix::zeros(n, n);
    for j in 0..n {
        for i in 0..=j {
            gram[(i, j)] = columns[i].dot(columns[j]);
        }
    }
    let mut all = Vec::new();
    for first in 0..n {
        let (mut explained, mut size) = (0.0, 0.0);
        for last in first..n {
            explained += along[last];
            let cross: f64 = (first..last).map(|i| gram[(i, last)]).sum();
            size += gram[(last, last)] + 2.0 * cross;
            let gain: f64 = explained * explained / size.max(f64::MIN_POSITIVE);
            if last + 1 - first < n {
                all.push((gain, first..last + 1));
            }
        }
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut chosen: Vec<Range<usize>> = Vec::new();
    for (_, window) in all {
        if chosen.iter().all(|c| !mostly_same(c, &window)) {
            chosen.push(window);
        }
        if chosen.len() == WINDOWS {
            break;
        }
    }
    let response = |window: Range<usize>| {
        let mut values = slots[window.start].values.clone();
        values[2] = slots[window.end - 1].values[2];
        let zero = DVector::zeros(rest.len());
        Response {
            effect: slots[window.start].effect,
            values,
            candidate: None,
            columns: vec![columns[window].iter().fold(zero, |sum, c| sum + *c)],
        }
    };
    chosen.into_iter().map(response).collect()
}

/// Whether two stretches have half of what they cover in common.
pub fn mostly_same(a: &Range<usize>, b: &Range<usize>) -> bool {
    let common = a.end.min(b.end).saturating_sub(a.start.max(b.start));
    2 * common > a.len() + b.len() - common
}

/// Stretches of time that a screening of a force in time gives.
const WINDOWS: usize = 4;
