//! Rounds of screening, refining and adding.

use axis_sim::effects::Effect;
use rayon::prelude::*;

use super::evidence::{LEAST_EVIDENCE_SHARE, LEAST_HELD_OUT, WORSE, enough};
use super::form::own_before_directions;
use super::is_form::is_form;
use super::promise::{PROMISING, Promises, WORTH};
use super::refined::{
    NEAR, Refined, Refinement, best_of_each, inside_before_bound, single_before_pair,
};
use super::state::Search;
use super::types::{Named, RunnerUp};
use super::unseen::may_end_unseen;
use crate::answers::LogSet;
use crate::estimate::columns::{Columns, free_parameters};
use crate::estimate::fit::Fit;
use crate::name::gap::{differ_immaterially, is_material, sizes};
use crate::name::library::is_force_in_time;
use crate::name::screen::{Screened, Screening};

/// Share of the promised fall of D that a simulation must keep, or other sizes are
/// tried.
const KEPT: f64 = 0.8;

/// The force that acts all along.
const STANDING: &str = "constant-load";

/// Candidates of which it is tried whether least squares lead further: so many of least D, and as many of
/// the least sum of squares.
const LED_FURTHER: usize = 4;

impl Search<'_> {
    /// Whether more is left in some log than is immaterial, or a name is awaited.
    pub(super) fn is_worth_it(&self) -> bool {
        let sets = [(&self.fit_logs, &self.fit), (&self.check_logs, &self.check)];
        let is_small = |(set, fit): (&LogSet, &Fit)| {
            set.is_immaterial(self.machine, &sizes(set, &set.rest(&fit.traces)))
        };
        !(self.awaited().is_empty() && sets.into_iter().all(is_small))
    }

    /// Adds the effect that explains most of what is left, or two that explain
    /// together what none does alone; false where none proves itself.
    pub(super) fn add_next(&mut self) -> bool {
        let awaited = self.awaited();
        let own = self.own_columns();
        let promises = Promises::new(self, &own);
        let screenings = promises.screenings(&own, |effect| self.wanted(effect, &awaited));
        let screened = promises.one_by_one(&screenings[0]);
        let candidates = match awaited.is_empty() {
            true => self.worth_refining(&promises, &screenings, &screened, &own),
            false => self.awaited_candidates(&promises, &screenings, &screened, &own),
        };
        let mut of_all = self.refine(candidates, &own);
        if awaited.is_empty() {
            of_all.kept = self.with_those_beside_forms(of_all.kept);
        }
        let refined = &mut of_all.kept;
        self.effects_before_forms(refined);
        single_before_pair(refined);
        inside_before_bound(refined);
        own_before_directions(refined);
        let Some((place, check)) = self.first_proven(refined) else {
            let alone = refined
                .iter()
                .filter(|r| r.parts.len() == 1 && !r.is_form());
            self.leftover = alone.map(Refined::runner_up).collect();
            return false;
        };
        // All parameters move when an effect is added, and its own may end where it is another one.
        let added = of_all.kept[place].added();
        let may_end = awaited.is_empty() && added.iter().any(|a| may_end_unseen(a.effect));
        let (before, count) = (may_end.then(|| self.clone()), added.len());
        self.add(&of_all, place, check, &screened);
        if let Some(before) = before {
            let new = self.fit.state.effects.iter().rev().take(count);
            let unseen = new.filter(|active| self.is_unseen(active));
            let unseen: Vec<&'static str> = unseen.map(|active| active.effect.name).collect();
            if !unseen.is_empty() {
                tracing::debug!(?unseen, "ended as a simpler effect");
                *self = before;
                self.unseen.extend(unseen);
                return self.add_next();
            }
        }
        self.unseen.clear();
        true
    }

    /// Candidates for what is awaited, however little they promise: begun from every shape that a candidate
    /// which nobody asked for is begun from.
    fn awaited_candidates(
        &self,
        promises: &Promises<'_>,
        screenings: &[Screening],
        screened: &[Screened],
        own: &Columns,
    ) -> Vec<Vec<Screened>> {
        let each = screened.iter().map(|s| vec![s.clone()]);
        let of_most = promises.of_most(screenings);
        let beside = self.begun_elsewhere(promises, own);
        let beside = beside.into_iter().map(|one| vec![one]);
        each.chain(of_most).chain(beside).collect()
    }

    /// Candidates with shapes that the library does not have, but these logs ask for: loads that repeat, and
    /// bodies that swing.
    fn begun_elsewhere(&self, promises: &Promises<'_>, own: &Columns) -> Vec<Screened> {
        let all = [
            self.waves(own),
            self.turns(own),
            self.resonances(own, promises.of_noise()),
        ];
        all.into_iter().flatten().collect()
    }

    /// What is worth a simulation: single effects, pairs, forms of friction, loads that repeat and bodies that swing.
    fn worth_refining(
        &self,
        promises: &Promises<'_>,
        screenings: &[Screening],
        screened: &[Screened],
        own: &Columns,
    ) -> Vec<Vec<Screened>> {
        let mut worth = promises.worth_refining(screened);
        worth.extend(promises.of_most(screenings));
        let most = screened.first().map_or(0.0, |s| s.gain);
        if self.effects_named() + 2 <= self.settings.most_effects {
            worth.extend(promises.pairs(screenings, most));
            let with_memory = self.own_with_memory(screened).into_iter();
            worth.extend(with_memory.filter(|pair| promises.are_worth_it(pair, most)));
        }
        let is_worth_it = |s: &Screened| s.gain >= WORTH * most;
        let mut forms = self.forms(own);
        forms.retain(is_worth_it);
        let beside = self.begun_elsewhere(promises, own);
        let beside = beside.into_iter().filter(is_worth_it);
        worth.extend(forms.into_iter().chain(beside).map(|one| vec![one]));
        worth
    }

    /// The first candidate that proves itself, with its fit of the check logs: if the best does not hold on other motion, the
    /// next may.
    fn first_proven(&self, refined: &[Refined]) -> Option<(usize, Fit)> {
        let is_open = self.awaited().is_empty();
        // Of what is not material, by how much D falls on the fitted and on the check logs.
        let mut immaterial: Vec<[f64; 2]> = Vec::new();
        refined.iter().enumerate().find_map(|(place, candidate)| {
            let is_effect = is_open && !candidate.is_form();
            if is_effect && self.cannot_be(candidate) {
                return None;
            }
            let check = self.checker().at(candidate.fit.state.clone()).ok()?;
            let held_out = self.check.deviance - check.deviance;
            if is_effect && self.is_out_of_phase(candidate, &check, held_out) {
                return None;
            }
            if is_open {
                if !self.holds(candidate, &check) {
                    return None;
                }
                let falls = [candidate.gain, held_out];
                if immaterial.iter().any(|little| is_no_more(falls, *little)) {
                    return None;
                }
                if !self.is_material(candidate, &check) {
                    // An effect beside a form is small, which says nothing of the form alone.
                    if !candidate.has_form() || candidate.is_form() {
                        immaterial.push(falls);
                    }
                    return None;
                }
            }
            Some((place, check))
        })
    }

    pub(super) fn add(
        &mut self,
        of_all: &Refinement,
        place: usize,
        check: Fit,
        screened: &[Screened],
    ) {
        let refined = &of_all.kept;
        let best = &refined[place];
        let others = refined.iter().enumerate();
        let others = others.filter(|(i, r)| *i != place && r.parts.len() == 1 && !r.is_form());
        let others: Vec<RunnerUp> = others.map(|(_, r)| r.runner_up()).collect();
        // Beside a form that comes with it look-alikes are sought at the end.
        let beside = (self.steady.is_none() && !best.has_form()).then(|| {
            let names = self.named.iter().map(|n| n.name);
            names.collect::<Vec<_>>()
        });
        for part in &best.parts {
            self.named.push(Named {
                name: part.effect.name,
                evidence: best.gain,
                held_out: self.check.deviance - check.deviance,
                alike: match beside.is_none() {
                    true => Vec::new(),
                    false => self.alike(part, of_all, place, screened),
                },
                beside: beside.clone(),
                when_named: Vec::new(),
                runners_up: others.clone(),
            });
        }
        self.fit = best.fit.clone();
        self.check = check;
        self.settle();
        let new = self.named.len() - best.parts.len();
        let effects = &self.fit.state.effects[new..];
        for (named, active) in self.named[new..].iter_mut().zip(effects) {
            named.when_named.clone_from(&active.values);
        }
    }

    /// Candidates of one effect or two, by simulation; the simplest of the best first.
    pub(super) fn refine(&self, candidates: Vec<Vec<Screened>>, own: &Columns) -> Refinement {
        let promised = candidates.iter().map(|parts| parts[0].gain);
        let least = WORTH * promised.fold(0.0, f64::max);
        let asked = self.awaited();
        let awaits_force = asked
            .iter()
            .any(|name| Effect::named(name).is_some_and(is_force_in_time));
        let mut refined: Vec<Refined> = (candidates.into_par_iter())
            .filter_map(|parts| self.begun(parts, own, least, awaits_force))
            .collect();
        self.led_further(&mut refined, own);
        if !awaits_force {
            self.drop_loads_of_another_name(&mut refined);
        }
        self.carried_on(&mut refined, own, asked.is_empty());
        let mut unseen = Vec::new();
        refined.retain(|r| {
            let drops = asked.is_empty() && r.added().iter().any(|a| self.is_unseen(a));
            if let ([one], true) = (r.parts.as_slice(), drops) {
                unseen.push(one.effect.name);
            }
            !drops
        });
        refined.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        best_of_each(&mut refined);
        for r in &refined {
            tracing::debug!(
                name = r.parts.iter().map(|p| p.effect.name).collect::<Vec<_>>().join(" and "),
                predicted = r.parts[0].gain,
                gain = r.gain,
                screened = ?r.parts.iter().map(|p| &p.values).collect::<Vec<_>>(),
                found = ?r.added().iter().map(|a| &a.values).collect::<Vec<_>>(),
                "refined"
            );
        }
        let kept = self.simplest_first(refined);
        Refinement { kept, unseen }
    }

    /// Moves the simplest of those that explain about as much as the best to the front.
    pub(super) fn simplest_first(&self, mut refined: Vec<Refined>) -> Vec<Refined> {
        if let Some(at) = self.simplest_of_best(&refined, NEAR, enough) {
            refined[..=at].rotate_right(1);
        }
        refined
    }

    /// The simplest of those that explain what is `enough` beside the best, on fitted and check logs together: numbers fitted to what
    /// only the fitted logs have bring nothing on others. The first explains most of the fitted logs, and only those count that
    /// explain that `share` of it.
    pub(super) fn simplest_of_best(
        &self,
        refined: &[Refined],
        share: f64,
        enough: fn(f64) -> f64,
    ) -> Option<usize> {
        let near = share * refined.first()?.gain;
        let near = refined.iter().take_while(|r| r.gain >= near);
        let total = |r: &Refined| {
            let check = self.checker().at(r.fit.state.clone()).ok()?;
            Some(r.gain + self.check.deviance - check.deviance)
        };
        let near: Vec<&Refined> = near.collect();
        let totals: Vec<Option<f64>> = near.par_iter().map(|r| total(r)).collect();
        let best = totals
            .iter()
            .flatten()
            .fold(f64::NEG_INFINITY, |a, b| a.max(*b));
        let is_enough = |at: &usize| totals[*at].is_some_and(|total| total >= enough(best));
        let all = (0..near.len()).filter(is_enough);
        all.min_by_key(|at| near[*at].parameters())
    }

    /// The first two rounds of a candidate; `None` if the machine does not run with it, or it is a force in time of which less
    /// than `least` is to be had and none is awaited.
    fn begun(
        &self,
        parts: Vec<Screened>,
        own: &Columns,
        least: f64,
        awaits_force: bool,
    ) -> Option<Refined> {
        let fitter = self.fitter();
        let as_screened = || {
            let mut state = self.fit.state.clone();
            state.effects.extend(parts.iter().map(Screened::active));
            let fit = fitter.at(state).ok()?;
            // Promised sizes are near enough where an answer grows with its
            // size.
            let kept = self.fit.deviance - fit.deviance >= KEPT * parts[0].gain;
            Some(match kept {
                true => fit,
                false => fitter.best_size(fit, parts.len()),
            })
        };
        let start = match parts.as_slice() {
            [force] if is_force_in_time(force.effect) => {
                let found = self.force_in_time(own, least);
                found.or_else(|| as_screened().filter(|_| awaits_force))?
            }
            _ => as_screened()?,
        };
        Some(Refined {
            parts,
            fit: fitter.refine(start, own, 2),
            gain: 0.0,
        })
    }

    /// Leads the best candidates further by least squares: where known parameters may be far off, they have made up for what is
    /// not named yet, and D may be flat from there on.
    fn led_further(&self, refined: &mut [Refined], own: &Columns) {
        let Some(noise) = &self.steady else {
            return;
        };
        let fitter = self.fitter();
        let squares = fitter.squares(noise);
        refined.sort_by(|a, b| a.fit.deviance.total_cmp(&b.fit.deviance));
        let first = LED_FURTHER.min(refined.len());
        let (led, others) = refined.split_at_mut(first);
        let mut others: Vec<&mut Refined> = others.iter_mut().collect();
        others.sort_by(|a, b| squares(&a.fit).total_cmp(&squares(&b.fit)));
        let led = led.iter_mut().chain(others.into_iter().take(LED_FURTHER));
        led.collect::<Vec<_>>().into_par_iter().for_each(|r| {
            let near = fitter.by_least_squares(r.fit.clone(), self.known.clone(), noise, 0);
            let near = fitter.refine(near, own, 2);
            r.fit = r.fit.clone().better(near);
        });
    }

    /// Leaves out forces in time that are the constant load where that is a candidate, or act while no log moves.
    fn drop_loads_of_another_name(&self, refined: &mut Vec<Refined>) {
        let stands = |r: &Refined| r.parts.len() == 1 && r.parts[0].effect.name == STANDING;
        let has_standing = refined.iter().any(stands);
        let in_motion = self.in_motion();
        refined.retain(|r| match r.fit.state.effects.last() {
            Some(last) if r.parts.len() == 1 && is_force_in_time(last.effect) => {
                let times = [last.values[1], last.values[2]];
                let is_standing = has_standing && self.acts_throughout(times);
                in_motion.has(times) && !is_standing
            }
            _ => true,
        });
    }

    /// Further rounds of those that are near the best, and by how much D falls with each.
    fn carried_on(&self, refined: &mut [Refined], own: &Columns, is_open: bool) {
        let fitter = self.fitter();
        let gain = |fit: &Fit| self.fit.deviance - fit.deviance;
        // What is far behind after two rounds, or far from enough, is not carried further.
        let best = refined.iter().map(|r| gain(&r.fit)).fold(0.0, f64::max);
        let too_little = match is_open {
            true => PROMISING * self.needed(1, 1).max(self.material()),
            false => 0.0,
        };
        refined.par_iter_mut().for_each(|r| {
            let of_it = gain(&r.fit);
            if of_it > 0.5 * best - 50.0 && of_it > too_little {
                r.fit = fitter.refine(r.fit.clone(), own, 4);
            }
            r.gain = gain(&r.fit);
        });
        // Those that are near one another are compared where they end, with
        // derivatives of all effects as they are there, or a simple one that is
        // not there yet loses to one that contains it. Steps of a speed are short: an onset at
        // one is as good as that is.
        let best = refined.iter().map(|r| r.gain).fold(0.0, f64::max);
        let share = |r: &Refined| if r.comes_on_at_a_speed() { 0.5 } else { NEAR };
        let near = |r: &Refined| r.gain > share(r) * best && r.gain > too_little;
        if refined.iter().filter(|r| near(r)).count() > 1 {
            refined.par_iter_mut().filter(|r| near(r)).for_each(|r| {
                r.fit = fitter.refine(r.fit.clone(), &self.known, 8);
                r.gain = gain(&r.fit);
            });
        }
    }

    /// Whether a candidate is no effect of this machine: with its sizes there would be less than none of
    /// something, or it repeats as no such effect does.
    pub(super) fn cannot_be(&self, candidate: &Refined) -> bool {
        candidate.is_below_none(self.machine)
            || candidate.bends_own_friction()
            || self.leaves_no_friction(candidate)
            || self.hardly_repeats(candidate)
            || self.repeats_with_the_drive(candidate)
    }

    /// Whether a candidate, with `check` its fit of the check logs, proves itself there and leaves no channel
    /// of them worse.
    pub(super) fn holds(&self, candidate: &Refined, check: &Fit) -> bool {
        let held_out = self.check.deviance - check.deviance;
        self.proves_itself(candidate, held_out) && self.worsens_none(check)
    }

    fn proves_itself(&self, best: &Refined, held_out: f64) -> bool {
        let added = free_parameters(&best.fit.state).len() - free_parameters(&self.fit.state).len();
        let needed = self.needed(added, best.parts.len());
        tracing::debug!(gain = best.gain, held_out, needed, "on check logs");
        let sizes = [&self.check_logs, &self.fit_logs].map(|set| set.layout.size() as f64);
        let of_length = best.gain * (sizes[0] / sizes[1]).min(1.0);
        let least = LEAST_HELD_OUT.max(self.held_out_of(best) * of_length);
        best.gain >= needed && held_out >= least && best.gain >= self.material()
    }

    /// Beside what was found, a hundredth of its weight is what the model's own simplifications
    /// may bring.
    pub(super) fn material(&self) -> f64 {
        let largest = self.named.iter().map(|n| n.evidence).fold(0.0, f64::max);
        LEAST_EVIDENCE_SHARE * largest
    }

    /// Whether what a candidate adds, with `check` its fit of the check logs, is material; of an effect beside a form what it does
    /// beside that.
    fn is_material(&self, candidate: &Refined, check: &Fit) -> bool {
        let set = &self.check_logs;
        let after = set.rest(&check.traces);
        let is_beside_form = candidate.has_form() && !candidate.is_form();
        let mut state = check.state.clone();
        let named = state.effects.len() - candidate.parts.len();
        let added = state.effects.split_off(named);
        let forms = added.into_iter().filter(|a| is_beside_form && is_form(a));
        state.effects.extend(forms);
        let with_form = is_beside_form.then(|| self.checker().at(state.clone()).ok());
        let without = || Some(set.rest(&set.simulate(self.machine, &state).ok()?));
        let (machine, gap) = (self.machine, &self.gap_before);
        let with_form = with_form.flatten();
        // What is small beside all that a channel shows may be what is not right in the form.
        let is_small = |form: &Fit| {
            let rests = [&set.rest(&form.traces), &after];
            differ_immaterially(machine, set, rests)
        };
        if with_form.as_ref().is_some_and(is_small) {
            return false;
        }
        let before = with_form.as_ref().unwrap_or(&self.check);
        is_material(machine, set, before, &after, without, gap).unwrap_or(true)
    }

    /// Whether no channel of the check logs, fitted or not, is so much further off than
    /// before that no effect named later could make up for it.
    fn worsens_none(&self, check: &Fit) -> bool {
        let before = self.check_logs.rest(&self.check.traces);
        let after = self.check_logs.rest(&check.traces);
        let power = |rest: &[Vec<Vec<f64>>], c: usize| -> f64 {
            rest.iter().flat_map(|log| &log[c]).map(|r| r * r).sum()
        };
        (0..self.check_logs.channels.len()).all(|c| power(&after, c) <= WORSE * power(&before, c))
    }
}

/// Whether by its falls of D on the fitted and on the check logs something is no more than what is simpler:
/// the more numbers of a look-alike bring it over a limit that what it imitates is below.
fn is_no_more([gain, held_out]: [f64; 2], [simpler, simpler_held_out]: [f64; 2]) -> bool {
    enough(gain) <= simpler && held_out <= simpler_held_out + LEAST_HELD_OUT
}

#[cfg(test)]
mod tests {
    use super::is_no_more;

    #[test]
    fn a_look_alike_of_something_small_is_small_and_what_tells_more_is_not() {
        // A load of 3 % of the gap, and asymmetric friction that is the same.
        assert!(is_no_more([66.2, 24.2], [63.7, 25.2]));
        assert!(!is_no_more([120.0, 24.2], [63.7, 25.2]));
        assert!(!is_no_more([66.2, 60.0], [63.7, 25.2]));
    }
}
