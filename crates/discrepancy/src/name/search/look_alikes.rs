//! What logs cannot tell from each effect that is named, once all of them are there.
//!
//! Beside effects that came or went later an effect has other look-alikes than when it was named. So each is
//! taken out at the end, and what would come in its place is looked at beside the others: other effects, and known
//! parameters that do as much at the edge of their tolerance.

use axis_sim::effects::{Effect, Scales};

use super::form::is_form;
use super::promise::Promises;
use super::refined::{Refined, alike};
use super::revise::RIVAL;
use super::state::Search;
use super::types::{Alike, AtEdge, ONE_CLASS};
use super::unseen::may_end_unseen;
use crate::estimate::columns::{Columns, is_free};
use crate::estimate::projector::sine;
use crate::name::library::{Candidate, responses};
use crate::name::screen::{Screened, Screening};

impl Search<'_> {
    /// Tells of each named effect what these logs cannot tell from it.
    pub(super) fn tell_look_alikes(&mut self) {
        let all = (0..self.named.len()).map(|index| self.look_alikes(index));
        let all: Vec<(Vec<Alike>, Vec<AtEdge>)> = all.collect();
        for (named, (alike, at_edge)) in self.named.iter_mut().zip(all) {
            (named.alike, named.at_edge) = (alike, at_edge);
        }
    }

    fn look_alikes(&self, index: usize) -> (Vec<Alike>, Vec<AtEdge>) {
        let active = &self.fit.state.effects[index];
        let without = match is_form(active) {
            true => None,
            false => self.without(index),
        };
        let Some(without) = without else {
            return Default::default();
        };
        let numbers = active
            .effect
            .parameters
            .iter()
            .filter(|p| is_free(p))
            .count();
        let loss = without.fit.deviance - self.fit.deviance;
        let at_edge = match loss < self.needed(numbers, 1) {
            true => without.left_their_edge(&self.fit.state),
            false => Vec::new(),
        };
        let own = without.own_columns();
        let Some(named) = without.as_screened(&own, index, self) else {
            return (Vec::new(), at_edge);
        };
        let loss = without.fall_to(&self.fit, std::slice::from_ref(active));
        let promises = Promises::new(&without, &own);
        let others = |effect: &Effect| effect.name != named.effect.name && self.wanted(effect, &[]);
        let screenings = promises.screenings(&own, others);
        let screened = screenings.first().map(|s| promises.one_by_one(s));
        let screened = screened.unwrap_or_default();
        let is_near = |s: &&Screened| {
            s.gain >= RIVAL * loss || sine(&named.fingerprint, &s.basis) < ONE_CLASS
        };
        let near = screened.iter().filter(is_near).take(self.settings.refined);
        let refinement = without.refine(near.map(|s| vec![s.clone()]).collect(), &own);
        // What does not hold on other motion is told from it by that.
        let (holding, failing): (Vec<Refined>, Vec<Refined>) =
            (refinement.kept.into_iter()).partition(|rival| without.holds_on_checks(rival));
        let unseen = refinement.unseen;
        let best = Refined {
            parts: vec![named],
            fit: self.fit.clone(),
            gain: loss,
        };
        let alike = alike(&best.parts[0], &best, &holding, &screened, |rival| {
            let is_it = |name: &&str| *name == rival.effect.name;
            let fails = failing.iter().any(|r| is_it(&r.parts[0].effect.name));
            let ended = may_end_unseen(rival.effect) && unseen.iter().any(is_it);
            !(fails || ended || self.is_unseen(rival))
        });
        (alike, at_edge)
    }

    /// Whether a rival tells as much of the check logs as is asked of what is named.
    fn holds_on_checks(&self, rival: &Refined) -> bool {
        let inside = self.inside(&rival.fit);
        let state = &inside.as_ref().unwrap_or(&rival.fit).state;
        let Ok(check) = self.checker().at(state.clone()) else {
            return false;
        };
        let beside = self.beside(&rival.fit.state);
        let held_out = self.held_out(rival, &beside, &check);
        self.proves_itself(rival, held_out) && self.worsens_none(&beside.check, &check)
    }

    /// A named effect as it would be screened here, where it is not: with the shape that it has.
    fn as_screened(&self, own: &Columns, index: usize, named: &Self) -> Option<Screened> {
        let active = &named.fit.state.effects[index];
        let fitter = self.fitter();
        let candidate = Candidate {
            columns: responses(&fitter, &self.fit, active.effect, &active.values),
            effect: active.effect,
            values: active.values.clone(),
            scales: Scales::of(self.machine),
        };
        let matrices = self.fit_logs.layout.spectral_matrices(&self.fit.rest);
        let all = [candidate];
        let screening = Screening::new(&fitter, &self.fit, own, &all, &matrices, |_| true);
        let mut screened = screening.one_by_one().pop()?;
        screened.candidate = None;
        Some(screened)
    }
}
