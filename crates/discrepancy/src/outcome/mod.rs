//! What a discovery says: verdict, effects with intervals, gap before and after.

mod against;
mod cost;
mod form;
mod law;
mod likeness;
mod remedy;
mod told;
mod types;
mod units;
mod words;

use axis_sim::effects::{ActiveEffect, EffectParameter, Scales};
use axis_sim::{Axis, ReplayError};

pub use self::against::Against;
use self::against::against;
use self::cost::cost;
pub use self::cost::{Cost, EffortCost, Size, TrackingCost};
pub use self::form::FormFound;
pub use self::law::FrictionLaw;
use self::law::{friction_law, steady};
use self::likeness::likenesses;
pub use self::likeness::{Likeness, Shown};
pub use self::remedy::{DriveFunction, REMEDIES, Remedy};
use self::told::remedies;
pub use self::told::{Confidence, Level, RemedyTold, Told};
pub use self::types::{
    AtScrew, Discovery, EffectFound, Gaps, NextExperiment, ParameterFound, Recalibrated,
    RefusedEffects, ReplacedEffect, Verdict,
};
pub use self::units::ReadUnit;
pub use self::words::Answered;
use crate::experiment::{Proposal, propose};
use crate::fit::{Fitter, free_parameters};
use crate::gap::{ChannelGap, Gap, gap};
use crate::known::{shown, tolerances};
use crate::lack::{Curve, Unknown, lack};
use crate::model::{LogSet, Prepared, State, is_form_of};
use crate::noise::{Excess, Rest, excess, floors, log_noise};
use crate::search::{Found, MATERIAL, Reason, Refused, Replaced, is_form};

/// A search's result in words, figures and pictures.
#[derive(Clone, Debug)]
pub struct Discovered {
    /// Words and figures.
    pub discovery: Discovery,
    /// Pictures of the check logs.
    pub overlays: Vec<Overlay>,
    /// The check logs' rest against what each named effect depends on.
    pub against: Vec<Against>,
    /// Friction over speed; `None` where none was named.
    pub friction: Option<FrictionLaw>,
    /// The next experiment, with the values of both rivals.
    pub proposal: Option<Proposal>,
}

/// Measured, model before and after, for pictures: one channel of one log.
#[derive(Clone, Debug)]
pub struct Overlay {
    /// Log and channel.
    pub title: String,
    /// Name with unit.
    pub channel: String,
    /// s.
    pub time: Vec<f64>,
    /// Measured minus model, before.
    pub before: Vec<f64>,
    /// Measured minus model, after.
    pub after: Vec<f64>,
}

/// Share of the gap on check motion that named effects must take away to explain it.
const EXPLAINED: f64 = 0.9;

/// Share beyond which what is left is of no use to name: a fiftieth of the gap.
const NEARLY_ALL: f64 = 0.98;

/// Puts a search's result into words and figures.
///
/// # Errors
/// [`ReplayError`] where a simulation that ran before does not run again.
pub fn discovery(
    machine: &Axis,
    fit_logs: &LogSet,
    check_logs: &LogSet,
    found: &Found,
) -> Result<Discovered, ReplayError> {
    let mut told = judged(machine, fit_logs, check_logs, found)?;
    told.discovery.likenesses = likenesses(machine, found);
    Ok(told)
}

/// As [`discovery`], without what the logs can tell of effects that are not there: its
/// likenesses are empty, and it takes a fraction of the time.
///
/// # Errors
/// As [`discovery`].
pub fn judged(
    machine: &Axis,
    fit_logs: &LogSet,
    check_logs: &LogSet,
    found: &Found,
) -> Result<Discovered, ReplayError> {
    let initial = State::initial(machine);
    let full = &found.fit.state;
    // Before: as the file says. After: with the defects of the fitted machine.
    let before_of = |set: &LogSet| -> Result<Rest, ReplayError> {
        Ok(set.rest(&set.simulate(machine, &initial)?))
    };
    let fit = {
        let set = &found.fit_logs;
        let after = set.rest(&set.simulate(machine, full)?);
        let floors = floors(machine, set, full, &after)?;
        gap(set, &before_of(fit_logs)?, &after, &floors)
    };
    let set = &found.check_logs;
    let before = before_of(check_logs)?;
    let traces = set.simulate(machine, full)?;
    let after = set.rest(&traces);
    let check_floors = floors(machine, set, full, &after)?;
    let check = gap(set, &before, &after, &check_floors);

    let mut effects = Vec::new();
    let mut pictured = Vec::new();
    let mut each = Vec::new();
    let mut own_form = None;
    for (index, named) in found.named.iter().enumerate() {
        if is_form(&full.effects[index]) {
            own_form = own_form.or_else(|| form_of_own(machine, found, index));
            continue;
        }
        let mut other = full.clone();
        let taken = full.effects[index].effect;
        other.remove(index);
        let without = set.rest(&set.simulate(machine, &other)?);
        let lost = gap(set, &before, &without, &check_floors);
        each.push((taken.name.to_owned(), cost(machine, set, &without, &after)));
        // A friction over speed is shown as its law.
        if steady(&full.effects[index], 1.0).is_none() {
            pictured.extend(against(
                machine,
                set,
                &traces,
                taken,
                [&without, &after],
                &check_floors,
            ));
        }
        effects.push(effect_found(
            machine,
            found,
            index,
            named,
            (check.reduction - lost.reduction).clamp(0.0, 1.0),
        ));
    }
    effects.sort_by(|a, b| b.share_of_gap.total_cmp(&a.share_of_gap));

    let checker = Fitter {
        machine,
        set: check_logs,
    };
    let base = checker.at(found.base.state.clone())?;
    let at_floor = |gap: &Gap| gap.channels.iter().all(ChannelGap::is_at_floor);
    let largest = found.named.iter().map(|n| n.evidence).fold(0.0, f64::max);
    let unknown = match lack(machine, found, MATERIAL * largest)? {
        Some(unknown) => Some(unknown),
        // Beside effects that leave next to nothing, a rest without a curve is small change.
        None if check.reduction >= NEARLY_ALL && !effects.is_empty() => None,
        None => excess(machine, set, full, &traces)?.map(in_frequency),
    };
    let nearly_all = check.reduction >= NEARLY_ALL && !effects.is_empty();
    let rest_significant = !(at_floor(&check) || nearly_all) || unknown.is_some();
    let verdict = match (effects.is_empty(), rest_significant) {
        _ if found.refused.is_some() => Verdict::Unknown,
        (true, false) => Verdict::NothingMissing,
        (true, true) => Verdict::Unknown,
        (false, false) if check.reduction >= EXPLAINED => Verdict::Explained,
        (false, _) => Verdict::PartlyExplained,
    };
    let proposal = match log_noise(machine, &found.fit_logs, full, &found.fit.traces) {
        Some(noise) => propose(machine, found, &noise)?,
        None => None,
    };
    let name = machine.name.clone();
    let recalibrated: Vec<Recalibrated> = (machine.known().into_iter())
        .zip(&full.shares)
        .zip(tolerances(machine))
        .map(|((name, &share), tolerance)| Recalibrated {
            name: shown(name),
            share,
            tolerance,
        })
        .collect();
    let refused = found.refused.as_ref().map(refused_effects);
    let told = Told {
        cost: whole_cost(machine, set, full, &after, &each)?,
        each: if each.len() > 1 { each } else { Vec::new() },
        confidence: Confidence::new(verdict, &effects, &recalibrated),
        remedies: remedies(&effects),
    };
    let friction = friction_law(machine, set, full, &traces, &after);
    let overlays = overlays(check_logs, &check_logs.rest(&base.traces), &after);
    let discovery = Discovery {
        schema: 1,
        axis: name,
        answer: found.fit_logs.answer().to_owned(),
        notes: notes(machine, found),
        sentence: sentence(
            verdict,
            &effects,
            &check,
            unknown.as_ref(),
            refused.as_ref(),
            own_form.as_ref(),
        ),
        verdict,
        effects,
        own_form,
        replaced: {
            let scales = Scales::of(machine);
            let all = found.replaced.iter();
            all.map(|r| replaced(r, &scales)).collect()
        },
        refused,
        not_added: found
            .leftover
            .iter()
            .map(|r| (r.name.to_owned(), r.gain))
            .collect(),
        unknown,
        gap: Gaps { fit, check },
        recalibrated,
        told,
        likenesses: Vec::new(),
        next_experiment: proposal.as_ref().map(next_experiment),
    };
    Ok(Discovered {
        discovery,
        overlays,
        against: pictured,
        friction,
        proposal,
    })
}

/// What all that was named costs together; `each` is what each costs alone.
fn whole_cost(
    machine: &Axis,
    set: &LogSet,
    full: &State,
    after: &Rest,
    each: &[(String, Cost)],
) -> Result<Cost, ReplayError> {
    match each {
        [] => Ok(cost(machine, set, after, after)),
        [(_, only)] if full.effects.len() == 1 => Ok(only.clone()),
        _ => {
            let bare = State {
                shares: full.shares.clone(),
                effects: Vec::new(),
            };
            let without = set.rest(&set.simulate(machine, &bare)?);
            Ok(cost(machine, set, &without, after))
        }
    }
}

fn next_experiment(proposal: &Proposal) -> NextExperiment {
    NextExperiment {
        what: proposal.what.to_owned(),
        separates: proposal.pair.each_ref().map(|a| a.effect.name.to_owned()),
        by: proposal.separation,
        program: proposal.program.clone(),
    }
}

/// What is known of a rest that shows in no curve over the motion.
fn in_frequency(excess: Excess) -> Unknown {
    let ([low, high], _) = excess.bands[excess.worst];
    let middles = excess
        .bands
        .iter()
        .map(|([low, high], _)| 0.5 * (low + high));
    let values: Vec<f64> = excess.bands.iter().map(|(_, v)| *v).collect();
    Unknown {
        channel: "rest of all channels together".to_owned(),
        depends_on: format!("frequency, most from {low:.0} to {high:.0} Hz"),
        formula: None,
        curve: Curve {
            variable: "frequency, Hz".to_owned(),
            unit: "times the power of the noise".to_owned(),
            at: middles.collect(),
            within: vec![0.0; values.len()],
            value: values,
        },
        evidence: [0.0, excess.fall],
    }
}

fn effect_found(
    machine: &Axis,
    found: &Found,
    index: usize,
    named: &crate::search::Named,
    share_of_gap: f64,
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
        share_of_gap,
        evidence: [named.evidence, named.held_out],
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
fn form_of_own(machine: &Axis, found: &Found, index: usize) -> Option<FormFound> {
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

/// What must be known of the logs.
fn notes(machine: &Axis, found: &Found) -> Vec<String> {
    let sets = [&found.fit_logs, &found.check_logs];
    let mut notes: Vec<String> = sets.iter().flat_map(|set| set.notes()).collect();
    if !notes.is_empty() {
        notes.push(FLOOR.to_owned());
    }
    notes.extend(slack_notes(machine, found));
    notes
}

/// How the noise of a torque balance is to be read.
const FLOOR: &str = "the noise given of a torque balance is the least that the spectra of torque and motion leave possible, as no controller is known: a rest above it may be noise";

/// Where a gap is so large that the logs do not say where the screw lay in it at their
/// start.
fn slack_notes(machine: &Axis, found: &Found) -> Vec<String> {
    let effects = [&machine.effects[..], &found.fit.state.effects].concat();
    let left = [&found.fit_logs, &found.check_logs].map(|set| set.slack_left(&effects));
    let note = |(gap, log): (f64, &Prepared)| {
        format!(
            "{} counts from where its reference has moved by {:.3e} m; of a gap of {gap:.3e} m that takes up a part, and the screw\u{2019}s place in the rest is not known: record a longer first move",
            log.name, log.taken_up
        )
    };
    left.into_iter().flatten().map(note).collect()
}

fn refused_effects(refused: &Refused) -> RefusedEffects {
    RefusedEffects {
        effects: refused.effects.iter().map(|n| n.name.to_owned()).collect(),
        channels: match &refused.reason {
            Reason::Worse(channels) => channels.iter().map(|&c| c.to_owned()).collect(),
            Reason::Little(_) => Vec::new(),
        },
        takes_away: match refused.reason {
            Reason::Little(share) => Some(share),
            Reason::Worse(_) => None,
        },
    }
}

fn replaced(replaced: &Replaced, scales: &Scales) -> ReplacedEffect {
    let ActiveEffect { effect, values } = &replaced.when_named;
    let one = |(p, &value): (&EffectParameter, &f64)| {
        (p.name.to_owned(), value, p.unit(scales).to_owned())
    };
    ReplacedEffect {
        name: effect.name.to_owned(),
        when_named: effect.parameters.iter().zip(values).map(one).collect(),
        by: replaced.by.to_owned(),
    }
}

/// Friction acts at the table; its torque at the screw is what catalogues give.
fn at_screw(machine: &Axis, value: f64, unit: &str) -> Option<AtScrew> {
    let r = machine.travel_per_radian();
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

fn overlays(set: &LogSet, before: &Rest, after: &Rest) -> Vec<Overlay> {
    let mut all = Vec::new();
    for (l, log) in set.logs.iter().enumerate() {
        for (c, name) in set.channels.iter().enumerate() {
            all.push(Overlay {
                title: format!("{}: {name}", log.name),
                channel: (*name).to_owned(),
                time: log.log.time().to_vec(),
                before: before[l][c].clone(),
                after: after[l][c].clone(),
            });
        }
    }
    all
}

fn sentence(
    verdict: Verdict,
    effects: &[EffectFound],
    check: &Gap,
    unknown: Option<&Unknown>,
    refused: Option<&RefusedEffects>,
    own_form: Option<&FormFound>,
) -> String {
    let names: Vec<String> = effects
        .iter()
        .map(|e| match e.indistinguishable_from.as_slice() {
            [] => e.name.clone(),
            others => format!(
                "{} (or {}: these logs cannot tell)",
                e.name,
                others.join(", ")
            ),
        })
        .collect();
    let forms = effects
        .iter()
        .filter_map(|e| e.form.as_ref())
        .chain(own_form);
    let forms: String = forms.map(FormFound::sentence).collect();
    let it = if names.len() == 1 { "it" } else { "them" };
    let names = names.join("; ");
    let gone = 100.0 * check.reduction;
    let place = unknown.map_or(String::new(), |u| {
        let formula = u
            .formula
            .as_ref()
            .map_or(String::new(), |f| format!(": {f}"));
        format!(
            " It sits in the {} and depends on {}{formula}.",
            u.channel, u.depends_on
        )
    });
    match verdict {
        Verdict::NothingMissing => format!(
            "Nothing is missing: the model and the logs agree to the noise, with known parameters inside their tolerance.{forms}"
        ),
        Verdict::Explained => format!(
            "The model lacks {names}. With {it}, {gone:.1} % of the gap above the noise is gone on motion that it was not fitted to.{forms}"
        ),
        Verdict::PartlyExplained => format!(
            "Partly explained: with {names}, {gone:.1} % of the gap above the noise is gone on motion that it was not fitted to, and a rest remains that is not named.{place} What is named may stand for something that is not in the library.{forms}"
        ),
        Verdict::Unknown => {
            let refused = refused.map_or(String::new(), RefusedEffects::sentence);
            format!(
                "Unknown: the model and the logs disagree, and no effect of the library explains it.{place}{refused}{forms}"
            )
        }
    }
}
