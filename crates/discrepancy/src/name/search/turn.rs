//! At what order a torque that repeats with each turn is sought.
//!
//! The library begins at low orders and, if the number of poles is known, at those of the magnets.
//! Slots and magnets that are not known make others, each of which leaves a line in the residual
//! over the motor's angle.

use std::f64::consts::TAU;

use axis_sim::effects::Nature;
use axis_sim::position_shown;
use rayon::prelude::*;

use super::lines::{Line, add, strongest};
use super::state::Search;
use crate::estimate::columns::Columns;
use crate::name::library::Candidate;
use crate::name::screen::Screened;
use crate::spectrum::waves;

/// Turns that a log must show for their orders to be told apart.
const LEAST_TURNS: f64 = 2.0;

/// Samples that a wave must have.
const SAMPLES: f64 = 2.5;

/// Orders that are looked at, per resolved step.
const FINER: f64 = 2.0;

impl Search<'_> {
    /// Torques of the orders at which the residual over the motor's angle stands out most, of those
    /// that the library lacks, beside the derivatives of the fit's own parameters.
    pub(super) fn turns(&self, own: &Columns) -> Vec<Screened> {
        let library = || self.library.candidates.iter();
        let of_turns = library().find_map(|c| Some((c, c.effect.place_of(is_turn_order)?)));
        let awaited = self.awaited();
        let of_turns = of_turns.filter(|(known, _)| self.wanted(known.effect, &awaited));
        let Some((known, at)) = of_turns else {
            return Vec::new();
        };
        let has = |order: f64| {
            let mut same = library().filter(|c| c.effect.name == known.effect.name);
            same.any(|c| c.values[at] == order)
        };
        let [least, most] = known.effect.parameters[at].bounds(&known.scales);
        let mut lines = self.lines_over_turns();
        lines
            .iter_mut()
            .for_each(|(order, _)| *order = order.round());
        lines.retain(|(order, _)| (least..=most).contains(order) && !has(*order));
        let lines = strongest(lines, least, |_| 0.5);
        tracing::debug!(?lines, "orders of a turn");
        let candidate = |(order, _): Line| self.begun_at(known, at, order);
        let torques: Vec<Candidate> = lines.into_par_iter().map(candidate).collect();
        self.screened_beside(own, &torques, known.effect.parameters.len())
    }

    /// What a wave over the motor's angle takes of the residual by least squares, in waves a turn,
    /// logs and channels added up, up to the order that the samples show at the median speed: with
    /// 2.5 samples a wave, as balances have of their low-pass.
    fn lines_over_turns(&self) -> Vec<Line> {
        let set = &self.fit_logs;
        let per_turn = TAU * self.machine.travel_per_radian();
        let rest = set.rest(&self.fit.traces);
        let turns = |log| -> Vec<f64> {
            let positions = position_shown(log, self.machine).unwrap_or_default();
            positions.iter().map(|x| x / per_turn).collect()
        };
        let logs: Vec<Vec<f64>> = set.logs.iter().map(|log| turns(&log.log)).collect();
        let range = |turns: &Vec<f64>| {
            let ends = turns.iter().fold((f64::MAX, f64::MIN), |(low, high), &x| {
                (low.min(x), high.max(x))
            });
            ends.1 - ends.0
        };
        let longest = logs.iter().map(range).fold(0.0, f64::max);
        let steps = logs.iter().map(|turns| median_step(turns));
        let step = 0.25 * SAMPLES * steps.fold(f64::INFINITY, f64::min);
        if !(longest >= LEAST_TURNS && step > 0.0 && step.is_finite()) {
            return Vec::new();
        }
        let length = (FINER * longest / step).ceil() as usize;
        let mut lines: Vec<Line> = Vec::new();
        for (turns, rest) in logs.iter().zip(&rest) {
            let mut order: Vec<usize> = (0..turns.len()).collect();
            order.sort_by(|&a, &b| turns[a].total_cmp(&turns[b]));
            let sorted =
                |series: &[f64]| -> Vec<f64> { order.iter().map(|&k| series[k]).collect() };
            let places = sorted(turns);
            for channel in rest {
                add(&mut lines, waves(&places, &sorted(channel), step, length));
            }
        }
        lines
    }
}

/// Median of what a series moves from one sample to the next, of those by which it moves.
fn median_step(series: &[f64]) -> f64 {
    let steps = series.windows(2).map(|w| (w[1] - w[0]).abs());
    let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// Whether a number is the order of what repeats with each turn of the motor.
fn is_turn_order(nature: &Nature) -> bool {
    matches!(nature, Nature::TurnOrder(_))
}
