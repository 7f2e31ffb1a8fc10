//! Screening: what each effect of the library would do to the logs, and how
//! much of the rest that explains.

use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, Machine};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::fit::{Columns, Fit, Fitter, known_deviation, pinned};
use crate::spectrum::Amplitudes;

/// An effect with one choice of its shape.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Which.
    pub effect: &'static Effect,
    /// Starting values, sizes typical.
    pub values: Vec<f64>,
    /// Response to each size parameter at its typical value; for an effect
    /// with a phase, to phase 0 and to phase π/2.
    pub columns: Columns,
}

/// A candidate with what it explains, if it is added alone.
#[derive(Clone, Debug)]
pub struct Screened {
    /// Which.
    pub effect: &'static Effect,
    /// By how much D falls in the linearised problem.
    pub gain: f64,
    /// Starting values for a fit.
    pub values: Vec<f64>,
    /// Response to these values, whitened, known parameters fitted out.
    pub fingerprint: DVector<f64>,
    /// Orthonormal basis of what the effect can do, in the same space.
    pub basis: DMatrix<f64>,
}

/// Values of shape parameters to begin with.
fn shapes(fitter: &Fitter<'_>, effect: &Effect) -> Vec<Vec<f64>> {
    let duration = |l: &crate::model::Prepared| l.log.len() as f64 * l.period;
    let end = fitter.set.logs.iter().map(duration).fold(0.0, f64::max);
    let positions = fitter
        .set
        .logs
        .iter()
        .flat_map(|l| l.log.channel("position_m").unwrap_or(&[]));
    let (low, high) = positions.fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    let typical = effect.typical();
    let along = |i: usize, n: usize| low + (high - low) * (i as f64 + 0.5) / n as f64;
    match effect.name {
        "stribeck-friction" => [0.004, 0.015, 0.05]
            .iter()
            .map(|&v| vec![typical[0], v])
            .collect(),
        "position-dependent-friction" => {
            let width = (high - low) / 16.0;
            (0..8)
                .map(|i| vec![typical[0], along(i, 8), width])
                .collect()
        }
        "process-force" => (0..SLOTS)
            .map(|i| {
                let slot = end / SLOTS as f64;
                vec![typical[0], slot * i as f64, slot * (i + 1) as f64]
            })
            .collect(),
        "cogging-torque" => (1..=ORDERS)
            .map(|order| vec![typical[0], f64::from(order), 0.0])
            .collect(),
        "thermal-expansion" => [1.0, 5.0].iter().map(|&t| vec![typical[0], t]).collect(),
        _ => vec![typical],
    }
}

/// Highest order of cogging that is looked for, per motor turn.
const ORDERS: u8 = 24;

/// Parts of a motion's time in which a force may begin and end.
pub const SLOTS: usize = 24;

/// All candidates of the library, at the state of `fit`.
pub fn candidates(fitter: &Fitter<'_>, fit: &Fit) -> Vec<Candidate> {
    let rigid = matches!(fitter.machine, Machine::Rigid(_));
    let wanted: Vec<(&'static Effect, Vec<f64>)> = EFFECTS
        .iter()
        .filter(|e| e.on_rigid || !rigid)
        .flat_map(|e| {
            shapes(fitter, e)
                .into_iter()
                .map(move |values| (*e, values))
        })
        .collect();
    wanted
        .into_par_iter()
        .map(|(effect, values)| Candidate {
            columns: responses(fitter, fit, effect, &values),
            effect,
            values,
        })
        .collect()
}

/// Secants at half of the typical size: derivatives would say nothing of
/// gaps and dry friction.
fn responses(fitter: &Fitter<'_>, fit: &Fit, effect: &'static Effect, values: &[f64]) -> Columns {
    const SHARE: f64 = 0.5;
    let phase = effect.parameters.iter().position(|p| p.name == "phase");
    let sizes = effect.parameters.iter().enumerate().filter(|(_, p)| p.size);
    let with = |size: usize, angle: Option<f64>| {
        let mut tried = values.to_vec();
        for (value, p) in tried.iter_mut().zip(effect.parameters) {
            if p.size {
                *value = 0.0;
            }
        }
        tried[size] = SHARE * effect.parameters[size].typical;
        if let (Some(at), Some(angle)) = (phase, angle) {
            tried[at] = angle;
        }
        let mut state = fit.state.clone();
        state.effects.push(ActiveEffect {
            effect,
            values: tried,
        });
        fitter.column(fit, state, SHARE)
    };
    match phase {
        Some(_) => sizes
            .flat_map(|(i, _)| [0.0, std::f64::consts::FRAC_PI_2].map(|angle| with(i, Some(angle))))
            .collect(),
        None => sizes.map(|(i, _)| with(i, None)).collect(),
    }
}

/// What each of the candidates that are `wanted` explains of the rest of `fit`
/// beyond what the columns of its own parameters (`own`) can; best first, one
/// entry an effect.
pub fn screen(
    fitter: &Fitter<'_>,
    fit: &Fit,
    own: &Columns,
    library: &[Candidate],
    wanted: impl Fn(&Effect) -> bool + Sync,
) -> Vec<Screened> {
    let layout = &fitter.set.layout;
    let whitener = layout.whitener(&layout.spectral_matrices(&fit.rest));
    let white = |a: &Amplitudes| layout.whiten(&whitener, a);
    let own: Vec<DVector<f64>> = own.iter().map(white).collect();
    let projector = Projector::new(
        fitter.machine,
        &own,
        &pinned(fitter.machine, &fit.state.shares),
    );
    let rest = projector.reject_at(&white(&fit.rest), &fit.state.shares);
    let total = rest.norm_squared();
    let mut screened: Vec<Screened> = responses_in(
        library,
        wanted,
        |column| projector.reject(&white(column)),
        &rest,
    )
    .into_par_iter()
    .map(|response| {
        let matrix = DMatrix::from_columns(&response.columns);
        let svd = matrix.clone().svd(true, true);
        let largest = svd.singular_values.max();
        let solution = svd
            .solve(&rest, 1e-6 * largest.max(1e-300))
            .unwrap_or_else(|_| DVector::zeros(matrix.ncols()));
        let fingerprint = &matrix * &solution;
        let explained = 2.0 * rest.dot(&fingerprint) - fingerprint.norm_squared();
        let share = (explained / total).clamp(0.0, 0.999_999);
        Screened {
            gain: -(rest.len() as f64) * (1.0 - share).ln(),
            values: starting_values(&response, solution.as_slice()),
            basis: svd.u.unwrap_or_else(|| DMatrix::zeros(rest.len(), 1)),
            fingerprint,
            effect: response.effect,
        }
    })
    .collect();
    screened.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let mut seen: Vec<&str> = Vec::new();
    screened.retain(|s| {
        let name = s.effect.name;
        !seen.contains(&name) && {
            seen.push(name);
            true
        }
    });
    screened
}

/// What a candidate does, in a space where other parameters are fitted out.
pub struct Response {
    /// Which.
    pub effect: &'static Effect,
    /// As of its [`Candidate`].
    pub values: Vec<f64>,
    /// One entry a size; two of an effect with a phase.
    pub columns: Vec<DVector<f64>>,
}

/// Responses of those candidates that are `wanted`, `seen` through some
/// projection; of a force in time, the stretch that explains most of `rest`.
pub fn responses_in(
    library: &[Candidate],
    wanted: impl Fn(&Effect) -> bool + Sync,
    seen: impl Fn(&Amplitudes) -> DVector<f64> + Sync,
    rest: &DVector<f64>,
) -> Vec<Response> {
    let one = |c: &Candidate| Response {
        effect: c.effect,
        values: c.values.clone(),
        columns: c.columns.iter().map(&seen).collect(),
    };
    let all: Vec<Response> = library
        .par_iter()
        .filter(|c| wanted(c.effect))
        .map(one)
        .collect();
    let (slots, mut all): (Vec<_>, Vec<_>) = all
        .into_iter()
        .partition(|r| r.effect.name == "process-force");
    all.extend(window(&slots, rest));
    all
}

/// The stretch of neighbouring slots in which a force explains most: what a
/// force does over several is the sum of what it does in each. None where that
/// is the whole motion, as it is a constant load then.
fn window(slots: &[Response], rest: &DVector<f64>) -> Option<Response> {
    let columns: Vec<&DVector<f64>> = slots.iter().filter_map(|s| s.columns.first()).collect();
    let n = columns.len();
    let along: Vec<f64> = columns.iter().map(|c| c.dot(rest)).collect();
    let mut best = (0.0, 0..n);
    let mut gram = DMatrix::zeros(n, n);
    for j in 0..n {
        for i in 0..=j {
            gram[(i, j)] = columns[i].dot(columns[j]);
        }
    }
    for first in 0..n {
        let (mut explained, mut size) = (0.0, 0.0);
        for last in first..n {
            explained += along[last];
            let cross: f64 = (first..last).map(|i| gram[(i, last)]).sum();
            size += gram[(last, last)] + 2.0 * cross;
            let gain = explained * explained / size.max(f64::MIN_POSITIVE);
            if gain > best.0 {
                best = (gain, first..last + 1);
            }
        }
    }
    if best.1.len() == n {
        return None;
    }
    let chosen = slots.get(best.1.clone())?;
    let (first, last) = (chosen.first()?, chosen.last()?);
    let mut values = first.values.clone();
    values[2] = last.values[2];
    let sum = columns[best.1]
        .iter()
        .fold(DVector::zeros(rest.len()), |sum, c| sum + *c);
    Some(Response {
        effect: first.effect,
        values,
        columns: vec![sum],
    })
}

/// Sine of the angle between what was found and the nearest thing that another
/// effect can do.
pub fn sine(found: &DVector<f64>, other: &DMatrix<f64>) -> f64 {
    let norm = found.norm();
    if norm == 0.0 {
        return 0.0;
    }
    let left = found - other * other.tr_mul(found);
    (left.norm() / norm).min(1.0)
}

/// Takes out what the fit's own parameters can do.
///
/// Known parameters have a price, (s/σ)². It is one more row of the problem for
/// each of them: columns of known parameters end in 1/σ there, what is
/// explained ends in 0, and a rest at shares s in −s/σ. So an effect that a
/// known parameter could do, were it allowed to move so far, shows in these rows.
pub struct Projector {
    columns: DMatrix<f64>,
    solved: DMatrix<f64>,
    deviation: f64,
    known: usize,
}

impl Projector {
    /// Of whitened columns, the first of them those of known parameters, of which
    /// some are `pinned` to the edge of their tolerance.
    pub fn new(machine: &Machine, columns: &[DVector<f64>], pinned: &[bool]) -> Self {
        let deviation = known_deviation(machine);
        let known = pinned.len();
        let rows = columns.first().map_or(0, |c| c.len());
        let n = columns.len();
        let columns = DMatrix::from_fn(rows + known, n, |i, j| {
            if j < known && pinned[j] {
                0.0
            } else if i < rows {
                columns[j][i]
            } else if i - rows == j {
                1.0 / deviation
            } else {
                0.0
            }
        });
        let mut normal = columns.tr_mul(&columns);
        for i in 0..n {
            if i >= known {
                normal[(i, i)] += 1e-9 * normal[(i, i)] + 1e-300;
            } else if pinned[i] {
                normal[(i, i)] = 1.0;
            }
        }
        let inverse = normal.cholesky().map(|c| c.inverse());
        Self {
            solved: inverse.unwrap_or_else(|| DMatrix::zeros(n, n)),
            columns,
            deviation,
            known,
        }
    }

    /// What they leave of a whitened column.
    pub fn reject(&self, v: &DVector<f64>) -> DVector<f64> {
        self.reject_at(v, &vec![0.0; self.known])
    }

    /// What they leave of a whitened rest at these shares of the known parameters.
    pub fn reject_at(&self, v: &DVector<f64>, shares: &[f64]) -> DVector<f64> {
        let rows = v.len();
        let whole = DVector::from_fn(rows + self.known, |i, _| {
            if i < rows {
                v[i]
            } else {
                -shares[i - rows] / self.deviation
            }
        });
        &whole - &self.columns * (&self.solved * self.columns.tr_mul(&whole))
    }
}

fn starting_values(response: &Response, solution: &[f64]) -> Vec<f64> {
    let parameters = response.effect.parameters;
    let mut values = response.values.clone();
    let phase = parameters.iter().position(|p| p.name == "phase");
    let mut next = solution.iter();
    for (i, p) in parameters.iter().enumerate().filter(|(_, p)| p.size) {
        let mut size = next.next().copied().unwrap_or(0.0);
        if let Some(at) = phase {
            let quadrature = next.next().copied().unwrap_or(0.0);
            values[at] = quadrature.atan2(size);
            size = size.hypot(quadrature);
        }
        values[i] = (size * p.typical).clamp(p.bounds[0], p.bounds[1]);
    }
    values
}
