//! Several effects that are pieces of one law.
//!
//! A law that is not in the library is put together from what is: a drag by the square of the
//! speed from viscous friction and less dry friction. Where a law of a single number, over what
//! they depend on, explains as much as all of them, and more of the check logs, they are not there.

use axis_sim::effects::{ActiveEffect, EffectChannel, Scales};

use super::evidence::{BY_CHANCE, LEAST_HELD_OUT, MATERIAL};
use super::is_form::is_form;
use super::revise::RIVAL;
use super::state::Search;
use super::types::{Named, RefusalReason, Refused};
use crate::estimate::columns::is_free;
use crate::estimate::fit::Fit;
use crate::name::curves::{Over, Place, courses, is_over};
use crate::name::library::{Candidate, responses};
use crate::name::terms::{Term, terms};

impl<'a> Search<'a> {
    /// Without those effects in whose place one law of a single number explains as much of the
    /// fitted logs (more, if it is one effect) and more of the check logs, and without what is
    /// needless beside that law; they are said to be refused.
    pub(super) fn without_pieces(&self) -> Option<Self> {
        let courses = courses(self.machine, &self.fit_logs, &self.fit.traces);
        let laws = terms(Place::Force).iter().filter(|t| t.has_one_number());
        let laws = laws.filter_map(|term| Some((term, term.as_effect(&courses)?)));
        let laws: Vec<Law> = laws.collect();
        let mut overs: Vec<Over> = laws.iter().map(|(term, _)| term.over).collect();
        overs.dedup();
        let tried = overs.into_iter().filter_map(|over| {
            let of_it = laws.iter().filter(|(term, _)| term.over == over);
            self.replaced_by(over, &of_it.cloned().collect::<Vec<_>>())
        });
        let best = tried.min_by(|a, b| a.fit.deviance.total_cmp(&b.fit.deviance))?;
        best.alone()
    }

    /// With the best of these laws in the place of all effects over that.
    fn replaced_by(&self, over: Over, laws: &[Law]) -> Option<Instead<'a>> {
        let mut without = self.clone();
        let mut taken = Vec::new();
        let mut active = Vec::new();
        while let Some(index) = without.piece(over) {
            taken.push(without.named[index].clone());
            active.push(without.fit.state.effects[index].clone());
            without = without.without(index)?;
        }
        if taken.is_empty() {
            return None;
        }
        let own = without.own_columns();
        let fitter = without.fitter();
        let candidate = |active: &ActiveEffect| Candidate {
            columns: responses(&fitter, &without.fit, active.effect, &active.values),
            effect: active.effect,
            values: active.values.clone(),
            scales: Scales::of(self.machine),
        };
        let screened = |candidates: &[Candidate]| without.screened_beside(&own, candidates, 1);
        // What one effect promises there, a law must promise as well; of several together
        // that is not known.
        let alone = match active.as_slice() {
            [one] => screened(&[candidate(one)]).first().map_or(0.0, |s| s.gain),
            _ => 0.0,
        };
        let laws_there: Vec<Candidate> = laws.iter().map(|(_, law)| candidate(law)).collect();
        let screened = screened(&laws_there).into_iter();
        let best = screened.max_by(|a, b| a.gain.total_cmp(&b.gain))?;
        if best.gain < RIVAL * alone {
            return None;
        }
        let refined = without.refine(vec![vec![best]], &own).kept;
        let fit = refined.into_iter().next()?.fit;
        let check = without.checker().at(fit.state.clone()).ok()?;
        let place = fit.state.effects.last()?.values[0];
        let (term, _) = laws.iter().find(|(_, law)| law.values[0] == place)?;
        let fall = self.fit.deviance - fit.deviance;
        let held_out = self.check.deviance - check.deviance;
        // One number in the place of several effects need only explain as much; in the place of
        // one, more than chance and the model's own simplifications bring.
        let least = match taken.as_slice() {
            [_] => BY_CHANCE.max(MATERIAL * (without.fit.deviance - fit.deviance)),
            _ => 0.0,
        };
        tracing::debug!(
            of = ?taken.iter().map(|n| n.name).collect::<Vec<_>>(),
            law = term.words,
            fall,
            least,
            held_out,
            "one law in their place"
        );
        (fall >= least && held_out >= LEAST_HELD_OUT).then_some(Instead {
            without,
            taken,
            term,
            fit,
        })
    }

    /// The place of a force over that which may be a piece of one law.
    fn piece(&self, over: Over) -> Option<usize> {
        self.fit.state.effects.iter().position(|active| {
            active.effect.channel == EffectChannel::Torque
                && is_over(over, active.effect.shown_over)
                && !is_form(active)
                && !self.is_accepted(active.effect.name)
        })
    }
}

/// A law of one number, and as an effect.
type Law = (&'static Term, ActiveEffect);

/// A law in the place of effects.
struct Instead<'a> {
    without: Search<'a>,
    taken: Vec<Named>,
    term: &'static Term,
    /// With the law, which is the last effect of its state.
    fit: Fit,
}

impl<'a> Instead<'a> {
    /// The search without these effects, and without what is needless beside the law.
    fn alone(self) -> Option<Search<'a>> {
        let Self {
            mut without,
            mut taken,
            term,
            mut fit,
        } = self;
        let mut index = 0;
        while let Some(named) = without.named.get(index) {
            let effect = fit.state.effects[index].effect;
            let numbers = effect.parameters.iter().filter(|p| is_free(p)).count();
            let mut state = fit.state.clone();
            state.remove(index);
            let start = without.fitter().at(state).ok()?;
            let bare = without.fitter().refine(start, &without.known, 4);
            let loss = bare.deviance - fit.deviance;
            if loss < without.needed(numbers, 1) && !without.is_accepted(effect.name) {
                taken.push(named.clone());
                without = without.without(index)?;
                fit = bare;
            } else {
                index += 1;
            }
        }
        taken.retain(|named| !named.is_form());
        let refused = Refused {
            effects: taken,
            reason: RefusalReason::OneLaw(term.words),
        };
        Some(without.with_refused(refused))
    }
}
