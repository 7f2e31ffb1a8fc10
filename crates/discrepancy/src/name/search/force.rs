//! Where a force in time begins and ends.
//!
//! D has lesser minima in both times beside that at the truth, which is narrow:
//! what goes downhill ends in them. But what a force does over neighbouring slots
//! of time is nearly the sum of what it does in each: the fall of D of the sum was
//! within a fifth of the simulated one. So all stretches between slots are compared
//! without simulating any, and the slots at the edges of the best are cut finer
//! and finer.

use std::ops::Range;

use axis_sim::effects::{ActiveEffect, Scales};
use nalgebra::DVector;
use rayon::prelude::*;

use super::lines::duration;
use super::promise::PROMISING;
use super::state::Search;
use crate::estimate::columns::Columns;
use crate::estimate::fit::Fit;
use crate::estimate::linear::{Problem, Products};
use crate::name::library::{Candidate, is_force_in_time, responses};
use crate::name::screen::mostly_same;
use crate::spectrum::Amplitudes;

/// Stretches of which the edges are sought.
const STRETCHES: usize = 2;

/// Way from where a log begins, as a share of the longest, after which its axis moves.
const BEGINS: f64 = 1e-3;

/// Share of a force's time in which an axis must move.
const MOVING: f64 = 0.5;

/// Length of the slots at the edges at which Gauss and Newton take over, s.
const FINEST: f64 = 0.01;

/// A slot of time, and what a force of typical size does in it.
#[derive(Clone)]
struct Slot {
    times: [f64; 2],
    column: Amplitudes,
}

/// Begin and end of neighbouring slots.
fn times_of(slots: &[Slot], stretch: &Range<usize>) -> [f64; 2] {
    [
        slots[stretch.start].times[0],
        slots[stretch.end - 1].times[1],
    ]
}

/// A force over neighbouring slots.
struct Stretch {
    slots: Range<usize>,
    /// D of the linearised model.
    deviance: f64,
    /// Of the fit's own columns, and its size as a multiple of the typical.
    x: DVector<f64>,
}

impl Stretch {
    fn size(&self) -> f64 {
        self.x[self.x.len() - 1]
    }
}

/// When logs count and an axis moves, s.
pub(super) struct InMotion {
    counts_from: f64,
    moves_from: f64,
}

impl InMotion {
    /// Whether a force between these times acts while the logs count, and not mostly before an axis moves. Such a
    /// one only changes the state that they begin in, which is not known: noise shakes dry friction loose at
    /// the first standstill, and a friction in another form than the model's holds an axis in another way.
    pub(super) fn has(&self, [begin, end]: [f64; 2]) -> bool {
        let moving = end - begin.max(self.moves_from);
        end > self.counts_from && moving > MOVING * (end - begin)
    }
}

impl Search<'_> {
    /// The best force in time beside the fit; `None` where the linearised model
    /// promises less than is worth a simulation, or than the `least`, of all. `own`
    /// are the derivatives of the fit's own parameters.
    pub(super) fn force_in_time(&self, own: &Columns, least: f64) -> Option<Fit> {
        let all = self.library.candidates.iter();
        let slots: Vec<Slot> = all
            .filter(|c| is_force_in_time(c.effect))
            .map(|c| Slot {
                times: [c.values[1], c.values[2]],
                column: c.columns[0].clone(),
            })
            .collect();
        // A force over the whole motion is a constant load.
        let n = slots.len();
        let all = (0..n).flat_map(|i| (i + 1..=n).map(move |j| i..j));
        let in_motion = self.in_motion();
        let all = all.filter(|s| s.len() < n && in_motion.has(times_of(&slots, s)));
        let all = all.collect();
        let start = DVector::zeros(own.len() + 1);
        let mut chosen: Vec<Stretch> = Vec::new();
        for stretch in self.compared(own, &slots, all, &start) {
            let new = chosen
                .iter()
                .all(|c| !mostly_same(&c.slots, &stretch.slots));
            if chosen.len() < STRETCHES && new {
                chosen.push(stretch);
            }
        }
        let least = least.max(PROMISING * self.needed(3, 1));
        chosen.retain(|s| self.fit.deviance - s.deviance >= least);
        let simulated = |stretch: Stretch| {
            let (slots, stretch) = self.cut_finer(own, &slots, stretch);
            self.simulated(&slots, &stretch)
        };
        let fits = chosen.into_par_iter().filter_map(simulated);
        let fits: Vec<Fit> = fits.collect();
        fits.into_iter().reduce(Fit::better)
    }

    /// When a force in time says anything of the machine.
    pub(super) fn in_motion(&self) -> InMotion {
        InMotion {
            counts_from: self.fit_logs.layout.full_weight_from(),
            moves_from: self.moves_from(),
        }
    }

    /// When the first of the fitted logs' motions begins, s.
    fn moves_from(&self) -> f64 {
        let logs = self.fit.traces.iter().zip(&self.fit_logs.logs);
        let begins = logs.filter_map(|(trace, log)| {
            let positions = trace.position();
            let first = *positions.first()?;
            let ways = positions.iter().map(|x| (x - first).abs());
            let farthest = ways.clone().fold(0.0, f64::max);
            let begins = ways.into_iter().position(|way| way > BEGINS * farthest)?;
            Some(log.period * begins as f64)
        });
        begins.reduce(f64::min).unwrap_or(0.0)
    }

    /// Whether a force between these times acts all along the logs: a standing load, whose beginning may
    /// look like its own where what was stored at a log's start is known badly.
    pub(super) fn acts_throughout(&self, [begin, end]: [f64; 2]) -> bool {
        let longest = self.fit_logs.logs.iter().map(duration).fold(0.0, f64::max);
        begin < self.fit_logs.layout.full_weight_from() && end > longest - FINEST
    }

    /// Cuts the slots on either side of both edges into three, as often as it takes.
    fn cut_finer(&self, own: &Columns, slots: &[Slot], first: Stretch) -> (Vec<Slot>, Stretch) {
        let (mut slots, mut best) = (slots.to_vec(), first);
        let in_motion = self.in_motion();
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
            let n = finer.len();
            let holds = |s: &Range<usize>| {
                inside.is_none_or(|i| s.contains(&i)) && in_motion.has(times_of(&finer, s))
            };
            let all = (0..n).flat_map(|i| (i + 1..=n).map(move |j| i..j));
            let all = all.filter(holds);
            let compared = self.compared(own, &finer, all.collect(), &best.x);
            let Some(next) = compared.into_iter().next() else {
                return (slots, best);
            };
            (slots, best) = (finer, next);
        }
    }

    /// A slot in three parts, of which two are simulated.
    fn thirds(&self, slot: &Slot) -> Vec<Slot> {
        let [from, to] = slot.times;
        let Some(force) = self.force() else {
            return vec![slot.clone()];
        };
        let third = (to - from) / 3.0;
        let edges = [from, from + third, to - third, to];
        let simulated = |i: usize| {
            let times = [edges[i], edges[i + 1]];
            let values = [force.values[0], times[0], times[1]];
            let mut columns = responses(&self.fitter(), &self.fit, force.effect, &values);
            Slot {
                times,
                column: columns.swap_remove(0),
            }
        };
        let two: Vec<Slot> = [0, 1].into_par_iter().map(simulated).collect();
        let last = less(&slot.column, &two[0].column);
        let last = Slot {
            times: [edges[2], edges[3]],
            column: less(&last, &two[1].column),
        };
        two.into_iter().chain([last]).collect()
    }

    /// Stretches of slots, that with the lowest D first.
    fn compared(
        &self,
        own: &Columns,
        slots: &[Slot],
        stretches: Vec<Range<usize>>,
        start: &DVector<f64>,
    ) -> Vec<Stretch> {
        let rest = [&self.fit.rest].into_iter();
        let columns = slots.iter().map(|s| &s.column);
        let all: Vec<&Amplitudes> = rest.chain(own).chain(columns).collect();
        let products = Products::new(&self.fit_logs.layout, &all);
        let first = 1 + own.len();
        let fitted = |slots: Range<usize>| {
            let summed = first + slots.start..first + slots.end;
            let shares = &self.fit.state.shares;
            let kept = (0..first).collect();
            let problem = Problem::new(self.machine, &products, kept, Vec::new(), shares);
            let least = problem.with_sum(summed).minimum(start);
            Stretch {
                slots,
                deviance: least.deviance,
                x: least.x,
            }
        };
        let mut fitted: Vec<Stretch> = stretches.into_par_iter().map(fitted).collect();
        fitted.sort_by(|a, b| a.deviance.total_cmp(&b.deviance));
        fitted
    }

    fn force(&self) -> Option<&Candidate> {
        let mut all = self.library.candidates.iter();
        all.find(|c| is_force_in_time(c.effect))
    }

    fn simulated(&self, slots: &[Slot], stretch: &Stretch) -> Option<Fit> {
        let effect = self.force()?.effect;
        let force = effect.parameters[0];
        let scales = Scales::of(self.machine);
        let [low, high] = force.bounds(&scales);
        let size = (stretch.size() * force.typical(&scales)).clamp(low, high);
        let from = slots[stretch.slots.start].times[0];
        let to = slots[stretch.slots.end - 1].times[1];
        let values = vec![size, from, to];
        let mut state = self.fit.state.clone();
        state.effects.push(ActiveEffect { effect, values });
        let fit = self.fitter().at(state).ok()?;
        let [predicted, gain] = [stretch.deviance, fit.deviance].map(|d| self.fit.deviance - d);
        tracing::debug!(size, from, to, predicted, gain, "force in time");
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

#[cfg(test)]
mod tests {
    use super::InMotion;

    #[test]
    fn a_force_before_an_axis_moves_says_how_a_log_begins() {
        let logs = InMotion {
            counts_from: 0.12,
            moves_from: 0.2,
        };
        assert!(!logs.has([0.0, 0.11]) && !logs.has([0.02, 0.2]) && !logs.has([0.04, 0.28]));
        assert!(logs.has([0.04, 0.5]) && logs.has([0.3, 0.31]));
        // Where logs begin in motion, all that acts while they count.
        let moving = InMotion {
            moves_from: 0.0,
            ..logs
        };
        assert!(moving.has([0.0, 0.13]) && !moving.has([0.0, 0.11]));
    }
}
