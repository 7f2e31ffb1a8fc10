//! Counting.

use serde::{Deserialize, Serialize};

use super::{Estimate, Foreseen, Kind, Outcome};
use crate::Verdict;

/// So many of so many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rate {
    /// How many hold.
    pub hits: usize,
    /// How many were asked.
    pub of: usize,
}

impl Rate {
    fn count<T>(all: impl IntoIterator<Item = T>, holds: impl Fn(&T) -> bool) -> Self {
        let mut rate = Self::default();
        for one in all {
            rate.of += 1;
            rate.hits += usize::from(holds(&one));
        }
        rate
    }

    /// Share, 0 of nothing.
    pub fn share(&self) -> f64 {
        self.hits as f64 / self.of.max(1) as f64
    }
}

/// The figures of a matrix.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Score {
    /// Clean machines of which anything else is said than that nothing is missing.
    pub false_alarms: Rate,
    /// Hidden single effects that can be seen, of all.
    pub detectable: Rate,
    /// Of those, ones that can be told from all others.
    pub separable: Rate,
    /// Detectable and separable single effects named first.
    pub right_first: Rate,
    /// Detectable single effects named first, told from all others or not.
    pub seen_first: Rate,
    /// Detectable single effects named first, or in the class of the first.
    pub in_class: Rate,
    /// Machines with library effects in which any name is given that is neither
    /// hidden nor alike to what is, by the search's word or foreseen.
    pub confident_wrong: Rate,
    /// Undetectable single effects on which nothing wrong was said.
    pub silence: Rate,
    /// Both of a pair named, where both can be seen and told.
    pub both_of_pair: Rate,
    /// All three of a triple, likewise.
    pub all_of_triple: Rate,
    /// Outside the library, seen, and not to be imitated by it: not called
    /// explained.
    pub outside: Rate,
    /// Outside the library and seen: what the library's effects imitate.
    pub imitated: Rate,
    /// Taken out of the library, seen: not called explained, or by a foreseen
    /// look-alike.
    pub left_out: Rate,
    /// One effect on poor motion, seen: named first, or in the class of the first.
    pub poor: Rate,
    /// Hidden effects in a class: that an experiment was proposed for.
    pub proposed: Rate,
    /// Known parameters told: relative errors of sizes, median and 90 %.
    pub error: [f64; 2],
    /// The same of the estimates as they are.
    pub raw_error: [f64; 2],
    /// 95 % intervals that hold the truth.
    pub coverage: Rate,
    /// Median gap reduction on check motion over explained single effects.
    pub reduction: f64,
    /// Proposed experiments, run, that split their class.
    pub splits: Rate,
    /// Cases without a verdict.
    pub failed: Vec<String>,
}

impl Score {
    /// Of these outcomes.
    pub fn new(outcomes: &[Outcome]) -> Self {
        let of = |kind: Kind| {
            outcomes
                .iter()
                .filter(move |o| o.case.kind == kind && o.failed.is_none())
        };
        let singles: Vec<&Outcome> = of(Kind::Single).collect();
        let seen: Vec<&Outcome> = singles.iter().copied().filter(|o| detectable(o)).collect();
        let told = |o: &&&Outcome| o.foreseen.iter().all(|f| f.class.is_empty());
        let both = |kind| {
            Rate::count(of(kind).filter(|o| detectable(o) && separable(o)), |o| {
                all_named(o)
            })
        };
        let estimates: Vec<&Estimate> = outcomes
            .iter()
            .filter(|o| o.case.kind == Kind::Single && first_is_right(o))
            .flat_map(|o| &o.estimates)
            .collect();
        let errors = |value: fn(&Estimate) -> f64| {
            let sizes = estimates.iter().filter(|e| e.size);
            quantiles(
                sizes
                    .map(|e| ((value(e) - e.truth) / e.truth).abs())
                    .collect(),
            )
        };
        let library = outcomes.iter().filter(|o| {
            let absent = matches!(o.case.kind, Kind::Clean | Kind::Outside | Kind::LeftOut);
            o.failed.is_none() && !absent
        });
        Self {
            false_alarms: Rate::count(of(Kind::Clean), |o| {
                o.verdict != Some(Verdict::NothingMissing)
            }),
            detectable: Rate::count(&singles, |o| detectable(o)),
            separable: Rate::count(&seen, told),
            right_first: Rate::count(seen.iter().filter(told), |o| first_is_right(o)),
            seen_first: Rate::count(&seen, |o| first_is_right(o)),
            in_class: Rate::count(&seen, |o| in_class(o)),
            confident_wrong: Rate::count(library, |o| wrongly_named(o)),
            silence: Rate::count(singles.iter().filter(|o| !detectable(o)), |o| {
                o.named.is_empty() || in_class(o)
            }),
            both_of_pair: both(Kind::Pair),
            all_of_triple: both(Kind::Triple),
            outside: Rate::count(
                of(Kind::Outside).filter(|o| detectable(o) && !imitated(o)),
                |o| honest(o),
            ),
            imitated: Rate::count(of(Kind::Outside).filter(|o| detectable(o)), |o| imitated(o)),
            left_out: Rate::count(of(Kind::LeftOut).filter(|o| detectable(o)), |o| honest(o)),
            poor: Rate::count(of(Kind::Poor).filter(|o| detectable(o)), |o| in_class(o)),
            proposed: Rate::count(outcomes.iter().filter(|o| hidden_in_class(o)), |o| {
                o.split.is_some()
            }),
            error: errors(|e| e.given_known),
            raw_error: errors(|e| e.value),
            coverage: Rate::count(&estimates, |e| e.ci95[0] <= e.truth && e.truth <= e.ci95[1]),
            reduction: quantiles(
                seen.iter()
                    .filter(|o| first_is_right(o))
                    .map(|o| o.reduction)
                    .collect(),
            )[0],
            splits: Rate::count(outcomes.iter().filter_map(|o| o.split.as_ref()), |s| {
                s.succeeded()
            }),
            failed: outcomes
                .iter()
                .filter_map(|o| Some(format!("{}: {}", o.case.id, o.failed.as_ref()?)))
                .collect(),
        }
    }
}

fn detectable(outcome: &Outcome) -> bool {
    outcome.foreseen.iter().all(|f| f.detectable)
}

fn separable(outcome: &Outcome) -> bool {
    outcome.foreseen.iter().all(|f| f.class.is_empty())
}

fn hidden(outcome: &Outcome, name: &str) -> bool {
    outcome.case.hidden.iter().any(|h| h.name == name)
}

fn first_is_right(outcome: &Outcome) -> bool {
    let first = outcome.named.first();
    first.is_some_and(|n| hidden(outcome, &n.name))
}

fn in_class(outcome: &Outcome) -> bool {
    outcome.named.first().is_some_and(|n| {
        hidden(outcome, &n.name) || n.alike.iter().any(|name| hidden(outcome, name))
    })
}

/// Whether what is hidden was named with others that do the same, or as one.
fn hidden_in_class(outcome: &Outcome) -> bool {
    outcome.named.iter().any(|n| {
        let is_hidden = |name: &String| hidden(outcome, name);
        is_hidden(&n.name) && !n.alike.is_empty() || n.alike.iter().any(is_hidden)
    })
}

fn wrongly_named(outcome: &Outcome) -> bool {
    outcome.named.iter().any(|n| {
        let alike = n.alike.iter().any(|name| hidden(outcome, name));
        let foretold = outcome.foreseen.iter().any(|f| f.class.contains(&n.name));
        !hidden(outcome, &n.name) && !alike && !foretold
    })
}

fn all_named(outcome: &Outcome) -> bool {
    let mut hidden = outcome.case.hidden.iter();
    hidden.all(|h| outcome.named.iter().any(|n| n.name == h.name))
}

fn imitated(outcome: &Outcome) -> bool {
    let complete = |f: &Foreseen| f.imitation.as_ref().is_some_and(|i| i.complete);
    outcome.foreseen.iter().any(complete)
}

/// Not called explained; or by an effect that was foreseen to look the same.
fn honest(outcome: &Outcome) -> bool {
    let alike = || {
        let first = outcome.named.first();
        let foretold = |f: &Foreseen, name: &String| {
            let imitation = f.imitation.as_ref().filter(|i| i.complete);
            f.class.contains(name) || imitation.is_some_and(|i| i.by.contains(name))
        };
        first.is_some_and(|n| outcome.foreseen.iter().any(|f| foretold(f, &n.name)))
    };
    match outcome.verdict {
        Some(Verdict::Unknown | Verdict::PartlyExplained) => true,
        Some(Verdict::Explained) => alike(),
        _ => false,
    }
}

/// Median and 90 % quantile.
fn quantiles(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    let at = |q: f64| {
        let last = values.len().saturating_sub(1) as f64;
        values.get((q * last).round() as usize).copied()
    };
    [at(0.5).unwrap_or(0.0), at(0.9).unwrap_or(0.0)]
}
