//! One case: logs made, searched blind, and what was hidden kept beside what was said.

use axis_log::Log;
use axis_sim::ReplayError;
use discrepancy::{
    Discovered, Fitter, Found, LogSet, PredictedEffect, Proposal, SearchError, Settings, State,
    judged, search, search_with,
};

use super::bench::Bench;
use super::case::Case;
use super::outcome::{CaseOutcome, Deviance};
use crate::hidden::Truth;
use crate::matrix::{Split, estimates, is_a_rival, named};

/// A case as it is given to whoever is to find what is hidden, beside the truth.
#[derive(Clone, Debug)]
pub struct Given {
    /// The case, its sizes scaled.
    pub case: Case,
    /// What can be known of each hidden effect beforehand; `None` of one that does not run on
    /// the machine as its file says.
    pub predicted: Vec<Option<PredictedEffect>>,
    /// Shares by which known parameters are off, in the order of [`axis_sim::Axis::known`].
    pub shares: Vec<f64>,
    /// Logs to fit to and to check on, with the channels that the case shows.
    pub logs: [Log; 2],
    /// Time between their samples, s.
    pub period: f64,
}

impl Bench {
    /// The logs of a case of this bench's plot, as [`Bench::try_case`] searches them.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run.
    pub fn given(&self, case: &Case) -> Result<Given, ReplayError> {
        let (case, predicted) = self.predicted(case)?;
        let truth = self.truth(&case);
        let shown = |place: usize| -> Result<Log, ReplayError> {
            Ok(self.setting.channels.of(&self.log(&truth, place)?)?)
        };
        Ok(Given {
            logs: [shown(0)?, shown(1)?],
            shares: truth.shares,
            period: self.every as f64 * self.axis.period,
            case,
            predicted,
        })
    }

    /// Runs a case of this bench's plot. What cannot be run is said in
    /// [`CaseOutcome::failed`].
    pub fn try_case(&self, case: &Case) -> CaseOutcome {
        let mut outcome = CaseOutcome::of(case);
        if let Err(error) = self.run(case, &mut outcome) {
            outcome.failed = Some(error.to_string());
        }
        outcome
    }

    fn run(&self, case: &Case, outcome: &mut CaseOutcome) -> Result<(), SearchError> {
        let (case, predicted) = self.predicted(case)?;
        outcome.case = case.clone();
        let runs: Option<Vec<_>> = predicted.into_iter().collect();
        let Some(predicted) = runs else {
            outcome.failed = Some("the axis does not run with the hidden effect".to_owned());
            return Ok(());
        };
        outcome.predicted = predicted;
        let truth = self.truth(&case);
        let logs = [self.logs(&truth, 0)?, self.logs(&truth, 1)?];
        let [fit, check] = &logs;
        let settings = Settings {
            rejected: case.rejected.clone(),
            ..Settings::default()
        };
        let found = match &self.prediction {
            Some(prediction) => {
                let library = prediction.library();
                search_with(&self.machine, fit, check, &settings, library, |_| ())?
            }
            None => search(&self.machine, fit, check, &settings, |_| ())?,
        };
        let told = judged(&self.machine, fit, check, &found)?;
        self.keep(&case, &truth, &found, &told, outcome);
        outcome.deviance = self.deviance(&truth, &found);
        if let Some(proposal) = &told.proposal {
            outcome.split = self.split(&case, &truth, &logs, proposal)?;
        }
        Ok(())
    }

    fn keep(
        &self,
        case: &Case,
        truth: &Truth,
        found: &Found,
        told: &Discovered,
        outcome: &mut CaseOutcome,
    ) {
        let told = &told.discovery;
        let hidden = &truth.effects[..case.hidden.len().min(truth.effects.len())];
        outcome.verdict = Some(told.verdict);
        outcome.reduction = told.gap.check.reduction;
        outcome.unknown.clone_from(&told.unknown);
        outcome.named = named(found);
        outcome.estimates = estimates(found, hidden, &self.as_known(&truth.shares));
        let own = told.own_form.as_ref().map(|_| "own".to_owned());
        let formed = told.effects.iter().filter(|e| e.form.is_some());
        outcome.forms = own
            .into_iter()
            .chain(formed.map(|e| e.name.clone()))
            .collect();
    }

    /// Shares of the machine's known parameters in the order of those that a search knows, which without a
    /// control has some of its own.
    fn as_known(&self, shares: &[f64]) -> Vec<f64> {
        let names = self.axis.known();
        let all = self.machine.known().into_iter();
        let place = |name| names.iter().position(|n| *n == name);
        let share = |name| place(name).and_then(|k| shares.get(k).copied());
        all.map(|name| share(name).unwrap_or(0.0)).collect()
    }

    /// `None` where a machine does not run.
    fn deviance(&self, truth: &Truth, found: &Found) -> Option<Deviance> {
        let fitter = Fitter {
            machine: &self.machine,
            set: &found.fit_logs,
        };
        let nominal = State::initial(&self.machine);
        let of = |shares: &[f64]| {
            let mut state = nominal.clone();
            state.shares.copy_from_slice(shares);
            fitter.at(state).ok()
        };
        let shares = self.as_known(&truth.shares);
        let effects = truth.effects.clone();
        let truth = fitter.at(State { shares, effects }).ok()?;
        let known = fitter.known_columns(&truth);
        let truth = fitter.refine(truth, &known, 4).deviance;
        // A force outside the library may feed on itself along a measured motion.
        truth.is_finite().then_some(Deviance {
            as_filed: of(&nominal.shares)?.deviance,
            calibrated: of(&found.base.state.shares)?.deviance,
            found: found.fit.deviance,
            truth,
            needed: found.needed(),
        })
    }

    fn logs(&self, truth: &Truth, place: usize) -> Result<LogSet, ReplayError> {
        self.set(place, &self.log(truth, place)?)
    }

    /// With all channels.
    fn log(&self, truth: &Truth, place: usize) -> Result<Log, ReplayError> {
        let mut truth = truth.clone();
        truth.seed = truth.seed.wrapping_mul(2) + place as u64;
        truth.log(&self.axis, &self.motions[place], self.every)
    }

    /// Runs the proposed motion on the hidden machine and searches both logs with the whole
    /// library. `None` where not just one of the two rivals is hidden.
    fn split(
        &self,
        case: &Case,
        truth: &Truth,
        [fit, check]: &[LogSet; 2],
        proposal: &Proposal,
    ) -> Result<Option<Split>, SearchError> {
        let is_hidden = |name: &str| case.hidden.iter().any(|h| h.name == name);
        let Some(pair) = is_a_rival(proposal, is_hidden) else {
            return Ok(None);
        };
        let mut again = truth.clone();
        again.seed = again.seed.wrapping_mul(2) + 7;
        let log = again.log(&self.axis, &proposal.program, self.every)?;
        let log = self.setting.channels.of(&log).map_err(ReplayError::from)?;
        let period = self.every as f64 * self.axis.period;
        let old = fit
            .logs
            .iter()
            .map(|l| (l.name.clone(), l.log.clone(), l.period));
        let both = old.chain([("proposed".to_owned(), log, period)]).collect();
        let both = LogSet::new(both, &self.machine)?;
        let settings = Settings {
            rejected: case.rejected.clone(),
            ..Settings::default()
        };
        let found = search(&self.machine, &both, check, &settings, |_| ())?;
        Ok(Some(Split {
            pair: pair.map(str::to_owned),
            predicted: proposal.separation,
            named: named(&found),
        }))
    }
}
