//! What is worth a simulation: what the linearised model promises.

use nalgebra::DVector;
use rayon::prelude::*;

use super::rounds::Search;
use crate::fit::Columns;
use crate::linear::{Problem, Products};
use crate::screen::{Screened, Screening};
use crate::spectrum::Amplitudes;

/// Share of the needed fall of D that an effect must promise, or a pair beyond
/// twice what the best effect does alone, before it is simulated.
pub(super) const PROMISING: f64 = 0.3;

/// Most pairs that are simulated.
const PAIRS: usize = 3;

impl Search<'_> {
    /// The first few, but none that the screening puts a tenth below the best, or
    /// of which the linearised model promises too little; with what it promises.
    pub(super) fn worth_refining(
        &self,
        screened: &[Screened],
        own: &Columns,
    ) -> Vec<(Vec<Screened>, f64)> {
        let best = screened.first().map_or(0.0, |s| s.gain);
        let few = screened.iter().take(self.settings.refined);
        let few: Vec<&Screened> = few.filter(|s| s.gain >= 0.1 * best).collect();
        let least = PROMISING * self.needed(1, 1);
        let worth = |s: &Screened| {
            // Of a force in time, the times are to be found first.
            let promised = match s.candidate {
                None => 0.0,
                Some(_) => Some(self.promised(&[s], own)).filter(|p| *p >= least)?,
            };
            Some((vec![s.clone()], promised))
        };
        few.into_par_iter().filter_map(worth).collect()
    }

    /// Pairs of which the linearised model promises more than twice as much as the
    /// `most` of single effects: what two do may nearly cancel, and neither is
    /// worth anything alone then.
    pub(super) fn pairs(
        &self,
        screening: &Screening,
        own: &Columns,
        most: f64,
    ) -> Vec<(Vec<Screened>, f64)> {
        let least = 2.0 * most + PROMISING * self.needed(2, 2);
        let promised = |pair: [Screened; 2]| {
            let promised = self.promised(&[&pair[0], &pair[1]], own);
            (promised >= least).then(|| (Vec::from(pair), promised))
        };
        let all = screening.two_by_two().into_par_iter();
        let mut all: Vec<_> = all.filter_map(promised).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        all.truncate(PAIRS);
        all
    }

    /// Fall of D with these effects as the linearised model has it: with the rest
    /// as it is in the weights, as the screening has it, gains are too small, of
    /// a force in time by up to forty times.
    fn promised(&self, effects: &[&Screened], own: &Columns) -> f64 {
        let rest = [&self.fit.rest].into_iter();
        let places = effects.iter().filter_map(|s| s.candidate);
        let columns = places.flat_map(|place| &self.library.candidates[place].columns);
        let all: Vec<&Amplitudes> = rest.chain(own).chain(columns).collect();
        let products = Products::new(&self.fit_logs.layout, &all);
        let shares = &self.fit.state.shares;
        let problem = Problem::new(self.machine, &products, all.len(), 0..0, shares);
        let least = problem.minimum(&DVector::zeros(all.len() - 1));
        self.fit.deviance - least.deviance
    }
}
