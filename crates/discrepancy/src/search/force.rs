//! Where a force in time begins and ends.
//!
//! D is flat in both times but for a narrow well at the truth, as wide as the
//! loop's answer to a blow is long: nothing that goes downhill gets there. But
//! what a force does over neighbouring slots of time is the sum of what it does
//! in each, to a hundredth of D. So all stretches between slots are compared
//! without simulating any, and the slots at the edges of the best are cut finer
//! and finer.

use std::ops::Range;

use axis_sim::effects::ActiveEffect;
use nalgebra::DVector;
use rayon::prelude::*;

use super::rounds::{PROMISING, Search};
use crate::bounded::bounded;
use crate::fit::{Columns, Fit, known_deviation};
use crate::known::tolerance;
use crate::screen::{FORCE, mostly_same, responses};
use crate::spectrum::{Amplitudes, Products};

/// Stretches of which the edges are sought.
const STRETCHES: usize = 2;

/// Length of the slots at the edges at which Gauss and Newton take over, s.
const FINEST: f64 = 0.01;

/// Rounds in which the spectrum of a linearised rest is estimated anew.
const REWEIGHED: usize = 6;

/// A slot of time, and what a force of typical size does in it.
#[derive(Clone)]
struct Slot {
    times: [f64; 2],
    column: Amplitudes,
}

/// A force over neighbouring slots.
struct Stretch {
    slots: Range<usize>,
    /// D of the linearised model.
    deviance: f64,
    /// As a multiple of the typical.
    size: f64,
}

impl Search<'_> {
    /// The best force in time beside the fit. `own` are the derivatives of the
    /// fit's own parameters.
    pub(super) fn force_in_time(&self, own: &Columns) -> Option<Fit> {
        let all = self.library.candidates.iter();
        let slots: Vec<Slot> = all
            .filter(|c| c.effect.name == FORCE)
            .map(|c| Slot {
                times: [c.values[1], c.values[2]],
                column: c.columns[0].clone(),
            })
            .collect();
        // A force over the whole motion is a constant load.
        let mut stretches = self.compared(own, &slots, slots.len() - 1);
        let mut chosen: Vec<Stretch> = Vec::new();
        for stretch in stretches.drain(..) {
            let new = chosen
                .iter()
                .all(|c| !mostly_same(&c.slots, &stretch.slots));
            if chosen.len() < STRETCHES && new {
                chosen.push(stretch);
            }
        }
        let promising =
            |s: &Stretch| self.fit.deviance - s.deviance >= PROMISING * self.needed(3, 1);
        let refined = |(i, stretch): (usize, Stretch)| {
            let (slots, stretch) = if i == 0 || promising(&stretch) {
                self.cut_finer(own, &slots, stretch)
            } else {
                return None;
            };
            self.simulated(&slots, &stretch)
        };
        let fits = chosen.into_par_iter().enumerate().filter_map(refined);
        let fits: Vec<Fit> = fits.collect();
        fits.into_iter().reduce(Fit::better)
    }

    /// Cuts the slots on either side of both edges into three, as often as it takes.
    fn cut_finer(&self, own: &Columns, slots: &[Slot], first: Stretch) -> (Vec<Slot>, Stretch) {
        let (mut slots, mut best) = (slots.to_vec(), first);
        loop {
            let Range { start, end } = best.slots;
            let at_edges = [start.saturating_sub(1), start, end - 1, end];
            let at_edge = |i: usize| at_edges.contains(&i);
            let longest = (0..slots.len()).filter(|&i| at_edge(i));
            let longest = longest.map(|i| slots[i].times[1] - slots[i].times[0]);
            if longest.fold(0.0, f64::max) <= FINEST {
                return (slots, best);
            }
            let mut finer: Vec<Slot> = Vec::new();
            let mut inside: Option<usize> = None;
            for (i, slot) in slots.iter().enumerate() {
                if at_edge(i) {
                    finer.extend(self.thirds(slot));
                } else if (start..end).contains(&i) {
                    // What is inside in any case is one slot.
                    match inside {
                        Some(whole) => finer[whole] = joined(&finer[whole], slot),
                        None => {
                            inside = Some(finer.len());
                            finer.push(slot.clone());
                        }
                    }
                }
            }
            let most = finer.len();
            let Some(next) = self.compared(own, &finer, most).into_iter().next() else {
                return (slots, best);
            };
            (slots, best) = (finer, next);
        }
    }

    /// A slot in three parts, of which two are simulated.
    fn thirds(&self, slot: &Slot) -> Vec<Slot> {
        let [from, to] = slot.times;
        let Some(effect) = self
            .library
            .candidates
            .iter()
            .find(|c| c.effect.name == FORCE)
        else {
            return vec![slot.clone()];
        };
        let third = (to - from) / 3.0;
        let edges = [from, from + third, to - third, to];
        let simulated = |i: usize| {
            let times = [edges[i], edges[i + 1]];
            let values = [effect.values[0], times[0], times[1]];
            let column =
                responses(&self.fitter(), &self.fit, effect.effect, &values).swap_remove(0);
            Slot { times, column }
        };
        let two: Vec<Slot> = [0, 1].into_par_iter().map(simulated).collect();
        let last = less(&slot.column, &two[0].column);
        let last = Slot {
            times: [edges[2], edges[3]],
            column: less(&last, &two[1].column),
        };
        two.into_iter().chain([last]).collect()
    }

    /// All stretches of neighbouring slots, at most so many, that with the lowest D
    /// first.
    fn compared(&self, own: &Columns, slots: &[Slot], most: usize) -> Vec<Stretch> {
        let rest = [&self.fit.rest].into_iter();
        let columns = slots.iter().map(|s| &s.column);
        let all: Vec<&Amplitudes> = rest.chain(own).chain(columns).collect();
        let products = self.fit_logs.layout.products(&all);
        let profile = Profile {
            products: &products,
            first_slot: 1 + own.len(),
            shares: &self.fit.state.shares,
            tolerance: tolerance(self.machine),
            weight: known_deviation(self.machine).powi(-2),
        };
        let n = slots.len();
        let all = (0..n).flat_map(|i| (i + 1..=n).map(move |j| i..j));
        let all: Vec<Range<usize>> = all.filter(|s| s.len() <= most).collect();
        let mut fitted: Vec<Stretch> = all.into_par_iter().map(|s| profile.fit(s)).collect();
        fitted.sort_by(|a, b| a.deviance.total_cmp(&b.deviance));
        fitted
    }

    fn simulated(&self, slots: &[Slot], stretch: &Stretch) -> Option<Fit> {
        let effect = self
            .library
            .candidates
            .iter()
            .find(|c| c.effect.name == FORCE)?
            .effect;
        let force = effect.parameters[0];
        let size = (stretch.size * force.typical).clamp(force.bounds[0], force.bounds[1]);
        let from = slots[stretch.slots.start].times[0];
        let to = slots[stretch.slots.end - 1].times[1];
        let values = vec![size, from, to];
        let mut state = self.fit.state.clone();
        state.effects.push(ActiveEffect { effect, values });
        let fit = self.fitter().at(state).ok()?;
        let [foreseen, gain] = [stretch.deviance, fit.deviance].map(|d| self.fit.deviance - d);
        tracing::debug!(size, from, to, foreseen, gain, "force in time");
        Some(fit)
    }
}

fn joined(a: &Slot, b: &Slot) -> Slot {
    let add = |(a, b): (&Vec<_>, &Vec<_>)| a.iter().zip(b).map(|(a, b)| a + b).collect();
    Slot {
        times: [a.times[0], b.times[1]],
        column: a.column.iter().zip(&b.column).map(add).collect(),
    }
}

fn less(a: &Amplitudes, b: &Amplitudes) -> Amplitudes {
    let take = |(a, b): (&Vec<_>, &Vec<_>)| a.iter().zip(b).map(|(a, b)| a - b).collect();
    a.iter().zip(b).map(take).collect()
}

/// D of the linearised model, minimised over all but the stretch of a force.
struct Profile<'a> {
    /// Of the rest, the fit's own columns, and the slots'.
    products: &'a Products,
    first_slot: usize,
    /// Of the known parameters, whose columns are the first.
    shares: &'a [f64],
    tolerance: f64,
    /// Of their departure.
    weight: f64,
}

impl Profile<'_> {
    /// The rest's spectrum is estimated anew in every round: with the rest as it
    /// was without the force in the weights, where the force acts hardly counts.
    fn fit(&self, slots: Range<usize>) -> Stretch {
        let n = self.first_slot;
        let products = self.products.merged(n, n + slots.start..n + slots.end);
        let known = self.shares.len();
        let room = |i: usize| {
            (i < known).then(|| {
                let share = self.shares[i];
                [-self.tolerance - share, self.tolerance - share]
            })
        };
        let mut x = DVector::zeros(n);
        for _ in 0..REWEIGHED {
            let gram = products.weighed(&x);
            let mut normal = gram.view((1, 1), (n, n)).into_owned();
            let mut right = gram.view((1, 0), (n, 1)).column(0).into_owned();
            for i in 0..known {
                normal[(i, i)] += self.weight;
                right[i] -= self.weight * self.shares[i];
            }
            x = bounded(&normal, &right, room);
        }
        let departures = x.iter().zip(self.shares);
        let departure: f64 = departures.map(|(x, s)| (x + s).powi(2)).sum();
        Stretch {
            deviance: products.deviance(&x) + self.weight * departure,
            size: x[n - 1],
            slots,
        }
    }
}
