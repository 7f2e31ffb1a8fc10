//! What each effect of the library does on a set of logs.

use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, EffectParameter, Nature, Scales};
use axis_sim::{Axis, ReplayError, position_shown};
use rayon::prelude::*;

use crate::answers::{LogSet, Prepared, State};
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::linear::Room;
use crate::name::curves::Curves;

/// What all effects, and curves for what is no effect, do on a set of logs.
#[derive(Debug)]
pub struct Library {
    pub(crate) candidates: Vec<Candidate>,
    pub(crate) curves: Curves,
    /// Of the known parameters, as derivatives.
    pub(crate) known: Columns,
}

impl Library {
    pub(crate) fn new(fitter: &Fitter<'_>, fit: &Fit, known: Columns) -> Self {
        Self {
            curves: Curves::new(fitter.machine, fitter.set, fit),
            candidates: candidates(fitter, fit, |_| true),
            known,
        }
    }

    /// Of those effects that are `wanted` and that the machine can have, on the motions of
    /// these logs; a search with it names no other, and looks for nothing that is no effect.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine as its file says does not run the logs.
    pub fn of_effects(
        machine: &Axis,
        logs: &LogSet,
        wanted: impl Fn(&Effect) -> bool,
    ) -> Result<Self, ReplayError> {
        let fitter = Fitter { machine, set: logs };
        let start = fitter.at(State::initial(machine))?;
        Ok(Self {
            known: fitter.known_columns(&start),
            candidates: candidates(&fitter, &start, wanted),
            curves: Curves::default(),
        })
    }

    /// Whether it has what this machine's known parameters do, on logs like these.
    pub(crate) fn fits(&self, machine: &Axis, logs: &LogSet) -> bool {
        let of_candidates = self.candidates.iter().flat_map(|c| &c.columns);
        let mut columns = self.known.iter().chain(of_candidates);
        self.known.len() == machine.known().len() && columns.all(|c| logs.layout.holds(c))
    }
}

/// An effect with one choice of its shape.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Which.
    pub effect: &'static Effect,
    /// Starting values, sizes typical.
    pub values: Vec<f64>,
    /// How large things are on the axis.
    pub scales: Scales,
    /// Response to each size parameter at its typical value; for an effect
    /// with a phase, to phase 0 and to phase π/2.
    pub columns: Columns,
}

/// Bounds of an effect's columns, which are those of typical sizes; one with a
/// phase has two, free both.
pub fn rooms(effect: &Effect, on: &Scales) -> Vec<Room> {
    let phase = phase_of(effect).is_some();
    let room = |p: &EffectParameter| {
        let typical = p.typical(on);
        let mut edges = p.bounds(on).map(|edge| edge / typical);
        edges.sort_by(f64::total_cmp);
        Some(edges)
    };
    let sizes = effect.parameters.iter().filter(|p| p.is_size());
    match phase {
        true => sizes.flat_map(|_| [None, None]).collect(),
        false => sizes.map(room).collect(),
    }
}

/// Values of an effect whose columns count so often.
pub fn values_at(effect: &Effect, values: &[f64], solution: &[f64], on: &Scales) -> Vec<f64> {
    let parameters = effect.parameters;
    let mut values = values.to_vec();
    let phase = phase_of(effect);
    let mut next = solution.iter();
    for (i, p) in parameters.iter().enumerate().filter(|(_, p)| p.is_size()) {
        let mut size = next.next().copied().unwrap_or(0.0);
        if let Some(at) = phase {
            let quadrature = next.next().copied().unwrap_or(0.0);
            values[at] = quadrature.atan2(size);
            size = size.hypot(quadrature);
        }
        let [low, high] = p.bounds(on);
        values[i] = (size * p.typical(on)).clamp(low, high);
    }
    values
}

/// The place of an effect's phase among its parameters.
pub fn phase_of(effect: &Effect) -> Option<usize> {
    effect.place_of(|nature| matches!(nature, Nature::Phase))
}

/// Orders of a turn: all from the least to the greatest that slots and magnets that are not alike
/// make, and those of the magnets above.
fn turn_orders([least, most]: [u8; 2], pole_pairs: Option<f64>) -> Vec<f64> {
    let low = (least..=most).map(f64::from);
    let multiples = |pairs: f64| (1..=12).map(move |k| 2.0 * pairs * f64::from(k));
    let of_magnets = pole_pairs.into_iter().flat_map(multiples);
    low.chain(of_magnets.filter(|order| *order > f64::from(most)))
        .collect()
}

/// Values of shape parameters to begin with: all combinations of what each nature asks
/// for, a width being a part of the stroke that the logs cover, an end the end of the
/// slot that it begins with.
fn shapes(fitter: &Fitter<'_>, effect: &Effect) -> Vec<Vec<f64>> {
    let duration = |l: &Prepared| l.log.len() as f64 * l.period;
    let end = fitter.set.logs.iter().map(duration).fold(0.0, f64::max);
    let logs = fitter.set.logs.iter();
    let positions = logs.map(|l| position_shown(&l.log, fitter.machine).unwrap_or_default());
    let (low, high) = positions.fold((f64::MAX, f64::MIN), |ends, positions| {
        let wider = |(a, b): (f64, f64), &x: &f64| (a.min(x), b.max(x));
        positions.iter().fold(ends, wider)
    });
    let scales = Scales::of(fitter.machine);
    let slot = end / SLOTS as f64;
    let mut all = vec![effect.typical(&scales)];
    for (i, p) in effect.parameters.iter().enumerate() {
        let begins: Vec<f64> = match p.nature {
            Nature::Size { .. } | Nature::Phase | Nature::End(_) | Nature::Held => continue,
            Nature::Speed(starts, _) => starts.map(|v| v * scales.ratio(p.measure)).to_vec(),
            Nature::Time(starts, _) => starts.to_vec(),
            Nature::Extent(starts, _) => {
                starts.iter().map(|v| v * scales.ratio(p.measure)).collect()
            }
            Nature::Frequency(starts, _) => match side_by_side(fitter.set, p.bounds(&scales)) {
                Some(frequencies) => frequencies,
                None => starts.to_vec(),
            },
            Nature::Order([least, most]) => (least..=most).map(f64::from).collect(),
            Nature::TurnOrder(low) => turn_orders(low, fitter.machine.actuator.pole_pairs()),
            Nature::Width(_) => vec![(high - low) / 16.0],
            Nature::Place(_) => (0..PLACES)
                .map(|k| low + (high - low) * (k as f64 + 0.5) / PLACES as f64)
                .collect(),
            Nature::Begin(_) => (0..SLOTS).map(|k| slot * k as f64).collect(),
        };
        let with = |values: &Vec<f64>| -> Vec<Vec<f64>> {
            let one = |&begin: &f64| {
                let mut values = values.clone();
                values[i] = begin;
                values
            };
            begins.iter().map(one).collect()
        };
        all = all.iter().flat_map(with).collect();
    }
    let ends = effect.place_of(|n| matches!(n, Nature::End(_)));
    let begins = effect.place_of(|n| matches!(n, Nature::Begin(_)));
    if let (Some(begin), Some(end)) = (begins, ends) {
        for values in &mut all {
            values[end] = values[begin] + slot;
        }
    }
    all
}

/// Natural frequencies beside each other, Hz, from where the longest log shows some periods to
/// the highest that balanced samples show; `None` of logs that are replayed, where each would
/// take a simulation of the loop.
fn side_by_side(set: &LogSet, [least, most]: [f64; 2]) -> Option<Vec<f64>> {
    if !set.is_balanced() {
        return None;
    }
    let longest = set.logs.iter().map(|l| l.log.len() as f64 * l.period);
    let low = (RESONANCE_PERIODS / longest.fold(0.0, f64::max)).max(least);
    let highest = set.logs.iter().map(|l| 0.5 / l.period);
    let high = highest.fold(0.0, f64::max).min(most);
    let all = std::iter::successors(Some(low), |f| Some(f * RESONANCES_APART));
    Some(all.take_while(|f| *f <= high).collect())
}

/// Whether an effect is a force in time, of which begin and end are sought together.
pub fn is_force_in_time(effect: &Effect) -> bool {
    (effect.place_of(|n| matches!(n, Nature::Begin(_)))).is_some()
}

/// Places along the stroke at which a search starts.
const PLACES: usize = 8;

/// From one natural frequency that is tried to the next. Of starts with 3 % of damping within 10 % of a
/// body of 1 %, only those off by −1, 1 and 2 % led to it.
const RESONANCES_APART: f64 = 1.02;

/// Periods that a log must show of a resonance for it to be told from a mass.
pub(crate) const RESONANCE_PERIODS: f64 = 10.0;

/// Parts of a motion's time in which a force may begin and end.
const SLOTS: usize = 24;

/// Effects of the library that an axis can have.
pub fn applicable(machine: &Axis) -> impl Iterator<Item = &'static Effect> {
    let all = EFFECTS.iter().copied();
    all.filter(move |e| e.applies_to(machine).is_ok())
}

/// Candidates of the library that are `wanted`, at the state of `fit`.
fn candidates(fitter: &Fitter<'_>, fit: &Fit, wanted: impl Fn(&Effect) -> bool) -> Vec<Candidate> {
    let wanted: Vec<(&'static Effect, Vec<f64>)> = applicable(fitter.machine)
        .filter(|e| wanted(e))
        .flat_map(|e| shapes(fitter, e).into_iter().map(move |values| (e, values)))
        .collect();
    wanted
        .into_par_iter()
        .map(|(effect, values)| Candidate {
            columns: responses(fitter, fit, effect, &values),
            effect,
            values,
            scales: Scales::of(fitter.machine),
        })
        .collect()
}

/// Secants at half of the typical size: derivatives would say nothing of
/// gaps and dry friction.
pub fn responses(
    fitter: &Fitter<'_>,
    fit: &Fit,
    effect: &'static Effect,
    values: &[f64],
) -> Columns {
    const SHARE: f64 = 0.5;
    let scales = Scales::of(fitter.machine);
    let phase = phase_of(effect);
    let sizes = effect.parameters.iter().enumerate();
    let sizes = sizes.filter(|(_, p)| p.is_size());
    let with = |size: usize, angle: Option<f64>| {
        let mut tried = values.to_vec();
        for (value, p) in tried.iter_mut().zip(effect.parameters) {
            if p.is_size() {
                *value = 0.0;
            }
        }
        tried[size] = SHARE * effect.parameters[size].typical(&scales);
        if let (Some(at), Some(angle)) = (phase, angle) {
            tried[at] = angle;
        }
        let mut state = fit.state.clone();
        state.effects.push(ActiveEffect {
            effect,
            values: tried,
        });
        fitter.column(fit, &state, SHARE)
    };
    match phase {
        Some(_) => sizes
            .flat_map(|(i, _)| [0.0, std::f64::consts::FRAC_PI_2].map(|angle| with(i, Some(angle))))
            .collect(),
        None => sizes.map(|(i, _)| with(i, None)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::turn_orders;

    #[test]
    fn orders_of_magnets_stand_above_those_that_are_all_tried() {
        assert_eq!(turn_orders([1, 3], None), [1.0, 2.0, 3.0]);
        let found = turn_orders([1, 24], Some(4.0));
        assert_eq!(found.len(), 24 + 9);
        // 36 slots and 8 poles.
        assert!(found.contains(&72.0) && !found.contains(&36.0));
        // 12 slots and 10 poles.
        assert!(turn_orders([1, 24], Some(5.0)).contains(&60.0));
    }
}
