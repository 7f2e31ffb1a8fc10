//! What a discovery says: verdict, effects with intervals, gap before and after.

mod against;
mod assess;
mod assessment;
mod compared;
mod cost;
mod experiment;
mod form;
mod found;
mod law;
mod left;
mod likeness;
mod motions;
mod named;
mod notes;
mod overlay;
mod recalibrated;
mod remainder;
mod remedy;
mod sentence;
mod term;
mod types;
mod units;
mod unknown;
mod words;

use axis_sim::effects::Scales;
use axis_sim::{Axis, ReplayError};

pub use self::against::Against;
use self::assess::remedies;
pub use self::assessment::{Assessment, Confidence, Level, RemedyFound};
use self::compared::Compared;
use self::cost::whole_cost;
pub use self::cost::{Cost, EffortCost, Size, TrackingCost};
pub use self::experiment::Proposal;
use self::experiment::propose;
pub use self::form::FormFound;
use self::found::{refused_effects, replaced};
pub use self::law::FrictionCurve;
use self::law::friction_law;
use self::likeness::likenesses;
pub use self::likeness::{Likeness, Shown};
use self::named::NamedEffects;
use self::notes::all_notes;
pub use self::overlay::Overlay;
use self::overlay::overlays;
pub use self::recalibrated::Recalibrated;
use self::recalibrated::recalibrated;
use self::remainder::Remainder;
pub use self::remedy::{DriveFunction, REMEDIES, Remedy};
use self::sentence::sentence;
pub use self::types::{
    AtScrew, Discovery, EffectFound, FigureLogs, Gaps, NextExperiment, ParameterFound,
    RefusedEffects, ReplacedEffect, Verdict, said_evidence,
};
pub use self::units::ReadUnit;
pub use self::unknown::{Curve, Unknown};
pub use self::words::Answered;
use crate::answers::LogSet;
use crate::name::search::Found;
use crate::noise::log_noise;

/// A search's result in words, figures and pictures.
#[derive(Clone, Debug)]
pub struct Discovered {
    /// Words and figures.
    pub discovery: Discovery,
    /// Pictures of the check logs.
    pub overlays: Vec<Overlay>,
    /// The check logs' rest against what each named effect depends on.
    pub against: Vec<Against>,
    /// Friction over speed; `None` if none was named.
    pub friction: Option<FrictionCurve>,
    /// The next experiment, with the values of both rivals.
    pub proposal: Option<Proposal>,
}

/// Puts a search's result into words and figures. These are of the logs that took no part
/// in the search, where there are such ([`Found::tested_on`]), or else of the check logs.
///
/// # Errors
/// [`ReplayError`] if a simulation that ran before does not run again.
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
    let compared = Compared::new(machine, [fit_logs, check_logs], found)?;
    let mut named = NamedEffects::of(&compared)?;
    let remainder = Remainder::of(&compared, &named)?;
    let verdict = remainder.verdict(&named);
    let full = compared.state();
    let Compared {
        set, traces, after, ..
    } = &compared;
    let recalibrated = recalibrated(machine, found);
    let refused = remainder.refused.map(refused_effects);
    let each = std::mem::take(&mut named.each);
    let assessment = Assessment {
        cost: whole_cost(machine, set, full, after, &each)?,
        each: if each.len() > 1 { each } else { Vec::new() },
        confidence: Confidence::new(
            verdict,
            &named.effects,
            &recalibrated,
            remainder.is_slow_of_loop,
        ),
        remedies: remedies(&named.effects),
        controller: None,
    };
    let noise = log_noise(machine, &found.fit_logs, full, &found.fit.traces);
    let proposal = noise.and_then(|noise| propose(machine, found, &noise));
    let scales = Scales::of(machine);
    let leftover = found.leftover.iter();
    let discovery = Discovery {
        schema: Discovery::SCHEMA,
        axis: machine.name.clone(),
        answer: found.fit_logs.answer_of(machine).to_owned(),
        notes: all_notes(&compared, &remainder)?,
        sentence: sentence(
            verdict,
            &named.effects,
            &remainder.gap,
            remainder.unknown.as_ref(),
            refused.as_ref(),
            named.own_form.as_ref(),
        ),
        verdict,
        effects: named.effects,
        own_form: named.own_form,
        replaced: (found.replaced.iter())
            .map(|r| replaced(r, &scales))
            .collect(),
        refused,
        not_added: leftover.map(|r| (r.name.to_owned(), r.gain)).collect(),
        unknown: remainder.unknown,
        gap: Gaps {
            fit: compared.fit_gap.clone(),
            check: remainder.gap,
        },
        figures: FigureLogs::of(found, set),
        recalibrated,
        assessment,
        likenesses: Vec::new(),
        next_experiment: proposal.as_ref().map(NextExperiment::new),
    };
    Ok(Discovered {
        discovery,
        overlays: overlays(&compared.as_filed, &remainder.of_base, after),
        against: named.pictured,
        friction: friction_law(machine, set, full, traces, after),
        proposal,
    })
}
