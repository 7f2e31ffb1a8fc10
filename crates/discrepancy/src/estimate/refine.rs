//! From a state to the best one near it.

use axis_sim::effects::Scales;
use nalgebra::DVector;

use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::gauss_newton::Descent;
use crate::estimate::step::Solved;

/// Fall of D that is not worth another round.
const ENOUGH: f64 = 0.1;

impl Fitter<'_> {
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
        let correction = self.solve_beside(&fit.rest, &trial, columns, None).step;
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
