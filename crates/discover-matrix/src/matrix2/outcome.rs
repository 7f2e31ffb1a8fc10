//! What came out of a case.

use discrepancy::{PredictedEffect, Unknown, Verdict};
use serde::{Deserialize, Serialize};

use super::case::Case;
use crate::matrix::{NamedEffect, ScoredEstimate, Split};

/// What came out of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseOutcome {
    /// The case, its sizes scaled.
    pub case: Case,
    /// What could be known beforehand, one entry a hidden effect.
    #[serde(alias = "foreseen")]
    pub predicted: Vec<PredictedEffect>,
    /// Why there is no verdict, where there is none.
    pub failed: Option<String>,
    /// Verdict.
    pub verdict: Option<Verdict>,
    /// Effects named, in the order of evidence.
    pub named: Vec<NamedEffect>,
    /// Frictions of which it was said that their law has another form; the axis' own by
    /// `own`.
    pub forms: Vec<String>,
    /// Parameters of those that were hidden and named.
    pub estimates: Vec<ScoredEstimate>,
    /// Share of the gap on check motion that is gone.
    pub reduction: f64,
    /// What was found that is outside the library.
    pub unknown: Option<Unknown>,
    /// D of the fitted logs: with the truth, and with what was found.
    pub deviance: Option<Deviance>,
    /// The experiment that was proposed, run, and searched with the whole library.
    pub split: Option<Split>,
}

impl CaseOutcome {
    /// Of a case that cannot be run, and why.
    pub fn failed(case: &Case, why: String) -> Self {
        Self {
            failed: Some(why),
            ..Self::of(case)
        }
    }

    /// Of a case that is not run yet.
    pub(super) fn of(case: &Case) -> Self {
        Self {
            case: case.clone(),
            predicted: Vec::new(),
            failed: None,
            verdict: None,
            named: Vec::new(),
            forms: Vec::new(),
            estimates: Vec::new(),
            reduction: 0.0,
            unknown: None,
            deviance: None,
            split: None,
        }
    }
}

/// D of the fitted logs, with their departures of known parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Deviance {
    /// Of the machine as its file says.
    pub as_filed: f64,
    /// Of its known parameters fitted.
    pub calibrated: f64,
    /// Of what was found.
    pub found: f64,
    /// Of the truth, fitted from there: where it is far below what was found, the search did
    /// not come there; where it is not, these logs speak for something else as well.
    pub truth: f64,
    /// Fall that naming an effect takes.
    pub needed: f64,
}
