//! Second thoughts, once all effects are there.
//!
//! What was named first was named beside all that was not named yet, which may have
//! made something of more parameters, or something else, look better. So each
//! effect is taken out again: where the others do without it, it goes; where the
//! search would now take another in its place, that comes (sequential
//! replacement: A. Miller, Subset Selection in Regression, 2nd ed., 2002, §3.6).

use axis_sim::effects::{ActiveEffect, Effect, EffectVariable};

use super::evidence::{BY_CHANCE, BY_ONE_NUMBER, LEAST_EVIDENCE_SHARE};
use super::intervals::Intervals;
use super::is_form::is_form;
use super::promise::Promises;
use super::state::Search;
use super::types::{Named, Replaced};
use crate::answers::is_form_of;
use crate::estimate::columns::is_free;
use crate::estimate::known::pinned;
use crate::estimate::spread::over_noise;
use crate::name::transfer::Transfer;

/// Share of what an effect brings, or promises, that another must promise in its place before
/// that is tried.
pub(super) const RIVAL: f64 = 0.5;

/// Effects of two levels, and those of one.
const ONE_OF_TWO: [(&str, &str); 2] = [
    ("asymmetric-friction", "coulomb-friction"),
    ("asymmetric-viscous-friction", "viscous-friction"),
];

/// Least size of an effect, in deviations of noise: what it passes in one of a
/// thousand draws, with deviations from sixteen runs.
pub(crate) const ABOVE_NOISE: f64 = 4.0;

impl Search<'_> {
    /// Takes out effects that others added later have made needless, and puts
    /// others in the place of those in whose place they explain as much.
    pub(super) fn revise(&mut self) {
        self.reform();
        let mut index = 0;
        while index < self.named.len() {
            let Some(without) = self.without(index) else {
                index += 1;
                continue;
            };
            let loss = without.fit.deviance - self.fit.deviance;
            let largest = self.named.iter().map(|n| n.evidence).fold(0.0, f64::max);
            let dropped = self.fit.state.effects[index].effect;
            let needed = self.needed(dropped.parameters.iter().filter(|p| is_free(p)).count(), 1);
            let form = is_form(&self.fit.state.effects[index]);
            let accepted = self.is_accepted(dropped.name);
            if !accepted && loss < needed.max(LEAST_EVIDENCE_SHARE * largest) {
                *self = without;
                continue;
            }
            self.named[index].evidence = loss;
            let simpler = (!accepted).then(|| self.simplified(index, loss));
            if let Some(simpler) = simpler.flatten() {
                *self = simpler;
                index += 1;
                continue;
            }
            let values = self.named[index].when_named.clone();
            let other = (!accepted && !form).then(|| without.with_another(dropped, loss));
            if let Some((other, by)) = other.flatten() {
                tracing::debug!(of = dropped.name, by, "exchange");
                let when_named = ActiveEffect {
                    effect: dropped,
                    values,
                };
                *self = other;
                self.replaced.push(Replaced { when_named, by });
            }
            index += 1;
        }
    }

    /// Puts effects that do not differ between the directions in the place of those that do, where they
    /// explain as much.
    pub(super) fn simplify(&mut self) {
        for index in 0..self.named.len() {
            let Named { name, evidence, .. } = self.named[index];
            let simpler = (!self.is_accepted(name)).then(|| self.simplified(index, evidence));
            if let Some(simpler) = simpler.flatten() {
                *self = simpler;
            }
        }
    }

    /// Takes out the first effect of a balance of which the intervals of all sizes hold zero. Those of a
    /// replay are of simulated noise, by which [`Search::drop_noise`] asks.
    pub(super) fn drop_undetermined(&mut self, intervals: &Intervals) -> bool {
        if !self.fit_logs.is_balanced() {
            return false;
        }
        let undetermined = |e: &usize| {
            let active = &self.fit.state.effects[*e];
            let is_kept = is_form(active) || self.is_accepted(active.effect.name);
            !is_kept && self.may_be_nothing(*e, intervals)
        };
        let Some(effect) = (0..self.fit.state.effects.len()).find(undetermined) else {
            return false;
        };
        let Some(without) = self.without(effect) else {
            return false;
        };
        let name = self.fit.state.effects[effect].effect.name;
        tracing::debug!(name, "not determined");
        *self = without;
        true
    }

    /// Takes out the effect that noise could best have made, if its size is not
    /// [`ABOVE_NOISE`]. Near zero frequency the noise of a loop is many times what it
    /// is on average below 25 Hz, and slow effects seem to explain it.
    pub(super) fn drop_noise(&mut self, intervals: &Intervals) -> bool {
        let Intervals { columns, noise, .. } = intervals;
        if noise.is_empty() {
            return false;
        }
        let over = |effect: usize, shares: &[f64]| {
            let pinned = pinned(self.machine, shares);
            over_noise(&self.fitter(), &self.fit, columns, noise, effect, &pinned)
        };
        let all = self.fit.state.effects.iter().enumerate();
        let free = all.filter(|(_, active)| !self.is_accepted(active.effect.name));
        let mut sizes: Vec<(usize, f64)> = free
            .map(|(e, _)| (e, over(e, &self.fit.state.shares)))
            .collect();
        sizes.retain(|(_, size)| *size < ABOVE_NOISE);
        sizes.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (effect, size) in sizes {
            let Some(without) = self.without(effect) else {
                continue;
            };
            // Known parameters may do its work as far as they go, and no further.
            let alone = over(effect, &without.fit.state.shares);
            let name = self.fit.state.effects[effect].effect.name;
            tracing::debug!(name, size, alone, "size over noise");
            if alone < ABOVE_NOISE {
                *self = without;
                return true;
            }
        }
        false
    }

    /// Takes out the effect whose size on the check logs differs most from that on the fitted ones, if more than a law of the
    /// library may ([`Transfer`]): what has another size on other motion stands for something else.
    pub(super) fn drop_untransferred(&mut self) -> bool {
        let Some((effect, transfer)) = self.least_transferred() else {
            return false;
        };
        let Some(without) = self.without(effect) else {
            return false;
        };
        let name = self.fit.state.effects[effect].effect.name;
        tracing::debug!(
            name,
            transfer.ratio,
            transfer.half_width,
            "another size on the check logs"
        );
        let named = self.named[effect].clone();
        *self = without;
        self.untransferred.push((named, transfer.ratio));
        true
    }

    /// The effect whose size on the check logs differs most, if it does so by too much.
    fn least_transferred(&self) -> Option<(usize, Transfer)> {
        let set = &self.check_logs;
        let with = set.rest(&self.check.traces);
        let of_effect = |index: usize| {
            let mut state = self.check.state.clone();
            state.remove(index);
            let without = set.rest(&set.simulate(self.machine, &state).ok()?);
            Some((index, Transfer::new(set, &without, &with)))
        };
        let effects = self.fit.state.effects.iter().enumerate();
        let asked = effects.filter(|(_, e)| !is_form(e) && !self.is_accepted(e.effect.name));
        let all = asked.filter_map(|(index, _)| of_effect(index));
        let differing = all.filter(|(_, transfer)| transfer.excess() > 0.0);
        differing.max_by(|a, b| a.1.excess().total_cmp(&b.1.excess()))
    }

    /// Whether the engineer takes an effect as there.
    pub(super) fn is_accepted(&self, name: &str) -> bool {
        self.settings.accepted.iter().any(|a| a == name)
    }

    /// Without one effect, the others and known parameters fitted again.
    pub(super) fn without(&self, index: usize) -> Option<Self> {
        self.taken_out(index, 4)
    }

    /// Without one effect and its forms, the others and known parameters fitted again in so many rounds.
    pub(super) fn taken_out(&self, index: usize, rounds: usize) -> Option<Self> {
        let mut without = self.clone();
        let mut state = self.fit.state.clone();
        for place in state.remove(index) {
            without.named.remove(place);
        }
        let start = self.fitter().at(state).ok()?;
        without.fit = self.fitter().refine(start, &self.known, rounds);
        without.check = self.checker().at(without.fit.state.clone()).ok()?;
        Some(without)
    }

    /// With an effect that does not differ between the directions in the place of one that
    /// does and brings this `loss`, where that explains as much of fitted and check logs together. Not where a form is of it.
    fn simplified(&self, index: usize, loss: f64) -> Option<Self> {
        let effects = &self.fit.state.effects;
        let active = &effects[index];
        let (_, simple) = ONE_OF_TWO
            .iter()
            .find(|(two, _)| *two == active.effect.name)?;
        let effect = Effect::named(simple)?;
        let is_there = effects.iter().any(|a| a.effect.name == effect.name);
        if is_there || effects.iter().any(|a| is_form_of(a, active)) {
            return None;
        }
        let mean = active.values.iter().sum::<f64>() / active.values.len() as f64;
        let mut state = self.fit.state.clone();
        state.effects[index] = ActiveEffect {
            effect,
            values: vec![mean],
        };
        let mut simpler = self.clone();
        let start = self.fitter().at(state).ok()?;
        simpler.fit = self.fitter().refine(start, &self.known, 8);
        let lost = simpler.fit.deviance - self.fit.deviance;
        simpler.check = self.checker().at(simpler.fit.state.clone()).ok()?;
        let held_out = simpler.check.deviance - self.check.deviance;
        tracing::debug!(of = active.effect.name, lost, held_out, loss, "simplified");
        if lost + held_out >= BY_ONE_NUMBER {
            return None;
        }
        let named = &mut simpler.named[index];
        named.alike.retain(|a| a.fitted.effect.name != effect.name);
        *named = Named {
            name: effect.name,
            evidence: loss - lost,
            when_named: vec![mean],
            ..named.clone()
        };
        Some(simpler)
    }

    /// With what the search now takes next, if that is something else than what
    /// was taken out, which had brought this `loss`; and its name. An effect over speed may have stood for
    /// another form of a friction.
    fn with_another(mut self, taken_out: &Effect, loss: f64) -> Option<(Self, &'static str)> {
        let own = self.own_columns();
        let promises = Promises::new(&self, &own);
        let others = |effect: &Effect| effect.name != taken_out.name && self.wanted(effect, &[]);
        let screenings = promises.screenings(&own, others);
        let mut rivals = promises.one_by_one(screenings.first()?);
        if taken_out.shown_over == EffectVariable::Speed {
            rivals.extend(self.forms(&own));
        }
        if rivals.iter().all(|rival| rival.gain < RIVAL * loss) {
            return None;
        }
        let before = self.fit.deviance;
        let known = self.named.len();
        let added = self.add_next();
        let by = self.named.get(known)?.name;
        let another = added
            && self.named.len() == known + 1
            && by != taken_out.name
            && before - self.fit.deviance >= loss - BY_CHANCE;
        another.then_some((self, by))
    }
}
