//! A matrix of machines with something hidden in them, and how the search
//! does on it, blind.
//!
//! [`cases`] lays out the machines: Latin hypercubes over effect, size, noise
//! and motion. A [`Bench`] holds what is the same for all cases on one motion;
//! [`Bench::try_case`] makes a case's logs, says beforehand what can be seen in
//! them ([`Foreseen`]), runs the search without that knowledge, and keeps
//! both. [`Score`] counts.

mod design;
mod foresee;
mod score;
mod told;
mod trial;

pub use design::{Sizes, cases};
pub use foresee::{Bench, BenchError, Foreseen, Imitation};
pub use score::{OfEffect, Rate, Score};

use serde::{Deserialize, Serialize};

use crate::hidden::Exercise;
use crate::{ChannelGap, Unknown, Verdict};

/// What kind of question a case asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Nothing hidden.
    Clean,
    /// One effect of the library.
    Single,
    /// Two.
    Pair,
    /// Three.
    Triple,
    /// One that is in no library.
    Outside,
    /// One of the library, taken out of it before the search.
    LeftOut,
    /// One of the library, on motion too poor to tell it from others.
    Poor,
}

/// A hidden effect: name and values in the order of its parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HiddenEffect {
    /// Name, in the library or in [`crate::hidden::OUTSIDE`].
    pub name: String,
    /// SI.
    pub values: Vec<f64>,
}

/// One machine with something hidden in it, and the motion that it is asked on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Name of the case.
    pub id: String,
    /// What kind.
    pub kind: Kind,
    /// What is hidden.
    pub hidden: Vec<HiddenEffect>,
    /// Motion.
    pub exercise: Exercise,
    /// Noise, as a multiple of [`crate::hidden::Noise::GOOD`].
    pub noise: f64,
    /// Share by which known parameters may be off.
    pub known_off: f64,
    /// Effects that the search may not name.
    pub rejected: Vec<String>,
    /// Of noise and known parameters.
    pub seed: u64,
    /// Where there is one: sizes are scaled until the expected fall of D is so
    /// many times what naming takes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visible: Option<f64>,
}

impl Case {
    /// Whether both are one case, sizes scaled or not yet.
    pub fn is_same(&self, other: &Self) -> bool {
        let unscaled = |case: &Self| {
            let mut case = case.clone();
            if case.visible.is_some() {
                case.hidden.iter_mut().for_each(|h| h.values.clear());
            }
            case
        };
        unscaled(self) == unscaled(other)
    }
}

/// An estimate beside the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
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
}

/// What a proposed experiment did for a class: the search once more, with its log
/// beside the old one and, in the library, the two rivals and what else is hidden.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Split {
    /// The pair that it was to separate, the hidden one first.
    pub pair: [String; 2],
    /// Foreseen fall of D between the two.
    pub foreseen: f64,
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
pub struct Outcome {
    /// The case.
    pub case: Case,
    /// What could be known beforehand, one entry a hidden effect.
    pub foreseen: Vec<Foreseen>,
    /// Why there is no verdict, where there is none.
    pub failed: Option<String>,
    /// Verdict.
    pub verdict: Option<Verdict>,
    /// Effects named, in the order in which they were found.
    pub named: Vec<NamedEffect>,
    /// Parameters of those that were hidden.
    pub estimates: Vec<Estimate>,
    /// Share of the gap on check motion that is gone.
    pub reduction: f64,
    /// The gap on check motion, channel by channel.
    pub check: Vec<ChannelGap>,
    /// What was found that is in no library.
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
            foreseen: 40.0,
            named: (all.iter())
                .map(|(name, alike)| NamedEffect {
                    name: (*name).to_owned(),
                    alike: alike.iter().map(|a| (*a).to_owned()).collect(),
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
