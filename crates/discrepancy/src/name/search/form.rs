//! In what form a friction is there: candidates beside the effects of the library.
//!
//! Nature's friction is not that of the model with other numbers. Were only the library's
//! effects tried, what is left of a friction whose onset differs would be named as a
//! second effect. So a form of each friction that is there already, and of the axis' own,
//! is tried beside them ([`FrictionForm`]), and is taken where it explains clearly more than
//! any effect.

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, Effect, Formed, FrictionForm, Nature, Scales};
use rayon::prelude::*;

use super::evidence::{BY_CHANCE, BY_ONE_NUMBER};
use super::is_form::is_form;
use super::refined::{NEAR, Refined, Refinement};
use super::state::Search;
use super::types::Named;
use crate::estimate::columns::{Columns, is_free};
use crate::name::library::{Candidate, responses};
use crate::name::screen::Screened;

/// Share of what a form explains that an effect of the library must explain to be taken
/// instead: it says more, with fewer numbers.
const INSTEAD: f64 = 0.9;

/// The same beside slip with a memory, which on most logs does nearly what plain dry friction
/// does.
const INSTEAD_OF_MEMORY: f64 = 0.6;

/// Share of what slip with a memory and a level each way explain that it must explain with one
/// level to be taken instead; what is a thirtieth of a gap is not named beside it either.
const OF_ONE_LEVEL: f64 = 0.97;

/// Effects that are tried together with a form.
const BESIDE_FORMS: usize = 3;

/// The axis' own dry friction as an effect; `None` where it has none.
pub(super) fn own_friction(axis: &Axis) -> Option<ActiveEffect> {
    let friction = &axis.friction;
    let level = friction.law.parameters().coulomb / friction.lever(axis.travel_per_radian());
    let effect = Effect::named(PLAIN)?;
    (level > 0.0).then(|| ActiveEffect {
        effect,
        values: vec![level],
    })
}

/// Level of the axis' own dry friction, and by how much effects raise it, the mean of both directions; N or N·m.
pub(crate) fn dry_friction(axis: &Axis, effects: &[ActiveEffect]) -> [f64; 2] {
    let own = own_friction(axis).map_or(0.0, |own| own.values[0]);
    let of_effect = |active: &ActiveEffect| match active.effect.name {
        PLAIN | WITH_MEMORY => active.values[0],
        BY_DIRECTION => 0.5 * (active.values[0] + active.values[1]),
        _ => 0.0,
    };
    [own, effects.iter().map(of_effect).sum()]
}

impl Search<'_> {
    /// The axis' own dry friction with a memory in place of a bristle, as two effects of those
    /// that were `screened`: slip of its level, and the bristle's taken away. Neither is worth
    /// much alone.
    pub(super) fn own_with_memory(&self, screened: &[Screened]) -> Vec<Vec<Screened>> {
        let find = |name: &str| screened.iter().find(|s| s.effect.name == name);
        let (own, slip, dry) = (own_friction(self.machine), find(WITH_MEMORY), find(PLAIN));
        let (Some(own), Some(slip), Some(dry)) = (own, slip, dry) else {
            return Vec::new();
        };
        let level = own.values[0];
        let pair = |distance: &f64| {
            let mut pair = vec![slip.clone(), dry.clone()];
            pair[0].values = vec![level, *distance];
            pair[1].values = vec![-level];
            pair
        };
        let typical = slip.effect.parameters[1].typical(&slip.scales);
        [0.3, 1.0].map(|by| pair(&(by * typical))).to_vec()
    }

    /// Forms that are not there yet, beside the derivatives of the fit's own parameters; of each family the
    /// start that explains most, and the same as it comes on with speed alone.
    pub(super) fn forms(&self, own: &Columns) -> Vec<Screened> {
        let speeds = self.fit.traces.iter().flat_map(|t| &t.speed);
        let fastest = speeds.fold(0.0_f64, |most, v| most.max(v.abs()));
        let there = |of: &ActiveEffect| {
            let forms = self.fit.state.effects.iter().filter_map(FrictionForm::of);
            let mut bases = forms.filter_map(|form| form.base());
            bases.any(|base| base.effect.name == of.effect.name)
        };
        let all = self.fit.state.effects.iter().cloned();
        let all = all
            .chain(own_friction(self.machine))
            .filter(|of| !there(of));
        let forms = all.flat_map(|friction| {
            FrictionForm::all(&Formed {
                fall: self.fall_of(&friction),
                friction,
                fastest,
            })
        });
        let fitter = self.fitter();
        let scales = Scales::of(self.machine);
        // One that ended as something simpler would do so again.
        let forms = forms.filter(|form| !self.unseen.contains(&form.effect.name));
        let candidate = |form: ActiveEffect| Candidate {
            columns: responses(&fitter, &self.fit, form.effect, &form.values),
            effect: form.effect,
            values: form.values,
            scales,
        };
        let forms: Vec<ActiveEffect> = forms.collect();
        let forms: Vec<Candidate> = forms.into_par_iter().map(candidate).collect();
        let families = forms.chunk_by(|a, b| a.effect.name == b.effect.name);
        let screened = families.map(|family| {
            let free = family[0].effect.parameters.iter().filter(|p| is_free(p));
            let all = self.screened_beside(own, family, free.count()).into_iter();
            let best = all.max_by(|a, b| a.gain.total_cmp(&b.gain))?;
            let whole = FrictionForm::of(&best.active()).and_then(|form| form.whole());
            let whole = whole.map(|whole| Screened {
                values: whole.values,
                ..best.clone()
            });
            Some([Some(best), whole])
        });
        screened.flatten().flatten().flatten().collect()
    }

    /// The candidates and, where a form explains nearly as much as any, the effects that explain most, each with the form that
    /// explains most beside it: the residual of an onset of another form hides effects, and each effect hides part of that residual.
    pub(super) fn with_those_beside_forms(&self, mut refined: Vec<Refined>) -> Vec<Refined> {
        let most = |is: &dyn Fn(&Refined) -> bool| {
            let gains = refined.iter().filter(|r| is(r)).map(|r| r.gain);
            gains.fold(0.0, f64::max)
        };
        if most(&Refined::is_form) < NEAR * most(&|_| true) {
            return refined;
        }
        let singles = refined
            .iter()
            .filter(|r| r.parts.len() == 1 && !r.is_form());
        let singles: Vec<&Refined> = singles.take(BESIDE_FORMS).collect();
        let pairs = singles.into_par_iter().filter_map(|single| {
            let mut beside = self.clone();
            beside.fit = single.fit.clone();
            let own = beside.own_columns();
            let forms = beside.forms(&own).into_iter().map(|form| vec![form]);
            let form = beside.best_form(beside.refine(forms.collect(), &own).kept)?;
            let fit = self.fitter().refine(form.fit, &self.known, 8);
            Some(Refined {
                parts: [single.parts.clone(), form.parts].concat(),
                gain: self.fit.deviance - fit.deviance,
                fit,
            })
        });
        let pairs: Vec<Refined> = pairs.collect();
        for r in &pairs {
            let name = r.parts.iter().map(|p| p.effect.name);
            tracing::debug!(name = ?name.collect::<Vec<_>>(), gain = r.gain, "beside a form");
        }
        refined.extend(pairs);
        refined.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        self.simplest_first(refined)
    }

    /// Fits each form anew in all families: which one it is shows once the effects beside it are there.
    pub(super) fn reform(&mut self) {
        let forms = self.fit.state.effects.iter().filter(|a| is_form(a));
        let bases: Vec<Option<&str>> = forms.map(base_of).collect();
        for base in bases {
            if let Some(other) = self.formed_anew(base) {
                *self = other;
            }
        }
    }

    /// The form that explains most of fitted and check logs, or the simplest that explains as much: it stands for what is not asked,
    /// and must carry over to other motion.
    fn best_form(&self, mut forms: Vec<Refined>) -> Option<Refined> {
        forms.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let best = self.simplest_of_best(&forms, 0.0, |best| best - BY_CHANCE)?;
        Some(forms.swap_remove(best))
    }

    /// With the form of this friction as it explains most, in whatever family; `None` if it is so already.
    fn formed_anew(&self, base: Option<&str>) -> Option<Self> {
        let effects = &self.fit.state.effects;
        let is_of_base = |a: &ActiveEffect| is_form(a) && base_of(a) == base;
        let index = effects.iter().position(is_of_base)?;
        let present = effects[index].clone();
        // All else stays as it is: it was fitted beside the form, and without one it would move away.
        let mut without = self.taken_out(index, 0)?;
        let own = without.own_columns();
        let weights = (without.fit_logs.layout).spectral_matrices(&without.fit.rest);
        let mut others = without.forms(&own);
        others.retain(|s| base_of(&s.active()) == base);
        let others = others.into_iter().map(|form| vec![form]).collect();
        let mut all = without.refine(others, &own).kept;
        all.push(Refined {
            parts: vec![without.screened_as(present.clone(), &own, &weights)?],
            gain: without.fit.deviance - self.fit.deviance,
            fit: self.fit.clone(),
        });
        let best = without.best_form(all)?;
        if best.fit.deviance == self.fit.deviance {
            return None;
        }
        let family = best.parts[0].effect.name;
        let check = without.checker().at(best.fit.state.clone()).ok()?;
        if !without.holds(&best, &check) {
            return None;
        }
        tracing::debug!(of = present.effect.name, family, "form fitted anew");
        let of_all = Refinement {
            kept: vec![best],
            unseen: Vec::new(),
        };
        without.add(&of_all, 0, check, &[]);
        Some(without)
    }

    /// The fall of the axis' own friction from break-away to sliding, and its speed; `None` of any other.
    fn fall_of(&self, friction: &ActiveEffect) -> Option<[f64; 2]> {
        let own = self.machine.friction.law.parameters();
        let lever = self
            .machine
            .friction
            .lever(self.machine.travel_per_radian());
        let fall = (own.stiction - own.coulomb) / lever;
        let falls = friction.effect.name == PLAIN && fall > 0.0;
        falls.then_some([fall, own.stribeck_speed * lever])
    }
}

/// Name of the friction that a form is of.
fn base_of(form: &ActiveEffect) -> Option<&'static str> {
    Some(FrictionForm::of(form)?.base()?.effect.name)
}

impl Refined {
    /// Whether it is nothing but a form.
    pub(super) fn is_form(&self) -> bool {
        self.parts
            .iter()
            .all(|p| FrictionForm::is_one(p.effect.name))
    }

    /// Whether it has a form, alone or beside an effect.
    pub(super) fn has_form(&self) -> bool {
        self.parts
            .iter()
            .any(|p| FrictionForm::is_one(p.effect.name))
    }

    /// Whether it has a form with a speed that is fitted.
    pub(super) fn comes_on_at_a_speed(&self) -> bool {
        let has_speed = |p: &Screened| {
            let mut parameters = p.effect.parameters.iter();
            parameters.any(|p| matches!(p.nature, Nature::Speed(..)))
        };
        let mut forms = (self.parts.iter()).filter(|p| FrictionForm::is_one(p.effect.name));
        forms.any(has_speed)
    }

    /// Whether it has a form, or is a friction that is another one in another form: slip with a
    /// memory is dry friction whose onset has one.
    fn is_of_another_form(&self) -> bool {
        let with_memory = |p: &Screened| p.effect.name == WITH_MEMORY;
        let is_dry = |p: &Screened| DRY.contains(&p.effect.name);
        let others = self.parts.iter().filter(|p| !with_memory(p));
        self.has_form() || self.parts.iter().any(with_memory) && others.into_iter().all(is_dry)
    }

    /// Whether it is slip with a memory and another dry friction, and nothing else.
    fn is_memory_beside(&self, other: &str) -> bool {
        let has = |name: &str| self.parts.iter().any(|p| p.effect.name == name);
        self.parts.len() == 2 && has(WITH_MEMORY) && has(other)
    }

    /// Whether it has dry friction of one level alone.
    fn is_plain(&self) -> bool {
        self.parts.iter().all(|p| p.effect.name == PLAIN)
    }

    /// Whether it is a dry friction that comes on through the bristle, alone.
    fn is_dry(&self) -> bool {
        matches!(self.parts.as_slice(), [one] if DRY.contains(&one.effect.name))
    }

    /// Whether it is a form of the axis' own dry friction, and not of an effect that is there.
    fn is_form_of_own(&self) -> bool {
        let effects = &self.fit.state.effects;
        let base = effects.last().and_then(|a| FrictionForm::of(a)?.base());
        base.is_some_and(|base| effects.iter().all(|a| a.effect.name != base.effect.name))
    }

    /// Whether it is a fall of dry friction with speed, alone and of the other sign.
    fn is_rise(&self) -> bool {
        let is_fall = matches!(self.parts.as_slice(), [one] if one.effect.name == FALL);
        is_fall
            && self
                .fit
                .state
                .effects
                .last()
                .is_some_and(|a| a.values[0] < 0.0)
    }
}

impl Refined {
    /// Whether it takes sliding friction away and adds a fall from rest to it: together another
    /// course of the axis' own friction over speed, and no two effects.
    pub(super) fn bends_own_friction(&self) -> bool {
        let effects = &self.fit.state.effects;
        let is_friction = |a: &ActiveEffect| a.effect.name == FALL || DRY.contains(&a.effect.name);
        let falls = |a: &ActiveEffect| a.effect.name == FALL && a.values[0] > 0.0;
        let dry = effects.iter().filter(|a| DRY.contains(&a.effect.name));
        let level: f64 = dry.flat_map(|a| &a.values).sum();
        self.added().iter().any(is_friction) && effects.iter().any(falls) && level < 0.0
    }
}

impl Search<'_> {
    /// Whether a candidate leaves the axis less than no dry friction, sliding or at break-away, or
    /// less than no viscous friction, in one direction: no contact does that, but an onset of another
    /// form may look like it, and a fall with speed like viscous friction that drives.
    /// Break-away below sliding friction does occur, as on plastic guideways, but not where the
    /// axis file tells of a fall.
    pub(super) fn leaves_no_friction(&self, candidate: &Refined) -> bool {
        let effects = &candidate.fit.state.effects;
        let new = &effects[effects.len() - candidate.parts.len()..];
        let has = |name: &str| new.iter().any(|a| a.effect.name == name);
        let friction = &self.machine.friction;
        let lever = friction.lever(self.machine.travel_per_radian());
        let own = friction.law.parameters();
        // The lesser of the directions, where an effect tells them apart.
        let of = |name: &str| -> f64 {
            let all = self.machine.effects.iter().chain(effects);
            let there = all.filter(|a| a.effect.name == name);
            let values =
                |a: &ActiveEffect| match [BY_DIRECTION, VISCOUS_BY_DIRECTION].contains(&name) {
                    true => a.values[0].min(a.values[1]),
                    false => a.values[0],
                };
            there.map(values).sum()
        };
        let sliding = own.coulomb / lever + of(PLAIN) + of(BY_DIRECTION) + of(WITH_MEMORY);
        let own_fall = (own.stiction - own.coulomb) / lever;
        let fall = own_fall + of(FALL);
        let rises = own_fall > 0.0 && fall < 0.0;
        let viscous = own.viscous / lever.powi(2) + of(VISCOUS) + of(VISCOUS_BY_DIRECTION);
        let is_viscous = has(VISCOUS) || has(VISCOUS_BY_DIRECTION);
        is_viscous && viscous < 0.0
            || (has(PLAIN) || has(BY_DIRECTION)) && sliding < 0.0
            || has(FALL) && (rises || sliding + fall < 0.0)
    }

    /// Whether an effect is dry friction in another form beside one that is there, or a fall
    /// with speed beside a form, whose curve over speed has it: the two would share what is one
    /// friction.
    pub(super) fn doubles_a_friction(&self, effect: &Effect) -> bool {
        let is_there = |is: &dyn Fn(&Named) -> bool| self.named.iter().any(is);
        effect.name == WITH_MEMORY && is_there(&|n| DRY.contains(&n.name))
            || DRY.contains(&effect.name) && is_there(&|n| n.name == WITH_MEMORY)
            || effect.name == FALL && is_there(&Named::is_form)
    }
}

/// Dry friction.
const PLAIN: &str = "coulomb-friction";

/// Dry friction of one level, or of one a direction.
const DRY: [&str; 2] = [PLAIN, BY_DIRECTION];

/// Dry friction of one level a direction.
const BY_DIRECTION: &str = "asymmetric-friction";

/// Viscous friction of one coefficient, and of one a direction.
const VISCOUS: &str = "viscous-friction";
const VISCOUS_BY_DIRECTION: &str = "asymmetric-viscous-friction";

/// Dry friction that falls with speed.
const FALL: &str = "stribeck-friction";

/// Dry friction with a memory.
pub(super) const WITH_MEMORY: &str = "maxwell-slip-hysteresis";

impl Search<'_> {
    /// Effects before a form that explains hardly more. But of the axis' own friction a form goes
    /// before a fall of the other sign: that is the same friction, which comes on with speed. Slip
    /// with a memory goes behind dry friction, whatever that does, as the way on which it comes on may be
    /// wrong in the file, or else behind what does most of what it does; unless it does more than that
    /// with a form.
    pub(super) fn effects_before_forms(&self, refined: &mut [Refined]) {
        let has_form = refined.iter().any(Refined::is_form_of_own);
        let is_own = |r: &Refined| has_form && r.is_rise();
        if let Some(rise) = refined.iter().position(is_own) {
            let least = INSTEAD * refined[rise].gain;
            let is_instead = |r: &Refined| r.is_form_of_own() && r.gain >= least;
            refined[rise..].sort_by_key(|r| !is_instead(r));
        }
        let is_other = |r: &Refined| r.is_of_another_form() || is_own(r);
        let Some(first) = refined.first().filter(|r| is_other(r)) else {
            return;
        };
        let with_memory = !first.has_form() && !first.is_rise();
        let share = match with_memory {
            true => INSTEAD_OF_MEMORY,
            false => INSTEAD,
        };
        let least = share * first.gain;
        let place = |of: &dyn Fn(&Refined) -> bool| refined.iter().position(of);
        let dry = || {
            let best = place(&Refined::is_dry).filter(|_| with_memory)?;
            let near = refined[best].gain - BY_ONE_NUMBER;
            place(&|r| r.is_dry() && r.is_plain() && r.gain >= near).or(Some(best))
        };
        let other = || place(&|r| !is_other(r) && r.gain >= least);
        let Some(at) = dry().or_else(other) else {
            return;
        };
        if !(with_memory && self.outdoes_all_forms(first, &refined[at])) {
            refined[..=at].rotate_right(1);
        }
    }

    /// Whether slip with a memory explains more than another candidate with the form of a
    /// friction beside it, whose curve has several numbers.
    fn outdoes_all_forms(&self, memory: &Refined, other: &Refined) -> bool {
        let mut beside = self.clone();
        beside.fit = other.fit.clone();
        let own = beside.own_columns();
        let forms = beside.forms(&own).into_iter().map(|form| vec![form]);
        let refined = beside.refine(forms.collect(), &own).kept;
        let form = refined.iter().map(|r| r.gain).fold(0.0, f64::max);
        tracing::debug!(
            memory = memory.gain,
            other = other.gain,
            form,
            "slip with a memory, and another in any form"
        );
        memory.gain > other.gain + form + BY_CHANCE
    }
}

/// Own friction with a memory in place of a bristle before the same with another level each
/// way, unless that explains clearly more: the two levels make up for what is not named yet.
pub(super) fn own_before_directions(refined: &mut [Refined]) {
    let Some(first) = refined.first().filter(|r| r.is_memory_beside(BY_DIRECTION)) else {
        return;
    };
    let least = OF_ONE_LEVEL * first.gain;
    let one_level = |r: &Refined| r.is_memory_beside(PLAIN) && r.gain >= least;
    if let Some(at) = refined.iter().position(one_level) {
        refined[..=at].rotate_right(1);
    }
}
