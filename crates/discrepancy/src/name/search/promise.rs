//! What is worth a simulation: what the linearised model promises.

use axis_sim::effects::{ActiveEffect, Effect, Scales};
use rayon::prelude::*;

use super::evidence::enough;
use super::lines::Spectral;
use super::state::Search;
use crate::estimate::columns::Columns;
use crate::estimate::linear::{Problem, Products, Room};
use crate::name::library::{Candidate, is_force_in_time, responses, rooms, values_at};
use crate::name::screen::{Screened, Screening};
use crate::spectrum::Amplitudes;

/// Share of the needed fall of D that an effect must promise, or a pair beyond
/// twice what the best effect does alone, before it is simulated.
pub(super) const PROMISING: f64 = 0.3;

/// Share of what the best effect promises that another must promise.
pub(super) const WORTH: f64 = 0.1;

/// Most pairs that are simulated.
const PAIRS: usize = 3;

/// Share of a residual far above noise that an effect explains to be simulated whatever it promises of D,
/// and the most of these.
const MOST: f64 = 0.5;
const FEW: usize = 4;

/// The linearised model of a fit and all candidates.
pub(super) struct Promises<'a> {
    search: &'a Search<'a>,
    products: Products,
    /// Columns of the rest and the fit's own parameters.
    own: usize,
    /// First column of each candidate.
    firsts: Vec<usize>,
    /// Spectral matrices of the rest, and of noise alone where that is known.
    weights: Vec<Vec<Spectral>>,
}

impl<'a> Promises<'a> {
    /// Beside these derivatives of the fit's own parameters.
    pub(super) fn new(search: &'a Search<'a>, own: &Columns) -> Self {
        let candidates = &search.library.candidates;
        let layout = &search.fit_logs.layout;
        let rest = [&search.fit.rest].into_iter();
        // Times of a force are sought by themselves.
        let columns = |c: &'a Candidate| match is_force_in_time(c.effect) {
            true => &[],
            false => c.columns.as_slice(),
        };
        let of_all = candidates.iter().flat_map(columns);
        let all: Vec<&Amplitudes> = rest.chain(own).chain(of_all).collect();
        let mut next = 1 + own.len();
        let first = |c: &'a Candidate| {
            let first = next;
            next += columns(c).len();
            first
        };
        let mut weights = vec![layout.spectral_matrices(&search.fit.rest)];
        weights.extend(search.noise().map(|n| layout.spectral_matrices(&n)));
        Self {
            firsts: candidates.iter().map(first).collect(),
            products: Products::new(layout, &all),
            own: 1 + own.len(),
            weights,
            search,
        }
    }

    /// Screenings with these candidates: weighed by the rest, and by noise alone
    /// where that is known.
    pub(super) fn screenings(
        &self,
        own: &Columns,
        wanted: impl Fn(&Effect) -> bool + Sync,
    ) -> Vec<Screening> {
        let search = self.search;
        let library = &search.library.candidates;
        let weighed = |matrices: &Vec<_>| {
            Screening::new(
                &search.fitter(),
                &search.fit,
                own,
                library,
                matrices,
                &wanted,
            )
        };
        self.weights.par_iter().map(weighed).collect()
    }

    /// Spectral matrices of noise alone; of the rest, where that is not known.
    pub(super) fn of_noise(&self) -> &[Spectral] {
        self.weights.last().map_or(&[], Vec::as_slice)
    }

    /// What each effect explains alone, best first, one entry an effect.
    pub(super) fn one_by_one(&self, screening: &Screening) -> Vec<Screened> {
        let promised = |s: Screened| self.promised(&[&s]).map_or(vec![s], |p| p.parts).remove(0);
        let all = screening.one_by_one().into_par_iter().map(promised);
        one_each(all.collect())
    }

    /// Of these effects, the first few, but none that promises less than a
    /// tenth of the best or too little. The times of a force in time are to be found first.
    pub(super) fn worth_refining(&self, effects: &[Screened]) -> Vec<Vec<Screened>> {
        let (force, others): (Vec<_>, Vec<_>) =
            effects.iter().partition(|s| is_force_in_time(s.effect));
        let settings = self.search.settings;
        let best = others.first().map_or(0.0, |s| s.gain);
        let enough = self.search.needed(1, 1).max(self.search.material());
        let least = (PROMISING * enough).max(WORTH * best);
        let few = others.into_iter().take(settings.refined);
        let few = few.filter(|s| s.gain >= least).chain(force);
        few.map(|s| vec![s.clone()]).collect()
    }

    /// Effects that explain most of a residual far above noise, weighed by noise alone, which does not
    /// change with the residual. D of the linearised model does not show them: what is not linear of a large
    /// effect is above noise too.
    pub(super) fn of_most(&self, screenings: &[Screening]) -> Vec<Vec<Screened>> {
        let Some(by_noise) = screenings.get(1).filter(|_| self.search.steady.is_some()) else {
            return Vec::new();
        };
        let mut all = best_first(by_noise);
        all.retain(|s| !is_force_in_time(s.effect) && by_noise.share(s) >= MOST);
        all.truncate(FEW);
        tracing::debug!(effects = ?all.iter().map(|s| (s.effect.name, &s.values, by_noise.share(s))).collect::<Vec<_>>(), "explain most, by noise");
        all.into_iter().map(|s| vec![s]).collect()
    }

    /// Pairs of which the linearised model promises more than twice as much as the
    /// `most` of single effects: what two do may nearly cancel, and neither is
    /// worth anything alone then.
    pub(super) fn pairs(&self, screenings: &[Screening], most: f64) -> Vec<Vec<Screened>> {
        let least = 2.0 * most + PROMISING * self.search.needed(2, 2);
        let pairs: Vec<_> = screenings.par_iter().map(Screening::two_by_two).collect();
        let mut all: Vec<[Screened; 2]> = Vec::new();
        for pair in pairs.into_iter().flatten() {
            let candidates = |p: &[Screened; 2]| [p[0].candidate, p[1].candidate];
            if all.iter().all(|p| candidates(p) != candidates(&pair)) {
                all.push(pair);
            }
        }
        let promised = |[a, b]: [Screened; 2]| self.promised(&[&a, &b]);
        let mut all: Vec<Promise> = all.into_par_iter().filter_map(promised).collect();
        all.retain(|p| p.fall >= least);
        all.sort_by(|a, b| b.fall.total_cmp(&a.fall));
        // The simplest of those that promise about as much come first.
        let about = enough(all.first().map_or(0.0, |p| p.fall));
        let near = all.iter().take_while(|p| p.fall >= about).count();
        let parameters =
            |p: &Promise| -> usize { p.parts.iter().map(|s| s.effect.parameters.len()).sum() };
        all[..near].sort_by_key(parameters);
        all.into_iter().take(PAIRS).map(|p| p.parts).collect()
    }

    /// Whether the linearised model promises of these two effects together what it asks of one
    /// beside the `most` that one does alone.
    pub(super) fn are_worth_it(&self, pair: &[Screened], most: f64) -> bool {
        let least = (PROMISING * self.search.needed(2, 2)).max(WORTH * most);
        let effects: Vec<&Screened> = pair.iter().collect();
        self.promised(&effects).is_some_and(|p| p.fall >= least)
    }

    /// What the linearised model makes of these effects together; `None` where one
    /// is a force in time. With the rest as it is in the weights, as the screening
    /// has it, gains are too small, and a gap promises nothing.
    fn promised(&self, effects: &[&Screened]) -> Option<Promise> {
        let search = self.search;
        let places: Option<Vec<usize>> = effects.iter().map(|s| s.candidate).collect();
        let rooms: Vec<Vec<Room>> = effects.iter().map(|s| rooms(s.effect, &s.scales)).collect();
        let columns = places?.into_iter().zip(&rooms);
        let columns = columns.flat_map(|(c, rooms)| (0..rooms.len()).map(move |i| (c, i)));
        let columns = columns.map(|(c, i)| self.firsts[c] + i);
        let problem = Problem::new(
            search.machine,
            &self.products,
            (0..self.own).chain(columns).collect(),
            rooms.concat(),
            &search.fit.state.shares,
        );
        let least = self.weights.iter().map(|w| problem.minimum_weighed(w));
        let least = least.min_by(|a, b| a.deviance.total_cmp(&b.deviance))?;
        let fall = search.fit.deviance - least.deviance;
        let mut first = self.own - 1;
        let parts = effects.iter().zip(&rooms).map(|(&s, rooms)| {
            let own = &least.x.as_slice()[first..first + rooms.len()];
            first += rooms.len();
            Screened {
                gain: fall,
                values: values_at(s.effect, &s.values, own, &s.scales),
                ..s.clone()
            }
        });
        Some(Promise {
            parts: parts.collect(),
            fall,
        })
    }
}

impl Search<'_> {
    /// A candidate of the library with another value of a shape, simulated at the fit.
    pub(super) fn begun_at(&self, known: &Candidate, shape: usize, value: f64) -> Candidate {
        let mut values = known.values.clone();
        values[shape] = value;
        self.candidate(known.effect, values)
    }

    /// An effect with these shapes as a candidate, simulated at the fit.
    pub(super) fn candidate(&self, effect: &'static Effect, values: Vec<f64>) -> Candidate {
        Candidate {
            columns: responses(&self.fitter(), &self.fit, effect, &values),
            effect,
            values,
            scales: Scales::of(self.machine),
        }
    }

    /// An effect that was taken out, screened with its own shapes, which as the order of a torque may not be the library's; weighed
    /// by these spectral matrices.
    pub(super) fn screened_as(
        &self,
        active: ActiveEffect,
        own: &Columns,
        matrices: &[Spectral],
    ) -> Option<Screened> {
        let itself = [self.candidate(active.effect, active.values)];
        let fitter = self.fitter();
        let screening = Screening::new(&fitter, &self.fit, own, &itself, matrices, |_| true);
        screening.one_by_one().pop()
    }

    /// Candidates that have no place in the library, with so many `parameters` each, as far as
    /// they promise enough to be simulated; `own` are the derivatives of the fit's own parameters.
    pub(super) fn screened_beside(
        &self,
        own: &Columns,
        candidates: &[Candidate],
        parameters: usize,
    ) -> Vec<Screened> {
        let matrices = self.fit_logs.layout.spectral_matrices(&self.fit.rest);
        let fitter = self.fitter();
        let screening = Screening::new(&fitter, &self.fit, own, candidates, &matrices, |_| true);
        let mut screened = screening.one_by_one();
        screened.iter_mut().for_each(|s| s.candidate = None);
        let least = PROMISING * self.needed(parameters, 1);
        screened.retain(|s| s.gain >= least);
        screened
    }
}

/// What each effect explains alone by a screening, best first, one entry an effect.
pub(super) fn best_first(screening: &Screening) -> Vec<Screened> {
    one_each(screening.one_by_one())
}

/// The best of each effect, best first.
pub(super) fn one_each(mut all: Vec<Screened>) -> Vec<Screened> {
    all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let mut seen: Vec<&str> = Vec::new();
    all.retain(|s| {
        let new = !seen.contains(&s.effect.name);
        seen.push(s.effect.name);
        new
    });
    all
}

/// What some effects together promise.
struct Promise {
    /// With the sizes at which they do.
    parts: Vec<Screened>,
    fall: f64,
}
