//! What could be known of a case, and what came out of it.

use discrepancy::{ChannelGap, PredictedEffect, Unknown, Verdict};
use serde::{Deserialize, Serialize};

use super::case::Case;

/// An estimate beside the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScoredEstimate {
    /// Effect.
    pub effect: String,
    /// Parameter.
    pub parameter: String,
    /// Whether it is a size.
    pub size: bool,
    /// Truth.
    pub truth: f64,
    /// Estimate.
    pub value: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
    /// What the estimate would be, had the known parameters been told: its
    /// mean given their true values, in the estimate's own Gaussian. Where a
    /// hidden effect and a known parameter are one and the same quantity (a
    /// payload on a table whose mass is known to 1 %), no log tells more.
    pub given_known: f64,
}

/// An effect as the search named it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedEffect {
    /// Name.
    pub name: String,
    /// Effects that it said these logs cannot tell from it.
    pub alike: Vec<String>,
    /// Its parameters, in the order of the effect's.
    pub values: Vec<f64>,
    /// Fall of D that it brings, on the fit logs and, when it was named, on the check logs.
    pub evidence: [f64; 2],
}

/// What a proposed experiment did for a class: the search once more, with its log
/// beside the old one and, in the library, the two rivals and what else is hidden.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Split {
    /// The pair that it was to separate, the hidden one first.
    pub pair: [String; 2],
    /// PredictedEffect fall of D between the two.
    #[serde(alias = "foreseen")]
    pub predicted: f64,
    /// What that search named, in the order of evidence.
    pub named: Vec<NamedEffect>,
}

impl Split {
    /// Whether the hidden one was named, and the other no longer: by itself or as one that
    /// does the same. Where more is hidden, something else may have come first.
    pub fn succeeded(&self) -> bool {
        let [hidden, other] = &self.pair;
        let mut named = self.named.iter();
        let is_told = |n: &NamedEffect| n.name != *other && !n.alike.contains(other);
        named.clone().any(|n| n.name == *hidden) && named.all(is_told)
    }
}

/// What came out of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseOutcome {
    /// The case.
    pub case: Case,
    /// What could be known beforehand, one entry a hidden effect.
    #[serde(alias = "foreseen")]
    pub predicted: Vec<PredictedEffect>,
    /// Why there is no verdict, where there is none.
    pub failed: Option<String>,
    /// Verdict.
    pub verdict: Option<Verdict>,
    /// Effects named, in the order in which they were found.
    pub named: Vec<NamedEffect>,
    /// Parameters of those that were hidden.
    pub estimates: Vec<ScoredEstimate>,
    /// Share of the gap on check motion that is gone.
    pub reduction: f64,
    /// The gap on check motion, channel by channel.
    pub check: Vec<ChannelGap>,
    /// What was found that is outside the library.
    pub unknown: Option<Unknown>,
    /// The experiment that was proposed, run.
    pub split: Option<Split>,
}

#[cfg(test)]
mod tests {
    use super::{NamedEffect, Split};

    #[test]
    fn a_class_is_split_when_only_the_hidden_one_is_left_of_it() {
        let named = |all: &[(&str, &[&str])]| Split {
            pair: ["constant-load", "process-force"].map(str::to_owned),
            predicted: 40.0,
            named: (all.iter())
                .map(|(name, alike)| NamedEffect {
                    name: (*name).to_owned(),
                    alike: alike.iter().map(|a| (*a).to_owned()).collect(),
                    values: Vec::new(),
                    evidence: [0.0; 2],
                })
                .collect(),
        };
        let [load, force] = ["constant-load", "process-force"];
        // Whatever else is hidden may be larger.
        let beside = named(&[("inverter-dead-time", &[]), (load, &[])]);
        assert!(beside.succeeded() && named(&[(load, &[])]).succeeded());
        for not in [
            named(&[(load, &[force])]),
            named(&[(load, &[]), (force, &[])]),
            named(&[(force, &[load])]),
            named(&[(load, &[]), ("coulomb-friction", &[force])]),
            named(&[]),
        ] {
            assert!(!not.succeeded(), "{not:?}");
        }
    }
}
