//! What was named, with intervals and words.

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, EffectParameter, FrictionForm, Scales};

use super::form::FormFound;
use super::types::{AtScrew, EffectFound, ParameterFound, RefusedEffects, ReplacedEffect};
use crate::answers::is_form_of;
use crate::estimate::columns::free_parameters;
use crate::name::search::{Found, LawInPlace, Named, RefusalReason, Refused, Replaced};
use crate::name::transfer::Transfer;

/// What an effect does on the logs that a discovery is judged by.
pub(super) struct OnCheck {
    /// Share of their gap that comes back without it.
    pub share_of_gap: f64,
    /// Its size there.
    pub transfer: Transfer,
}

pub(super) fn effect_found(
    machine: &Axis,
    found: &Found,
    index: usize,
    named: &Named,
    on_check: &OnCheck,
) -> EffectFound {
    let active = &found.fit.state.effects[index];
    let free = free_parameters(&found.fit.state);
    let known = found.fit.state.shares.len();
    let scales = Scales::of(machine);
    let parameter = |(p, (spec, &value)): (usize, (&EffectParameter, &f64))| {
        let column = free
            .iter()
            .position(|&at| at == (index, p))
            .map(|i| known + i);
        let half = column.map_or(0.0, |i| found.half_width(i, value));
        ParameterFound {
            name: spec.name.to_owned(),
            value,
            unit: spec.unit(&scales).to_owned(),
            ci95: [value - half, value + half],
            when_named: named.when_named.get(p).copied().unwrap_or(value),
            at_screw: at_screw(machine, value, spec.unit(&scales)),
        }
    };
    EffectFound {
        name: active.effect.name.to_owned(),
        summary: active.effect.summary.to_owned(),
        indistinguishable_from: named
            .alike
            .iter()
            .map(|a| a.fitted.effect.name.to_owned())
            .collect(),
        parameters: (active.effect.parameters.iter().zip(&active.values))
            .enumerate()
            .map(parameter)
            .collect(),
        channel: active.effect.channel.name().to_owned(),
        depends_on: active.effect.depends_on.to_owned(),
        share_of_gap: on_check.share_of_gap,
        evidence: [named.evidence, named.held_out],
        size_on_check: on_check.transfer.interval(),
        runners_up: named
            .runners_up
            .iter()
            .map(|r| (r.name.to_owned(), r.gain))
            .collect(),
        form: form_of(machine, found, active),
    }
}

/// The form of a named effect, where it has one.
fn form_of(machine: &Axis, found: &Found, active: &ActiveEffect) -> Option<FormFound> {
    let mut all = found.fit.state.effects.iter().zip(&found.named);
    let (form, named) = all.find(|(form, _)| is_form_of(form, active))?;
    let evidence = [named.evidence, named.held_out];
    FormFound::new(machine, form, active.effect.name, evidence)
}

/// The form at a place, where it is that of the axis' own dry friction.
pub(super) fn form_of_own(machine: &Axis, found: &Found, index: usize) -> Option<FormFound> {
    let all = &found.fit.state.effects;
    if all.iter().any(|active| is_form_of(&all[index], active)) {
        return None;
    }
    let evidence = [found.named[index].evidence, found.named[index].held_out];
    FormFound::new(
        machine,
        &all[index],
        "axis\u{2019} own dry friction",
        evidence,
    )
}

pub(super) fn refused_effects(refused: &Refused) -> RefusedEffects {
    let told = RefusedEffects {
        effects: refused.effects.iter().map(|n| n.name.to_owned()).collect(),
        ..RefusedEffects::default()
    };
    match &refused.reason {
        RefusalReason::Worse(channels) => RefusedEffects {
            channels: channels.iter().map(|&c| c.to_owned()).collect(),
            ..told
        },
        RefusalReason::Little(share) => RefusedEffects {
            takes_away: Some(*share),
            ..told
        },
        RefusalReason::Size(ratio) => RefusedEffects {
            size_on_check: Some(*ratio),
            ..told
        },
        RefusalReason::Law { over, law, .. } => RefusedEffects {
            law: match law {
                LawInPlace::Term(words) => Some((*words).to_owned()),
                LawInPlace::Curve { .. } => None,
            },
            law_over: Some(over.clone()),
            ..told
        },
    }
}

/// What stands in the place of a friction that was a form of the axis' own.
const OTHER_FORM: &str = "another form of the friction";

pub(super) fn replaced(replaced: &Replaced, scales: &Scales) -> ReplacedEffect {
    let ActiveEffect { effect, values } = &replaced.when_named;
    let one = |(p, &value): (&EffectParameter, &f64)| {
        (p.name.to_owned(), value, p.unit(scales).to_owned())
    };
    ReplacedEffect {
        name: effect.name.to_owned(),
        when_named: effect.parameters.iter().zip(values).map(one).collect(),
        by: match FrictionForm::is_one(replaced.by) {
            true => OTHER_FORM.to_owned(),
            false => replaced.by.to_owned(),
        },
    }
}

/// Friction acts at the table; its torque at the screw is what catalogues give. A motor without
/// transmission has no other place.
fn at_screw(machine: &Axis, value: f64, unit: &str) -> Option<AtScrew> {
    let r = machine.travel_per_radian();
    if r == 1.0 {
        return None;
    }
    let (factor, unit) = match unit {
        "N" => (r, "N*m"),
        "N*s/m" => (r * r, "N*m*s/rad"),
        _ => return None,
    };
    Some(AtScrew {
        value: value * factor,
        unit: unit.to_owned(),
    })
}
