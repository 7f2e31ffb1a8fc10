//! Effects that the logs do not tell from one that is named.

use axis_sim::effects::ActiveEffect;

use super::evidence::EQUAL;
use super::is_form::is_form;
use super::promise::{Promises, best_first};
use super::refined::{Refined, Refinement};
use super::revise::RIVAL;
use super::state::{Search, steady_noise_beside};
use super::types::{Alike, ONE_CLASS};
use crate::estimate::projector::sine;
use crate::name::screen::Screened;

impl Search<'_> {
    /// Seeks the look-alikes of each effect anew that was named beside others than stand beside it now, or
    /// beside a residual far above noise: what was not named yet, or has been taken out since, may have made
    /// two effects look alike, or hidden that they do.
    pub(super) fn find_look_alikes(&mut self) {
        for index in 0..self.named.len() {
            let beside = self.named_beside(index);
            let is_of_now = self.named[index].beside.as_ref() == Some(&beside);
            if is_of_now || is_form(&self.fit.state.effects[index]) {
                continue;
            }
            if let Some(alike) = self.look_alikes_of(index) {
                let named = &mut self.named[index];
                let names = |all: &[Alike]| -> Vec<&str> {
                    all.iter().map(|a| a.fitted.effect.name).collect()
                };
                tracing::debug!(name = named.name, before = ?names(&named.alike), now = ?names(&alike), "look-alikes");
                named.alike = alike;
                named.beside = Some(beside);
            }
        }
    }

    /// Names of all that is named but one.
    fn named_beside(&self, index: usize) -> Vec<&'static str> {
        let others = self.named.iter().enumerate().filter(|(i, _)| *i != index);
        others.map(|(_, named)| named.name).collect()
    }

    /// The look-alikes of an effect beside all others that are named; `None` where these cannot be
    /// simulated without it. Where the residual without it is far above noise, all are weighed by noise.
    fn look_alikes_of(&self, index: usize) -> Option<Vec<Alike>> {
        let mut without = self.without(index)?;
        let effect = self.fit.state.effects[index].effect;
        let gain = without.fit.deviance - self.fit.deviance;
        without.steady = steady_noise_beside(&without.fitter(), &without.fit);
        let own_columns = without.own_columns();
        let promises = Promises::new(&without, &own_columns);
        let screenings = promises.screenings(&own_columns, |effect| without.wanted(effect, &[]));
        let is_rival = |s: &Screened| s.effect.name != effect.name;
        let (screened, mut rivals) = match (&without.steady, screenings.as_slice()) {
            (Some(_), [_, by_noise]) => (best_first(by_noise), promises.of_most(&screenings)),
            _ => {
                let screened = promises.one_by_one(screenings.first()?);
                let rivals = screened.iter().filter(|s| s.gain >= RIVAL * gain);
                let rivals = rivals.map(|s| vec![s.clone()]).collect();
                (screened, rivals)
            }
        };
        rivals.retain(|parts: &Vec<Screened>| is_rival(&parts[0]));
        rivals.truncate(self.settings.refined);
        let weights = match &without.steady {
            Some(_) => promises.of_noise().to_vec(),
            None => without.fit_logs.layout.spectral_matrices(&without.fit.rest),
        };
        let itself = self.fit.state.effects[index].clone();
        let own = without.screened_as(itself, &own_columns, &weights)?;
        let mut of_all = without.refine(rivals, &own_columns);
        // What does not hold on other motion is no second explanation.
        of_all.kept.retain(|rival| {
            let check = without.checker().at(rival.fit.state.clone());
            check.is_ok_and(|check| without.holds(rival, &check))
        });
        let itself = Refined {
            parts: vec![own.clone()],
            fit: self.fit.clone(),
            gain,
        };
        of_all.kept.insert(0, itself);
        Some(without.alike(&own, &of_all, 0, &screened))
    }

    /// Effects that do nearly the same as `own`, a part of the best, or explain as much: the logs
    /// cannot tell. The best is at `place`; those before it did not hold on other motion. What can do more
    /// is not among them, unless these logs would not show the more, or show it and not clearly enough to take
    /// it. What is no other than a simpler effect, or cannot be on this machine, is no second explanation.
    pub(super) fn alike(
        &self,
        own: &Screened,
        of_all: &Refinement,
        place: usize,
        screened: &[Screened],
    ) -> Vec<Alike> {
        let (best, refined) = (&of_all.kept[place], &of_all.kept[place..]);
        let pair = best.parts.iter().map(|p| p.effect.name);
        let pair: Vec<&str> = pair.collect();
        let fitted = |other: &Screened| {
            refined.iter().find(|r| match r.parts.as_slice() {
                [one] => one.effect.name == other.effect.name,
                _ => false,
            })
        };
        let explains_more = |other: &Screened| {
            let clearly = EQUAL.max(CLEARLY * best.gain);
            fitted(other).is_some_and(|r| r.gain > best.gain + clearly)
        };
        let others = screened
            .iter()
            .filter(|other| !pair.contains(&other.effect.name))
            .filter(|other| fitted(other).is_none_or(|r| !self.cannot_be(r)))
            .filter(|other| {
                let more = other.basis.ncols() > own.basis.ncols();
                explains_more(other) || !(more && other.more_is_shown(own, best.gain, EQUAL))
            });
        let mut all: Vec<Alike> = others
            .filter_map(|other| {
                let fitted = fitted(other);
                let more = other.basis.ncols() > own.basis.ncols();
                let equal = fitted.is_some_and(|r| (r.gain - best.gain).abs() < EQUAL)
                    || explains_more(other);
                let sine = sine(&own.fingerprint, &other.basis);
                let nearest = || ActiveEffect {
                    effect: other.effect,
                    // A fit drives what the logs do not show wherever noise points.
                    values: match more {
                        true => other.nearest(&own.fingerprint),
                        false => other.values.clone(),
                    },
                };
                let fitted = fitted.filter(|_| !more);
                let last = fitted.and_then(|r| r.fit.state.effects.last().cloned());
                (sine < ONE_CLASS || equal).then(|| Alike {
                    fitted: last.unwrap_or_else(nearest),
                    sine,
                })
            })
            .filter(|alike| {
                let rival = &alike.fitted;
                !(self.is_unseen(rival) || of_all.ended_unseen(rival.effect.name))
            })
            .collect();
        all.sort_by(|a, b| a.sine.total_cmp(&b.sine));
        all
    }
}

/// Share of what an effect explains by which another must explain more to speak against it:
/// friction of two directions always explains a little more than friction of one.
const CLEARLY: f64 = 0.05;
