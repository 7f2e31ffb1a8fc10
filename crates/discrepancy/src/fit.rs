//! Fitting: known parameters inside their tolerance, effects free.

use axis_sim::effects::{ActiveEffect, EffectParameter, Machine};
use axis_sim::{ReplayError, Trace};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::known::tolerance;
use crate::model::{LogSet, State};
use crate::spectrum::Amplitudes;

/// A fitted model.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Parameters.
    pub state: State,
    /// Its simulations of the logs.
    pub traces: Vec<Trace>,
    /// What they leave.
    pub rest: Amplitudes,
    /// D of the rest, and the known parameters' departures.
    pub deviance: f64,
}

/// Derivatives of all channels with respect to parameters, one entry each.
pub type Columns = Vec<Amplitudes>;

/// Which effect parameters a fit moves: all but whole numbers.
pub fn is_free(parameter: &EffectParameter) -> bool {
    parameter.name != "order"
}

/// Standard deviation of a known parameter's departure: that of a uniform
/// distribution over its tolerance.
pub fn known_deviation(machine: &Machine) -> f64 {
    tolerance(machine) / 3f64.sqrt()
}

/// Step for a difference quotient of an effect's parameter.
fn step_of(parameter: &EffectParameter, value: f64) -> f64 {
    let scale = if parameter.size {
        0.1 * parameter.typical.abs().max(value.abs())
    } else if parameter.unit == "rad" {
        0.1
    } else {
        0.02 * value.abs().max(0.05 * parameter.typical.abs())
    };
    // Towards the inside.
    if value + scale > parameter.bounds[1] {
        -scale
    } else {
        scale
    }
}

/// The fit of a set of logs by a machine.
pub struct Fitter<'a> {
    /// Machine as its file says.
    pub machine: &'a Machine,
    /// Logs.
    pub set: &'a LogSet,
}

impl Fitter<'_> {
    /// The model at a state.
    ///
    /// # Errors
    /// [`ReplayError`] where a simulation does not run.
    pub fn at(&self, state: State) -> Result<Fit, ReplayError> {
        let traces = self.set.simulate(self.machine, &state)?;
        let rest = self.set.amplitudes(&self.set.rest(&traces));
        let deviance = self.set.layout.deviance(&rest) + self.departure(&state);
        Ok(Fit {
            state,
            traces,
            rest,
            deviance,
        })
    }

    fn departure(&self, state: &State) -> f64 {
        let deviation = known_deviation(self.machine);
        state.shares.iter().map(|s| (s / deviation).powi(2)).sum()
    }

    /// Derivatives with respect to the known parameters.
    pub fn known_columns(&self, fit: &Fit) -> Columns {
        let step = 0.2 * tolerance(self.machine);
        let column = |i: usize| {
            let mut state = fit.state.clone();
            state.shares[i] += step;
            self.column(fit, state, step)
        };
        (0..fit.state.shares.len())
            .into_par_iter()
            .map(column)
            .collect()
    }

    /// Derivatives with respect to the free parameters of the effects.
    pub fn effect_columns(&self, fit: &Fit) -> Columns {
        let column = |(e, p): (usize, usize)| {
            let mut state = fit.state.clone();
            let parameter = &state.effects[e].effect.parameters[p];
            let step = step_of(parameter, state.effects[e].values[p]);
            state.effects[e].values[p] += step;
            self.column(fit, state, step)
        };
        free_parameters(&fit.state)
            .into_par_iter()
            .map(column)
            .collect()
    }

    /// A difference quotient; a simulation that does not run has none.
    pub fn column(&self, fit: &Fit, moved: State, step: f64) -> Amplitudes {
        match self.set.simulate(self.machine, &moved) {
            Ok(traces) => self.set.difference(&traces, &fit.traces, step),
            Err(_) => fit
                .rest
                .iter()
                .map(|bins| vec![Default::default(); bins.len()])
                .collect(),
        }
    }

    /// Gauss–Newton from `fit`, with re-simulation in every round. `known`
    /// may be from a neighbouring state; effects' derivatives are made anew.
    ///
    /// # Errors
    /// [`ReplayError`] never of trial steps, which are shortened instead.
    pub fn refine(&self, mut fit: Fit, known: &Columns, rounds: usize) -> Fit {
        for _ in 0..rounds {
            let columns: Vec<Amplitudes> = known
                .iter()
                .cloned()
                .chain(self.effect_columns(&fit))
                .collect();
            let (step, _) = self.solve(&fit, &columns);
            let before = fit.deviance;
            let mut best = fit.clone();
            let mut length = 1.0;
            for _ in 0..4 {
                let state = moved(&fit.state, &step, length);
                if let Ok(trial) = self.at(state)
                    && trial.deviance < best.deviance
                {
                    best = trial;
                    break;
                }
                length *= 0.35;
            }
            fit = best;
            if before - fit.deviance < 0.1 {
                break;
            }
        }
        fit
    }

    /// Step and covariance of all parameters from the linearised problem: the
    /// rest's own spectral matrices as weights, the tolerances as priors.
    pub fn solve(&self, fit: &Fit, columns: &Columns) -> (DVector<f64>, DMatrix<f64>) {
        let layout = &self.set.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(&fit.rest));
        let rest = layout.whiten(&whitener, &fit.rest);
        let known = fit.state.shares.len();
        let n = columns.len();
        let mut jacobian = DMatrix::zeros(rest.len(), n);
        for (i, column) in columns.iter().enumerate() {
            jacobian.set_column(i, &layout.whiten(&whitener, column));
        }
        let mut normal = jacobian.tr_mul(&jacobian);
        let mut right = jacobian.tr_mul(&rest);
        let weight = known_deviation(self.machine).powi(-2);
        for i in 0..known {
            normal[(i, i)] += weight;
            right[i] -= weight * fit.state.shares[i];
        }
        let scale = DVector::from_fn(n, |i, _| {
            let own = normal[(i, i)];
            if own > 0.0 { 1.0 / own.sqrt() } else { 1.0 }
        });
        let scaled = DMatrix::from_fn(n, n, |i, j| {
            normal[(i, j)] * scale[i] * scale[j] + if i == j { 1e-12 } else { 0.0 }
        });
        let inverse = scaled.clone().cholesky().map(|c| c.inverse());
        let inverse = inverse.unwrap_or_else(|| DMatrix::zeros(n, n));
        let covariance = DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * scale[i] * scale[j]);
        let right = right.component_mul(&scale);
        let room = |i: usize| {
            (i < known).then(|| {
                let (share, most) = (fit.state.shares[i], tolerance(self.machine));
                [(-most - share) / scale[i], (most - share) / scale[i]]
            })
        };
        (
            bounded(&scaled, &right, room).component_mul(&scale),
            covariance,
        )
    }
}

/// The step that minimises the quadratic with some coordinates kept in their
/// `room`: those that would leave it are set to its edge, one by one, the worst
/// first, and the others are solved for again.
fn bounded(
    normal: &DMatrix<f64>,
    right: &DVector<f64>,
    room: impl Fn(usize) -> Option<[f64; 2]>,
) -> DVector<f64> {
    let n = right.len();
    let mut fixed: Vec<Option<f64>> = vec![None; n];
    loop {
        let free: Vec<usize> = (0..n).filter(|&i| fixed[i].is_none()).collect();
        let matrix = DMatrix::from_fn(free.len(), free.len(), |a, b| normal[(free[a], free[b])]);
        let side = DVector::from_fn(free.len(), |a, _| {
            let held = (0..n).filter_map(|j| fixed[j].map(|value| normal[(free[a], j)] * value));
            right[free[a]] - held.sum::<f64>()
        });
        let solved = matrix.cholesky().map(|c| c.solve(&side));
        let solved = solved.unwrap_or_else(|| DVector::zeros(free.len()));
        let beyond = |(a, &i): (usize, &usize)| {
            let [low, high] = room(i)?;
            let edge = solved[a].clamp(low.min(0.0), high.max(0.0));
            let by = (solved[a] - edge).abs();
            (by > 1e-9 * (1.0 + edge.abs())).then_some((i, edge, by))
        };
        let worst = free
            .iter()
            .enumerate()
            .filter_map(beyond)
            .max_by(|a, b| a.2.total_cmp(&b.2));
        match worst {
            Some((i, edge, _)) => fixed[i] = Some(edge),
            None => {
                let mut step = DVector::from_fn(n, |i, _| fixed[i].unwrap_or(0.0));
                for (a, &i) in free.iter().enumerate() {
                    step[i] = solved[a];
                }
                return step;
            }
        }
    }
}

/// Indices (effect, parameter) of what a fit moves.
pub fn free_parameters(state: &State) -> Vec<(usize, usize)> {
    let of = |(e, active): (usize, &ActiveEffect)| {
        let parameters = active.effect.parameters;
        let free = (0..parameters.len()).filter(|&p| is_free(&parameters[p]));
        free.map(move |p| (e, p)).collect::<Vec<_>>()
    };
    state.effects.iter().enumerate().flat_map(of).collect()
}

fn moved(state: &State, step: &DVector<f64>, length: f64) -> State {
    let mut state = state.clone();
    let known = state.shares.len();
    for (share, by) in state.shares.iter_mut().zip(step.iter()) {
        *share += length * by;
    }
    for (i, (e, p)) in free_parameters(&state).into_iter().enumerate() {
        let parameter = state.effects[e].effect.parameters[p];
        let mut by = length * step[known + i];
        if !parameter.size {
            // A shape that moves far has left the range of its derivative.
            let most = if parameter.unit == "rad" {
                1.0
            } else {
                0.3 * parameter
                    .typical
                    .abs()
                    .max(state.effects[e].values[p].abs())
            };
            by = by.clamp(-most, most);
        }
        let value = state.effects[e].values[p] + by;
        state.effects[e].values[p] = value.clamp(parameter.bounds[0], parameter.bounds[1]);
    }
    state
}
