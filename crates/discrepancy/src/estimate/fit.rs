//! Fitting: known parameters inside their tolerance, effects free.

use axis_sim::effects::Scales;
use axis_sim::{Axis, ReplayError, Trace};
use nalgebra::DVector;

use crate::answers::{LogSet, State};
use crate::estimate::columns::Columns;
use crate::estimate::gauss_newton::Descent;
use crate::estimate::known::known_deviations;
use crate::estimate::step::Solved;
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
    /// D of the residual, and the known parameters' departures.
    pub deviance: f64,
}

impl Fit {
    /// The one with the lower D.
    pub(crate) fn better(self, other: Self) -> Self {
        if other.deviance < self.deviance {
            other
        } else {
            self
        }
    }
}

/// Fall of D that is not worth another round.
const ENOUGH: f64 = 0.1;

/// The fit of a set of logs by a machine.
pub struct Fitter<'a> {
    /// Machine as its file says.
    pub machine: &'a Axis,
    /// Logs.
    pub set: &'a LogSet,
}

impl Fitter<'_> {
    /// The model at a state.
    ///
    /// # Errors
    /// [`ReplayError`] if a simulation does not run.
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

    /// What the known parameters' departures count in D.
    pub(crate) fn departure(&self, state: &State) -> f64 {
        let pairs = state.shares.iter().zip(known_deviations(self.machine));
        pairs.map(|(s, deviation)| (s / deviation).powi(2)).sum()
    }

    /// Gauss–Newton from `fit`, with re-simulation in every round. Derivatives
    /// with respect to the first parameters, known ones and then those of effects,
    /// are `given` and may be from a neighbouring state; the others are made anew. A trial
    /// step that does not run is shortened.
    pub fn refine(&self, fit: Fit, given: &Columns, rounds: usize) -> Fit {
        let of_effects = given.len() - fit.state.shares.len();
        let step = |fit: &Fit| {
            let new = self.effect_slopes(fit, of_effects);
            let columns: Columns = given.iter().cloned().chain(new).collect();
            let solved = self.solve(fit, &columns);
            (solved.promised >= ENOUGH).then_some((solved, columns))
        };
        let better = |fit: &Fit, (solved, columns): &(Solved, Columns), length: f64| {
            let along = |step: &DVector<f64>| {
                let trial = self.at(self.moved(&fit.state, step, length)).ok()?;
                self.below(fit, trial, columns)
            };
            let inside = || along(solved.inside.as_ref().filter(|_| length == 1.0)?);
            along(&solved.step).or_else(inside)
        };
        let descent = Descent {
            rounds,
            lengths: 4,
            shorter: 0.35,
        };
        descent.from(fit, step, better, |before, after| {
            before.deviance - after.deviance >= ENOUGH
        })
    }

    /// What a trial step reaches, where that has a lower D than `fit`: as it is, or after
    /// a correction by what the step left, with the same derivatives and weights. Where
    /// two parameters do nearly the same, as a torque constant does through the known one,
    /// D is lowest along a narrow curve, and a step along its tangent leaves it
    /// (second-order correction: Nocedal and Wright, Numerical Optimization, 2nd ed., §15.6).
    fn below(&self, fit: &Fit, trial: Fit, columns: &Columns) -> Option<Fit> {
        if trial.deviance < fit.deviance {
            return Some(trial);
        }
        let correction = self.solve_beside(&fit.rest, &trial, columns).step;
        let corrected = self.at(self.moved(&trial.state, &correction, 1.0)).ok()?;
        (corrected.deviance < fit.deviance).then_some(corrected)
    }

    /// Begins with the sizes of the last effects, `count` of them, or with
    /// multiples of them: a gap or a dry force does not grow as its response at
    /// one size says.
    pub fn best_size(&self, fit: Fit, count: usize) -> Fit {
        let scales = Scales::of(self.machine);
        let times = |by: f64| {
            let mut state = fit.state.clone();
            for active in state.effects.iter_mut().rev().take(count) {
                let parameters = active.effect.parameters;
                for (value, p) in active.values.iter_mut().zip(parameters) {
                    if p.is_size() {
                        let [low, high] = p.bounds(&scales);
                        *value = (*value * by).clamp(low, high);
                    }
                }
            }
            self.at(state).ok()
        };
        let tried = [0.5, 2.0, 4.0, 8.0, 16.0].map(times).into_iter().flatten();
        tried.fold(fit.clone(), Fit::better)
    }
}
