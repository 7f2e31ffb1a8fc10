//! Derivatives of what a model leaves, by simulation.

use axis_sim::effects::{ActiveEffect, EffectParameter, FrictionForm, Nature, Scales};
use rayon::prelude::*;

use crate::answers::State;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::known::tolerances;
use crate::spectrum::Amplitudes;

/// Derivatives of all channels with respect to parameters, one entry each.
pub type Columns = Vec<Amplitudes>;

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

/// Indices (effect, parameter) of what a fit moves.
pub fn free_parameters(state: &State) -> Vec<(usize, usize)> {
    let of = |(e, active): (usize, &ActiveEffect)| {
        let parameters = active.effect.parameters;
        let free = (0..parameters.len()).filter(|&p| is_free(&parameters[p]));
        free.map(move |p| (e, p)).collect::<Vec<_>>()
    };
    state.effects.iter().enumerate().flat_map(of).collect()
}

/// Priors of what a fit moves, in the same order: by how much each is off its mean of 0, and the deviation;
/// `None` of what nothing is thought of beforehand.
pub fn priors_of_effects(state: &State) -> Vec<Option<(f64, f64)>> {
    let of = |(e, p): (usize, usize)| {
        let active = &state.effects[e];
        let deviation = FrictionForm::of(active)?.deviation(p)?;
        Some((active.values[p], deviation))
    };
    free_parameters(state).into_iter().map(of).collect()
}

impl Fitter<'_> {
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
    pub(super) fn effect_slopes(&self, fit: &Fit, given: usize) -> Columns {
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

    /// A difference quotient; `None` if the simulation does not run.
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

    /// A difference quotient; nothing if the simulation does not run.
    pub fn column(&self, fit: &Fit, moved: &State, step: f64) -> Amplitudes {
        let slope = self.slope(fit, moved, step);
        slope.unwrap_or_else(|| self.nothing(fit))
    }
}
