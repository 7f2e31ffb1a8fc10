//! What a discovery says: verdict, effects with intervals, gap before and after.

mod against;
mod assess;
mod assessment;
mod cost;
mod experiment;
mod form;
mod found;
mod law;
mod left;
mod likeness;
mod motions;
mod notes;
mod overlay;
mod recalibrated;
mod remedy;
mod sentence;
mod term;
mod types;
mod units;
mod unknown;
mod words;

use std::borrow::Cow;

use axis_sim::effects::Scales;
use axis_sim::{Axis, ReplayError};

pub use self::against::Against;
use self::against::against;
use self::assess::remedies;
pub use self::assessment::{Assessment, Confidence, Level, RemedyFound};
pub use self::cost::{Cost, EffortCost, Size, TrackingCost};
use self::cost::{cost, whole_cost};
pub use self::experiment::Proposal;
use self::experiment::propose;
pub use self::form::FormFound;
use self::found::{effect_found, form_of_own, refused_effects, replaced};
pub use self::law::FrictionCurve;
use self::law::{friction_law, steady};
use self::left::Left;
use self::likeness::likenesses;
pub use self::likeness::{Likeness, Shown};
use self::notes::{above_noise_note, faster_notes, notes, slow_of_loop_note};
pub use self::overlay::Overlay;
use self::overlay::overlays;
pub use self::recalibrated::Recalibrated;
pub use self::remedy::{DriveFunction, REMEDIES, Remedy};
use self::sentence::sentence;
pub use self::types::{
    AtScrew, Discovery, EffectFound, FigureLogs, Gaps, NextExperiment, ParameterFound,
    RefusedEffects, ReplacedEffect, Verdict, said_evidence,
};
pub use self::units::ReadUnit;
pub use self::unknown::{Curve, Unknown};
use self::unknown::{in_frequency, lack};
pub use self::words::Answered;
use crate::answers::Rest;
use crate::answers::{LogSet, State};
use crate::estimate::fit::Fitter;
use crate::estimate::known::{shown, tolerances};
use crate::name::gap::{furthest_above, gap, is_more_than_noise, sizes};
use crate::name::search::{Found, MATERIAL, Refused, is_form};
use crate::noise::{
    Excess, Hum, MotionAndRest, excess, floors, log_noise, slow_noise, stays, steady_bands,
};

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

/// Share of the gap on check motion that named effects must take away to explain it.
const EXPLAINED: f64 = 0.9;

/// Share beyond which the residual is of no use to name: a fiftieth of the gap.
const NEARLY_ALL: f64 = 0.98;

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
    let initial = State::initial(machine);
    let full = &found.fit.state;
    // Before: as the file says. After: with the defects of the fitted machine.
    let before_of = |set: &LogSet| -> Result<Rest, ReplayError> {
        Ok(set.rest(&set.simulate(machine, &initial)?))
    };
    let (fit, fit_above) = {
        let set = &found.fit_logs;
        let traces = set.simulate(machine, full)?;
        let after = set.rest(&traces);
        let slow = slow_noise(machine, set, full, &traces)?;
        let floors = slow.beside_floors(set, floors(machine, set, full, &after)?);
        let as_filed = Hum::as_in(set, fit_logs);
        let above = furthest_above(set, &after, &floors);
        (gap(set, &before_of(&as_filed)?, &after, &floors), above)
    };
    let (as_filed, set) = match &found.test {
        Some(test) => (Cow::Borrowed(&test.as_filed), &test.fitted),
        None => {
            let set = &found.check_logs;
            (Cow::Owned(Hum::as_in(set, check_logs)), set)
        }
    };
    let as_filed = as_filed.as_ref();
    let before = before_of(as_filed)?;
    let traces = set.simulate(machine, full)?;
    let after = set.rest(&traces);
    let slow = slow_noise(machine, set, full, &traces)?;
    let fitted = (&found.fit_logs, found.fit.traces.as_slice());
    let floors = slow.beside_floors(set, floors(machine, set, full, &after)?);
    let check_above = furthest_above(set, &after, &floors);
    let rests = [&before, &after];
    let left = Left::of(machine, full, fitted, (set, &traces), rests, floors, &slow)?;
    let (check, check_floors, loop_noise) = (left.gap, left.floors, left.loop_noise);

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
        set: as_filed,
    };
    let base = checker.at(found.base.state.clone())?;
    let largest = found.named.iter().map(|n| n.evidence).fold(0.0, f64::max);
    let nearly_all = check.reduction >= NEARLY_ALL && !effects.is_empty();
    let lack = lack(machine, found, MATERIAL * largest)?;
    let note_of_loop = loop_noise.as_ref().and_then(|n| n.note(machine));
    let is_coloured = loop_noise.is_some();
    let noise = loop_noise.or_else(|| log_noise(machine, set, full, &traces));
    let excess = match (&lack, &noise) {
        // Beside effects that leave next to nothing, a residual without a curve is small change.
        (None, Some(noise)) if !nearly_all => excess(machine, set, full, &traces, noise, &slow)?,
        _ => None,
    };
    // A residual that is neither a curve over the motion nor follows it is noise, whatever its
    // colour; but it may be what an imitation leaves of a gap, be that a form of friction.
    let imitates = !effects.is_empty() && check.stands_out();
    let is_small = match found.named.is_empty() {
        true => check.may_be_noise_apart_from_motion(),
        false => check.may_be_coloured(),
    };
    let may_be_noise = !set.is_balanced() && is_small && !imitates;
    let following = excess.as_ref().and_then(|excess| {
        if !may_be_noise {
            return Some(excess.clone());
        }
        let rest = MotionAndRest::new(fitted, (set, &traces));
        // A larger one must be there while the axis stands, too.
        let is_large = !check.may_be_coloured();
        let is_steady = is_large.then(|| steady_bands(machine, full, (set, &traces)));
        let comes_with_motion = |band| is_steady.as_ref().is_some_and(|steady| !steady(band));
        let stays = stays([fitted, (set, &traces)]);
        excess.only(|band| rest.follows(band) || comes_with_motion(band) || stays && band[0] == 0.0)
    });
    let coloured = excess.filter(|_| following.is_none());
    // Of a balance nobody knows what the controller makes of its sensors' noise: slow, it is above
    // the floor, and what curves take of it does not hold on other logs.
    let of_base = as_filed.rest(&base.traces);
    let without = match effects.is_empty() {
        true => sizes(set, &after),
        false => sizes(set, &of_base),
    };
    let as_noise = check.taken_for_noise(&without).filter(|_| lack.is_none());
    let slow_of_loop = as_noise.is_some() && !check.is_at_floor();
    let check = as_noise.unwrap_or(check);
    let unknown = lack.or_else(|| following.map(in_frequency));
    let as_coloured = is_coloured && unknown.is_none();
    let is_noise = check.is_at_floor() || coloured.is_some() || slow_of_loop || as_coloured;
    // That nothing is missing has to hold of every log, of those that were fitted as well: there is no more noise
    // in them than the check logs show, but for what differs from log to log.
    let of_check = check_above.map_or(0.0, |(_, times)| times);
    let more_than_noise = fit_above
        .filter(|(_, times)| is_more_than_noise(*times, of_check))
        .filter(|_| effects.is_empty() && own_form.is_none());
    let rest_significant =
        !(is_noise || nearly_all) || unknown.is_some() || more_than_noise.is_some();
    // What takes away little of a residual that is noise was fitted to noise.
    let refused = found.refused.as_ref();
    let is_of_noise =
        |refused: &&Refused| as_coloured || slow_of_loop && refused.effects.is_empty();
    let refused = refused.filter(|refused| !(effects.is_empty() && is_of_noise(refused)));
    let verdict = match (effects.is_empty(), rest_significant) {
        (true, _) if refused.is_some() => Verdict::Unknown,
        (true, false) if own_form.is_some() && check.stands_out() => Verdict::OtherForm,
        (true, false) => Verdict::NothingMissing,
        (true, true) => Verdict::Unknown,
        // What was refused beside what is named is a residual that has no name.
        _ if refused.is_some() => Verdict::PartlyExplained,
        // No share of a gap can be asked for where none stood out.
        (false, false) if check.reduction >= EXPLAINED || !check.stands_out() => Verdict::Explained,
        (false, _) => Verdict::PartlyExplained,
    };
    let noise = log_noise(machine, &found.fit_logs, full, &found.fit.traces);
    let proposal = noise.and_then(|noise| propose(machine, found, &noise));
    let name = machine.name.clone();
    let recalibrated: Vec<Recalibrated> = (machine.known().into_iter())
        .zip(&full.shares)
        .zip(tolerances(machine))
        .zip(machine.known_angles())
        .map(|(((name, &share), tolerance), is_angle)| Recalibrated {
            name: shown(name),
            share,
            tolerance,
            is_angle,
        })
        .collect();
    let refused = refused.map(refused_effects);
    let assessment = Assessment {
        cost: whole_cost(machine, set, full, &after, &each)?,
        each: if each.len() > 1 { each } else { Vec::new() },
        confidence: Confidence::new(verdict, &effects, &recalibrated, slow_of_loop),
        remedies: remedies(&effects),
        controller: None,
    };
    let friction = friction_law(machine, set, full, &traces, &after);
    let overlays = overlays(as_filed, &of_base, &after);
    let discovery = Discovery {
        schema: Discovery::SCHEMA,
        axis: name,
        answer: found.fit_logs.answer_of(machine).to_owned(),
        notes: {
            let coloured = coloured.iter().map(Excess::note);
            let slow_of_loop = slow_of_loop.then(|| slow_of_loop_note(&check));
            let faster = faster_notes(machine, found, set, &traces);
            let known = [
                notes(machine, found)?,
                faster,
                slow.notes(set),
                found.hum.notes(),
            ]
            .concat();
            let above =
                more_than_noise.map(|(log, times)| above_noise_note(&found.fit_logs, log, times));
            let known = known.into_iter().chain(note_of_loop).chain(above);
            let of_rest = coloured.chain(slow_of_loop);
            known.chain(of_rest).collect()
        },
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
        figures: FigureLogs::of(found, set),
        recalibrated,
        assessment,
        likenesses: Vec::new(),
        next_experiment: proposal.as_ref().map(NextExperiment::new),
    };
    Ok(Discovered {
        discovery,
        overlays,
        against: pictured,
        friction,
        proposal,
    })
}
