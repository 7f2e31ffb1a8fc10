//! One case: logs made, search run blind, both kept.

use std::sync::Arc;

use axis_sim::ReplayError;
use axis_sim::effects::{ActiveEffect, Nature};
use discrepancy::{
    Found, Library, LogSet, Named, PredictedEffect, Proposal, SearchError, Settings,
    free_parameters, judged, search_with,
};

use super::bench::{Bench, active};
use super::case::Case;
use super::outcome::{CaseOutcome, NamedEffect, ScoredEstimate, Split};
use crate::hidden::{Hidden, Noise, exercise};

impl Bench {
    /// Runs a case of this bench's motion.
    pub fn try_case(&self, case: &Case) -> CaseOutcome {
        let case = &self.scaled(case);
        let predicted = self.predict(case);
        let runs = predicted.iter().all(Option::is_some);
        let nothing = PredictedEffect {
            gain: 0.0,
            above_noise: 0.0,
            detectable: false,
            class: Vec::new(),
            imitation: None,
        };
        let mut outcome = CaseOutcome {
            case: case.clone(),
            predicted: predicted
                .into_iter()
                .map(|f| f.unwrap_or_else(|| nothing.clone()))
                .collect(),
            failed: None,
            verdict: None,
            named: Vec::new(),
            estimates: Vec::new(),
            reduction: 0.0,
            check: Vec::new(),
            unknown: None,
            split: None,
        };
        if !runs {
            outcome.failed = Some("the axis does not run with the hidden effect".to_owned());
            return outcome;
        }
        if let Err(error) = self.run(case, &mut outcome) {
            outcome.failed = Some(error.to_string());
        }
        outcome
    }

    fn run(&self, case: &Case, outcome: &mut CaseOutcome) -> Result<(), SearchError> {
        let hidden = self.hidden(case);
        let logs = [self.logs(&hidden, false)?, self.logs(&hidden, true)?];
        let [fit, check] = &logs;
        let settings = Settings {
            rejected: case.rejected.clone(),
            ..Settings::default()
        };
        let library = self.prediction.library();
        let found = search_with(&self.machine, fit, check, &settings, library, |_| ())?;
        let told = judged(&self.machine, fit, check, &found)?;
        if let Some(proposal) = &told.proposal {
            outcome.split = self.split(&hidden, &logs, proposal)?;
        }
        let told = told.discovery;
        outcome.verdict = Some(told.verdict);
        outcome.reduction = told.gap.check.reduction;
        outcome.check.clone_from(&told.gap.check.channels);
        outcome.unknown = told.unknown.clone();
        outcome.named = named(&found);
        outcome.estimates = estimates(&found, &hidden.effects, &hidden.shares);
        Ok(())
    }

    /// Runs the proposed motion on the hidden machine and searches again, its log
    /// beside the old one, for the two rivals and what else is hidden. `None` where
    /// neither is hidden.
    fn split(
        &self,
        hidden: &Hidden,
        logs: &[LogSet; 2],
        proposal: &Proposal,
    ) -> Result<Option<Split>, SearchError> {
        let is_hidden = |name: &str| hidden.effects.iter().any(|h| h.effect.name == name);
        let Some(pair) = is_a_rival(proposal, is_hidden) else {
            return Ok(None);
        };
        let mut again = hidden.clone();
        again.seed = again.seed.wrapping_mul(2) + 7;
        let log = again.log(&self.axis, &proposal.program, 1)?;
        let [fit, check] = logs;
        let old = fit
            .logs
            .iter()
            .map(|l| (l.name.clone(), l.log.clone(), l.period));
        let new = ("proposed".to_owned(), log, self.axis.period);
        let both = LogSet::new(old.chain([new]).collect(), &self.machine)?;
        let library = Library::of_effects(&self.machine, &both, |e| {
            pair.contains(&e.name) || is_hidden(e.name)
        })?;
        let (settings, library) = (Settings::default(), Arc::new(library));
        let found = search_with(&self.machine, &both, check, &settings, library, |_| ())?;
        Ok(Some(Split {
            pair: pair.map(str::to_owned),
            predicted: proposal.separation,
            named: named(&found),
        }))
    }

    pub(super) fn hidden(&self, case: &Case) -> Hidden {
        let effects = case.hidden.iter().filter_map(active).collect();
        Hidden {
            effects,
            shares: Vec::new(),
            noise: Noise::good(&self.axis).scaled(case.noise),
            seed: case.seed,
        }
        .with_known_off_by(&self.axis, case.known_off)
    }

    fn logs(&self, hidden: &Hidden, check: bool) -> Result<LogSet, ReplayError> {
        let template = &self.templates[usize::from(check)];
        // The exercise fitted the axis when the bench was made.
        let Ok(motion) = exercise(&self.axis, self.exercise, check) else {
            return Ok(template.clone());
        };
        let mut hidden = hidden.clone();
        hidden.seed = hidden.seed.wrapping_mul(2) + u64::from(check);
        let log = hidden.log(&self.axis, &motion, 1)?;
        template.again(vec![log], &self.machine)
    }
}

/// The two effects that a motion is to separate, the hidden one first; `None` where not just
/// one of them is hidden.
pub(crate) fn is_a_rival(
    proposal: &Proposal,
    is_hidden: impl Fn(&str) -> bool,
) -> Option<[&'static str; 2]> {
    let [first, second] = proposal.pair.each_ref().map(|a| a.effect.name);
    match (is_hidden(first), is_hidden(second)) {
        (true, false) => Some([first, second]),
        (false, true) => Some([second, first]),
        _ => None,
    }
}

/// In the order of evidence.
pub(crate) fn named(found: &Found) -> Vec<NamedEffect> {
    let all = found.named.iter().zip(&found.fit.state.effects);
    let mut named: Vec<(&Named, &ActiveEffect)> = all.filter(|(n, _)| !n.is_form()).collect();
    named.sort_by(|(a, _), (b, _)| b.evidence.total_cmp(&a.evidence));
    let entry = |(n, active): (&Named, &ActiveEffect)| NamedEffect {
        name: n.name.to_owned(),
        alike: (n.alike.iter())
            .map(|a| a.fitted.effect.name.to_owned())
            .collect(),
        values: active.values.clone(),
        evidence: [n.evidence, n.held_out],
    };
    named.into_iter().map(entry).collect()
}

/// Parameters of hidden effects that were named, beside their truth; `shares` are those by
/// which known parameters are off.
pub(crate) fn estimates(
    found: &Found,
    hidden: &[ActiveEffect],
    shares: &[f64],
) -> Vec<ScoredEstimate> {
    let free = free_parameters(&found.fit.state);
    let known = found.fit.state.shares.len();
    let mut all = Vec::new();
    for (e, active) in found.fit.state.effects.iter().enumerate() {
        let same = |h: &&ActiveEffect| h.effect.name == active.effect.name;
        let Some(truth) = hidden.iter().find(same) else {
            continue;
        };
        for (p, spec) in active.effect.parameters.iter().enumerate() {
            let Some(at) = free.iter().position(|&f| f == (e, p)) else {
                continue;
            };
            let value = active.values[p];
            let half = found.half_width(known + at, value);
            let given = value + conditional(found, shares, known + at);
            let shift = same_phase(active, truth, p);
            all.push(ScoredEstimate {
                effect: active.effect.name.to_owned(),
                parameter: spec.name.to_owned(),
                size: spec.is_size(),
                truth: truth.values[p],
                value: shift(value),
                ci95: [shift(value) - half, shift(value) + half],
                given_known: shift(given),
            });
        }
    }
    all
}

/// By how much the mean of a parameter moves once the known ones are told.
fn conditional(found: &Found, truth: &[f64], at: usize) -> f64 {
    let known = known_of(found);
    let own = found.covariance.view((0, 0), (known, known)).into_owned();
    let shares = nalgebra::DVector::from_fn(known, |i, _| {
        truth.get(i).copied().unwrap_or(0.0) - found.fit.state.shares[i]
    });
    let cross = found.covariance.view((0, at), (known, 1)).into_owned();
    own.lu().solve(&shares).map_or(0.0, |s| cross.dot(&s))
}

fn known_of(found: &Found) -> usize {
    found.fit.state.shares.len()
}

/// An amplitude of one sign with a phase is that of the other sign with the
/// phase half a turn on: brings an estimate to the truth's way of saying it.
fn same_phase(found: &ActiveEffect, truth: &ActiveEffect, p: usize) -> impl Fn(f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let parameters = found.effect.parameters;
    let phase = parameters
        .iter()
        .position(|q| matches!(q.nature, Nature::Phase));
    let flipped = phase.is_some() && found.values[0] * truth.values[0] < 0.0;
    let is_phase = phase == Some(p);
    let target = truth.values[p];
    let has_phase = phase.is_some();
    move |value| {
        if is_phase {
            let turned = if flipped { value + PI } else { value };
            turned - TAU * ((turned - target) / TAU).round()
        } else if has_phase && flipped {
            -value
        } else {
            value
        }
    }
}
