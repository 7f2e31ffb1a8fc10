//! Fitting: known parameters inside their tolerance, effects free.

use axis_sim::effects::{ActiveEffect, EffectParameter, Nature, Scales};
use axis_sim::{Axis, ReplayError, Trace};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::answers::{LogSet, State};
use crate::estimate::bounded::{bounded, inverse_of};
use crate::estimate::gauss_newton::Descent;
use crate::estimate::known::{known_deviations, tolerances};
use crate::estimate::thin::products;
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

/// Which effect parameters a fit moves: all but whole numbers and what is given.
pub fn is_free(parameter: &EffectParameter) -> bool {
    !parameter.nature.is_order() && !matches!(parameter.nature, Nature::Held)
}

/// Steps up and down for a difference quotient of an effect's parameter, inside
/// its bounds. A hidden effect and a known parameter may be one quantity: their
/// columns must agree to far better than a hundredth, or the data seem to tell
/// them apart; so quotients are central and steps small.
fn steps_of(parameter: &EffectParameter, value: f64, on: &Scales) -> [f64; 2] {
    let scale = match parameter.nature {
        Nature::Phase => 0.02,
        _ => 0.02 * value.abs().max(parameter.typical(on).abs()),
    };
    let [low, high] = parameter.bounds(on);
    [(high - value).min(scale), (low - value).max(-scale)]
}

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
        let pairs = state.shares.iter().zip(known_deviations(self.machine));
        pairs.map(|(s, deviation)| (s / deviation).powi(2)).sum()
    }

    /// Derivatives with respect to the known parameters, to one side: by steps so small that
    /// what they neglect is a thousandth.
    pub fn known_columns(&self, fit: &Fit) -> Columns {
        let tolerances = tolerances(self.machine);
        let column = |i: usize| {
            // Of what is hardly known a small step, as of what is.
            let step = 0.04 * tolerances[i].min(0.05);
            let to = |by: f64| {
                let mut state = fit.state.clone();
                state.shares[i] += by;
                self.slope(fit, &state, by)
            };
            let slope = to(step).or_else(|| to(-step));
            slope.unwrap_or_else(|| self.nothing(fit))
        };
        (0..fit.state.shares.len())
            .into_par_iter()
            .map(column)
            .collect()
    }

    /// Derivatives with respect to the free parameters of the effects, but for the
    /// first `given` of them.
    pub fn effect_columns(&self, fit: &Fit, given: usize) -> Columns {
        let scales = Scales::of(self.machine);
        let column = |(e, p): (usize, usize)| {
            let active = &fit.state.effects[e];
            let steps = steps_of(&active.effect.parameters[p], active.values[p], &scales);
            let at = |by: f64| {
                let mut state = fit.state.clone();
                state.effects[e].values[p] += by;
                state
            };
            self.quotient(fit, steps.map(at), steps[0] - steps[1])
        };
        let free = free_parameters(&fit.state);
        let new = free.into_par_iter().skip(given);
        new.map(column).collect()
    }

    /// The same to one side, which costs half and is near enough for a step of a fit.
    fn effect_slopes(&self, fit: &Fit, given: usize) -> Columns {
        let scales = Scales::of(self.machine);
        let column = |(e, p): (usize, usize)| {
            let active = &fit.state.effects[e];
            let steps = steps_of(&active.effect.parameters[p], active.values[p], &scales);
            let [up, down] = steps.map(|by: f64| 0.2 * by);
            let by = if up >= -down { up } else { down };
            let mut state = fit.state.clone();
            state.effects[e].values[p] += by;
            let slope = self.slope(fit, &state, by);
            slope.unwrap_or_else(|| self.nothing(fit))
        };
        let free = free_parameters(&fit.state);
        free.into_par_iter().skip(given).map(column).collect()
    }

    /// A difference quotient; `None` where the simulation does not run.
    fn slope(&self, fit: &Fit, moved: &State, by: f64) -> Option<Amplitudes> {
        let traces = self.set.simulate(self.machine, moved).ok()?;
        Some(self.set.difference(&traces, &fit.traces, by))
    }

    fn quotient(&self, fit: &Fit, states: [State; 2], width: f64) -> Amplitudes {
        let run = |state: &State| self.set.simulate(self.machine, state);
        match (run(&states[0]), run(&states[1])) {
            (Ok(up), Ok(down)) => self.set.difference(&up, &down, width),
            _ => self.nothing(fit),
        }
    }

    /// No change at all.
    pub fn nothing(&self, fit: &Fit) -> Amplitudes {
        let zeros = |bins: &Vec<_>| vec![Default::default(); bins.len()];
        fit.rest.iter().map(zeros).collect()
    }

    /// A difference quotient; nothing where the simulation does not run.
    pub fn column(&self, fit: &Fit, moved: &State, step: f64) -> Amplitudes {
        let slope = self.slope(fit, moved, step);
        slope.unwrap_or_else(|| self.nothing(fit))
    }

    /// Gauss–Newton from `fit`, with re-simulation in every round. Derivatives
    /// with respect to the first parameters, known ones and then those of effects,
    /// are `given` and may be from a neighbouring state; the others are made anew.
    ///
    /// # Errors
    /// [`ReplayError`] never of trial steps, which are shortened instead.
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

    /// The known parameters fitted, and their derivatives where that ends. `known` are those
    /// where it begins, and are made anew where it has left their range: where tolerances are
    /// wide, D is lowest along a narrow curve (all that scales a torque together), along which
    /// old derivatives lead in ever smaller steps.
    pub fn calibrated(&self, mut fit: Fit, mut known: Columns) -> (Fit, Columns) {
        for _ in 0..CALIBRATIONS {
            let (before, from) = (fit.deviance, fit.state.shares.clone());
            fit = self.refine(fit, &known, 4);
            let moved = farthest(&from, &fit.state.shares);
            tracing::debug!(before, after = fit.deviance, moved, "calibrated");
            if moved > SAME {
                known = self.known_columns(&fit);
            }
            if moved <= SAME || before - fit.deviance < SETTLED {
                break;
            }
        }
        (fit, known)
    }

    /// Fitted by least squares, the rest weighed by the spectral matrices of this `noise`,
    /// which do not change: D is flat where a rest is large, as the rest is then its own weight,
    /// and has minima of its own there; a sum of squares has not. `known` are the derivatives
    /// with respect to the known parameters where it begins; they are made anew `anew` times at
    /// most.
    pub fn by_least_squares(
        &self,
        mut fit: Fit,
        mut known: Columns,
        noise: &Amplitudes,
        anew: usize,
    ) -> Fit {
        let layout = &self.set.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(noise));
        let squares = |fit: &Fit| {
            layout.whiten(&whitener, &fit.rest).norm_squared() + self.departure(&fit.state)
        };
        let descent = Descent {
            rounds: 4,
            lengths: 4,
            shorter: 0.35,
        };
        for round in 0..=anew {
            let (before, from) = (squares(&fit), fit.state.shares.clone());
            let step = |fit: &Fit| {
                let effects = self.effect_slopes(fit, 0);
                let columns = known.iter().cloned().chain(effects).collect();
                Some(self.solve_beside(noise, fit, &columns).step)
            };
            let better = |fit: &Fit, step: &DVector<f64>, length: f64| {
                let trial = self.at(self.moved(&fit.state, step, length)).ok()?;
                (squares(&trial) < squares(fit)).then_some(trial)
            };
            fit = descent.from(fit, step, better, |before, after| {
                squares(before) - squares(after) >= SETTLED
            });
            let after = squares(&fit);
            let moved = farthest(&from, &fit.state.shares);
            tracing::debug!(
                before,
                after,
                moved,
                deviance = fit.deviance,
                "least squares"
            );
            if round == anew || moved <= SAME || before - after < SETTLED {
                break;
            }
            known = self.known_columns(&fit);
        }
        fit
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

    /// Step and covariance of all parameters from the linearised problem: the
    /// rest's own spectral matrices as weights, the tolerances as priors.
    pub fn solve(&self, fit: &Fit, columns: &Columns) -> Solved {
        self.solve_beside(&fit.rest, fit, columns)
    }

    /// The same with the spectral matrices of another rest as weights.
    fn solve_beside(&self, weighing: &Amplitudes, fit: &Fit, columns: &Columns) -> Solved {
        let layout = &self.set.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(weighing));
        let rest = layout.whiten(&whitener, &fit.rest);
        let known = fit.state.shares.len();
        let n = columns.len();
        let mut jacobian = DMatrix::zeros(rest.len(), n);
        for (i, column) in columns.iter().enumerate() {
            jacobian.set_column(i, &layout.whiten(&whitener, column));
        }
        let mut normal = products(&jacobian);
        let mut right = jacobian.tr_mul(&rest);
        for (i, deviation) in known_deviations(self.machine).into_iter().enumerate() {
            let weight = deviation.powi(-2);
            normal[(i, i)] += weight;
            right[i] -= weight * fit.state.shares[i];
        }
        let tolerances = tolerances(self.machine);
        let of_effects = self.rooms_of_effects(&fit.state);
        let of_known = |i: usize| {
            let (share, most) = (fit.state.shares.get(i)?, tolerances[i]);
            Some([-most - share, most - share])
        };
        let step = bounded(&normal, &right, of_known);
        let mut pairs = of_effects.iter().zip(step.iter().skip(known));
        let leaves = |([low, high], by): (&[f64; 2], &f64)| !(low..=high).contains(&by);
        let inside = pairs.any(leaves).then(|| {
            let of_effect = |i: usize| of_effects.get(i.checked_sub(known)?).copied();
            bounded(&normal, &right, |i| of_known(i).or_else(|| of_effect(i)))
        });
        Solved {
            promised: 2.0 * step.dot(&right) - step.dot(&(&normal * &step)),
            inside,
            step,
            covariance: inverse_of(&normal),
        }
    }
}

/// The linearised problem, solved.
pub struct Solved {
    /// To its minimum inside the known parameters' tolerance.
    pub step: DVector<f64>,
    /// The same where the parameters of effects, too, move no farther than their derivatives hold;
    /// `None` where they do so anyway. Of two that do nearly the same, as a force and the way over
    /// which it comes, one that is cut short afterwards leaves the other where it is of no use.
    pub inside: Option<DVector<f64>>,
    /// By how much D falls on the way, if the problem is as linear as that.
    pub promised: f64,
    /// Of all parameters.
    pub covariance: DMatrix<f64>,
}

/// Change of a known parameter, as a share of it, over which its derivatives are the same to
/// far better than a hundredth.
const SAME: f64 = 1e-3;

/// Times that they are made anew at most.
const CALIBRATIONS: usize = 4;

/// Fall of D, or of a sum of squares, that is not worth another round of derivatives.
const SETTLED: f64 = 2.0;

/// The largest of the changes from one state to another.
fn farthest(from: &[f64], to: &[f64]) -> f64 {
    let changes = from.iter().zip(to).map(|(a, b)| (a - b).abs());
    changes.fold(0.0, f64::max)
}

/// Fall of D that is not worth another round.
const ENOUGH: f64 = 0.1;

/// Indices (effect, parameter) of what a fit moves.
pub fn free_parameters(state: &State) -> Vec<(usize, usize)> {
    let of = |(e, active): (usize, &ActiveEffect)| {
        let parameters = active.effect.parameters;
        let free = (0..parameters.len()).filter(|&p| is_free(&parameters[p]));
        free.map(move |p| (e, p)).collect::<Vec<_>>()
    };
    state.effects.iter().enumerate().flat_map(of).collect()
}

impl Fitter<'_> {
    /// A state so far along a step of all its parameters, inside their bounds.
    pub(crate) fn moved(&self, state: &State, step: &DVector<f64>, length: f64) -> State {
        let scales = Scales::of(self.machine);
        let rooms = self.rooms_of_effects(state);
        let mut state = state.clone();
        let known = state.shares.len();
        for (share, by) in state.shares.iter_mut().zip(step.iter()) {
            *share += length * by;
        }
        let free = free_parameters(&state).into_iter().zip(rooms);
        for (i, ((e, p), [least, most])) in free.enumerate() {
            let [low, high] = state.effects[e].effect.parameters[p].bounds(&scales);
            let value = &mut state.effects[e].values[p];
            let by = (length * step[known + i]).clamp(least, most);
            *value = (*value + by).clamp(low, high);
        }
        state
    }

    /// By how much one step may change each free parameter of the effects, down and up: inside its
    /// bounds, and of a shape not so far that its derivative is another one.
    fn rooms_of_effects(&self, state: &State) -> Vec<[f64; 2]> {
        let scales = Scales::of(self.machine);
        let room = |(e, p): (usize, usize)| {
            let parameter = &state.effects[e].effect.parameters[p];
            let value = state.effects[e].values[p];
            let most = match parameter.nature {
                _ if parameter.is_size() => f64::INFINITY,
                Nature::Phase => 1.0,
                _ => 0.3 * parameter.typical(&scales).abs().max(value.abs()),
            };
            let [low, high] = parameter.bounds(&scales);
            [
                (low - value).clamp(-most, 0.0),
                (high - value).clamp(0.0, most),
            ]
        };
        free_parameters(state).into_iter().map(room).collect()
    }
}
