//! Screening: what each effect of the library would do to the logs, and how
//! much of the rest that explains.

use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, Machine};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::fit::{Columns, Fit, Fitter, known_deviation};
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
    pub candidate: Candidate,
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
        "process-force" => (0..10)
            .map(|i| {
                vec![
                    typical[0],
                    end * i as f64 / 10.0,
                    end * (i + 1) as f64 / 10.0,
                ]
            })
            .collect(),
        "cogging-torque" => [1.0, 2.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0]
            .iter()
            .map(|&order| vec![typical[0], order, 0.0])
            .collect(),
        "thermal-expansion" => [1.0, 5.0].iter().map(|&t| vec![typical[0], t]).collect(),
        _ => vec![typical],
    }
}

/// All candidates of the library but those `left_out`, at the state of `fit`.
pub fn candidates(fitter: &Fitter<'_>, fit: &Fit, left_out: &[String]) -> Vec<Candidate> {
    let rigid = matches!(fitter.machine, Machine::Rigid(_));
    let active = |effect: &Effect| {
        fit.state
            .effects
            .iter()
            .any(|a| a.effect.name == effect.name)
    };
    let wanted: Vec<(&'static Effect, Vec<f64>)> = EFFECTS
        .iter()
        .filter(|e| (e.on_rigid || !rigid) && !left_out.iter().any(|name| name == e.name))
        // A second bump or harmonic of the same kind may be there.
        .filter(|e| !active(e) || e.name == "cogging-torque")
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

/// What each candidate explains of the rest of `fit` beyond what the columns
/// of its own parameters (`own`) can; best first, one entry an effect.
pub fn screen(fitter: &Fitter<'_>, fit: &Fit, own: &Columns, all: Vec<Candidate>) -> Vec<Screened> {
    let layout = &fitter.set.layout;
    let whitener = layout.whitener(&layout.spectral_matrices(&fit.rest));
    let white = |a: &Amplitudes| layout.whiten(&whitener, a);
    let projector = Projector::new(
        fitter,
        own.iter().map(white).collect(),
        fit.state.shares.len(),
    );
    let rest = projector.reject(&white(&fit.rest));
    let total = rest.norm_squared();
    let mut screened: Vec<Screened> = all
        .into_par_iter()
        .map(|candidate| {
            let columns: Vec<DVector<f64>> = candidate
                .columns
                .iter()
                .map(|c| projector.reject(&white(c)))
                .collect();
            let matrix = DMatrix::from_columns(&columns);
            let svd = matrix.clone().svd(true, true);
            let largest = svd.singular_values.max();
            let solution = svd
                .solve(&rest, 1e-6 * largest.max(1e-300))
                .unwrap_or_else(|_| DMatrix::zeros(columns.len(), 1).column(0).into());
            let fingerprint = &matrix * &solution;
            let explained = 2.0 * rest.dot(&fingerprint) - fingerprint.norm_squared();
            let share = (explained / total).clamp(0.0, 0.999_999);
            Screened {
                gain: -(rest.len() as f64) * (1.0 - share).ln(),
                values: starting_values(&candidate, solution.as_slice()),
                basis: svd.u.unwrap_or_else(|| DMatrix::zeros(rest.len(), 1)),
                fingerprint,
                candidate,
            }
        })
        .collect();
    screened.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let mut seen: Vec<&str> = Vec::new();
    screened.retain(|s| {
        let name = s.candidate.effect.name;
        !seen.contains(&name) && {
            seen.push(name);
            true
        }
    });
    screened
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

/// Takes out what the fit's own parameters can do, known ones at a price.
struct Projector {
    columns: DMatrix<f64>,
    solved: DMatrix<f64>,
}

impl Projector {
    fn new(fitter: &Fitter<'_>, columns: Vec<DVector<f64>>, known: usize) -> Self {
        let n = columns.len();
        let columns = DMatrix::from_columns(&columns);
        let mut normal = columns.tr_mul(&columns);
        let weight = known_deviation(fitter.machine).powi(-2);
        for i in 0..n {
            normal[(i, i)] += if i < known {
                weight
            } else {
                1e-9 * normal[(i, i)] + 1e-300
            };
        }
        let inverse = normal.cholesky().map(|c| c.inverse());
        Self {
            solved: inverse.unwrap_or_else(|| DMatrix::zeros(n, n)),
            columns,
        }
    }

    fn reject(&self, v: &DVector<f64>) -> DVector<f64> {
        v - &self.columns * (&self.solved * self.columns.tr_mul(v))
    }
}

fn starting_values(candidate: &Candidate, solution: &[f64]) -> Vec<f64> {
    let parameters = candidate.effect.parameters;
    let mut values = candidate.values.clone();
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
