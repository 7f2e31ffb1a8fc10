//! Derivatives of what a model leaves, by simulation.

use axis_sim::effects::{ActiveEffect, EffectParameter, Nature, Scales};
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

/// A derivative holds over a step if that over a part of it differs by less than this share.
const HOLDS: f64 = 0.1;

/// By how much a step is shortened, and how often at most: to 1/625.
const SHORTER: f64 = 5.0;
const SHORTENED: usize = 4;

/// Whether an answer bends with a parameter: as with shapes, but not with a size; a phase has a step of its own.
fn is_curved(parameter: &EffectParameter) -> bool {
    !parameter.is_size() && !matches!(parameter.nature, Nature::Phase)
}

/// The step that goes farther, of one up and one down.
fn farther([up, down]: [f64; 2]) -> f64 {
    if up >= -down { up } else { down }
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
            let at = |by: f64| fit.state.with_moved((e, p), by);
            let steps = match is_curved(&active.effect.parameters[p]) {
                true => {
                    let (by, _) = self.holding_slope(fit, (e, p), farther(steps));
                    steps.map(|step| step.clamp(-by.abs(), by.abs()))
                }
                false => steps,
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
            let by = 0.2 * farther(steps);
            let slope = match is_curved(&active.effect.parameters[p]) {
                true => self.holding_slope(fit, (e, p), by).1,
                false => self.slope(fit, &fit.state.with_moved((e, p), by), by),
            };
            slope.unwrap_or_else(|| self.nothing(fit))
        };
        let free = free_parameters(&fit.state);
        free.into_par_iter().skip(given).map(column).collect()
    }

    /// A step, at most `by`, over which a derivative holds, and that derivative: in forty periods of a load a step of 2.6 % of
    /// the period is a whole turn of its phase.
    fn holding_slope(
        &self,
        fit: &Fit,
        place: (usize, usize),
        by: f64,
    ) -> (f64, Option<Amplitudes>) {
        let layout = &self.set.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(&fit.rest));
        let slope = |by: f64| self.slope(fit, &fit.state.with_moved(place, by), by);
        let (mut by, mut wide) = (by, slope(by));
        for _ in 0..SHORTENED {
            let shorter = by / SHORTER;
            let near = slope(shorter);
            let holds = match (&wide, &near) {
                (Some(wide), Some(near)) => {
                    let [wide, near] = [wide, near].map(|s| layout.whiten(&whitener, s));
                    (&wide - &near).norm() <= HOLDS * near.norm()
                }
                _ => near.is_none(),
            };
            (by, wide) = (shorter, near);
            if holds {
                break;
            }
        }
        (by, wide)
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

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use axis_log::{Channel, Log};
    use axis_sim::Axis;
    use axis_sim::effects::{ActiveEffect, Effect};

    use crate::answers::{LogSet, State};
    use crate::estimate::fit::Fitter;

    const BENCH: &str = "schema = 2\nname = \"bench\"\n[mechanism]\nkind = \"torque-motor\"\ntable_inertia_kg_m2 = 0.3\n[actuator]\nkind = \"torque-source\"\ntorque_limit_n_m = 1000\nbandwidth_hz = 1e6\n[friction]\nkind = \"coulomb-rotary\"\nviscous_n_m_s_per_rad = 0\ncoulomb_n_m = 1\npresliding_rad = 1e-4\n[stroke]\nminimum_rad = -100\nmaximum_rad = 100\nstart_rad = 0\n";

    /// A load of 0.15 s in a log of 8 s: fifty periods, of which a step of 2.7 % makes more than one turn of the phase.
    #[test]
    fn the_derivative_of_a_period_holds_in_a_log_of_many() {
        let machine = Axis::parse("bench.toml", BENCH).unwrap();
        let times: Vec<f64> = (0..8000).map(|k| 1e-3 * f64::from(k)).collect();
        let wave = |t: &f64| (TAU * 0.4 * t).sin() + (TAU * 1.1 * t).sin();
        // Torques with a little of everything, so that no band is without a residual.
        let torque = |t: &f64| wave(t) + 0.1 * (37.0 * t * t).sin();
        let channels = [
            ("t_s", times.clone()),
            ("position_rad", times.iter().map(wave).collect()),
            ("torque_n_m", times.iter().map(torque).collect()),
        ];
        let channels = channels.map(|(name, samples)| Channel::new(name, samples).unwrap());
        let log = Log::new(channels.to_vec()).unwrap();
        let set = LogSet::new(vec![("log".to_owned(), log, 1e-3)], &machine).unwrap();
        let fitter = Fitter {
            machine: &machine,
            set: &set,
        };
        let mut state = State::initial(&machine);
        state.effects.push(ActiveEffect {
            effect: Effect::named("cyclic-load").unwrap(),
            values: vec![0.5, 0.15, 0.4],
        });
        let fit = fitter.at(state).unwrap();
        let by = 1e-7;
        let true_slope = fitter
            .slope(&fit, &fit.state.with_moved((0, 1), by), by)
            .unwrap();
        let layout = &set.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(&fit.rest));
        let off = |column: &crate::spectrum::Amplitudes| {
            let [own, right] = [column, &true_slope].map(|s| layout.whiten(&whitener, s));
            (&own - &right).norm() / right.norm()
        };
        let all = [
            fitter.effect_slopes(&fit, 0),
            fitter.effect_columns(&fit, 0),
        ];
        let off = all.map(|columns| off(&columns[1]));
        println!("{off:?}");
        assert!(off[0] < 0.05 && off[1] < 0.01, "{off:?}");
    }
}
