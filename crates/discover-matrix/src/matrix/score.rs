//! Counting.

use axis_sim::effects::EFFECTS;
use discrepancy::Verdict;
use serde::{Deserialize, Serialize};

use super::case::CaseKind;
use super::outcome::{CaseOutcome, ScoredEstimate};

/// So many of so many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rate {
    /// How many hold.
    pub hits: usize,
    /// How many were asked.
    pub of: usize,
}

impl Rate {
    pub(crate) fn count<T>(all: impl IntoIterator<Item = T>, holds: impl Fn(&T) -> bool) -> Self {
        let mut rate = Self::default();
        for one in all {
            rate.of += 1;
            rate.hits += usize::from(holds(&one));
        }
        rate
    }

    /// One more, or none of it: what is asked, and whether it holds.
    pub(crate) fn one(asked: bool, holds: bool) -> Self {
        Self {
            hits: usize::from(asked && holds),
            of: usize::from(asked),
        }
    }

    /// Both together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            hits: self.hits + other.hits,
            of: self.of + other.of,
        }
    }

    /// Share, 0 of nothing.
    pub fn share(&self) -> f64 {
        self.hits as f64 / self.of.max(1) as f64
    }

    /// 95 % interval of the share (Wilson, J. Am. Stat. Assoc. 22 (1927) 209,
    /// doi:10.1080/01621459.1927.10502953); 0 to 1 of nothing.
    pub fn interval(&self) -> [f64; 2] {
        if self.of == 0 {
            return [0.0, 1.0];
        }
        let (n, share, z2) = (self.of as f64, self.share(), 1.96_f64.powi(2));
        let centre = share + z2 / (2.0 * n);
        let half = (z2 * (share * (1.0 - share) / n + z2 / (4.0 * n * n))).sqrt();
        let at = |v: f64| (v / (1.0 + z2 / n)).clamp(0.0, 1.0);
        [at(centre - half), at(centre + half)]
    }
}

/// How one effect of the library did where it alone was hidden.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct OfEffect {
    /// Its name.
    pub effect: String,
    /// That it can be seen, of all.
    pub detectable: Rate,
    /// Named first, of those.
    pub first: Rate,
    /// In the class of the first, of those.
    pub in_class: Rate,
    /// Known parameters exact: relative error of sizes where it was named first, median
    /// and largest; `None` where it never was.
    pub error: Option<[f64; 2]>,
    /// Its 95 % intervals that hold the truth.
    pub coverage: Rate,
}

impl OfEffect {
    fn new(effect: &str, all: &[&CaseOutcome]) -> Self {
        let hides = |o: &&&CaseOutcome| o.case.hidden.iter().any(|h| h.name == effect);
        let own: Vec<&CaseOutcome> = all.iter().filter(hides).copied().collect();
        let seen = || own.iter().filter(|o| o.is_detectable());
        let right = own.iter().filter(|o| o.first_is_right());
        let estimates: Vec<&ScoredEstimate> = right.flat_map(|o| &o.estimates).collect();
        let errors = size_errors(&estimates, |e| e.given_known);
        Self {
            effect: effect.to_owned(),
            detectable: Rate::count(&own, |o| o.is_detectable()),
            first: Rate::count(seen(), |o| o.first_is_right()),
            in_class: Rate::count(seen(), |o| o.is_in_class()),
            error: quantiles(errors, [0.5, 1.0]),
            coverage: covered(&estimates),
        }
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
    /// Of the detectable single effects named first: that the verdict was explained.
    pub explained: Rate,
    /// Machines with library effects in which any name is given that is neither
    /// hidden nor alike to what is, by the search's word or predicted.
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
    /// Taken out of the library, seen: not called explained, or by a predicted
    /// look-alike.
    pub left_out: Rate,
    /// One effect on poor motion, seen: named first, or in the class of the first.
    pub poor: Rate,
    /// Hidden effects in a class: that an experiment was proposed for.
    pub proposed: Rate,
    /// Known parameters exact: relative errors of sizes, median and 90 %; `None` where
    /// none was named, here and below.
    pub error: Option<[f64; 2]>,
    /// The same of the estimates as they are.
    pub raw_error: Option<[f64; 2]>,
    /// 95 % intervals that hold the truth.
    pub coverage: Rate,
    /// Median gap reduction on check motion over detectable single effects named first.
    pub reduction: Option<f64>,
    /// Proposed experiments, run, that split their class.
    pub splits: Rate,
    /// Each effect by itself, as the only one hidden, in the library's order.
    pub effects: Vec<OfEffect>,
    /// Cases without a verdict.
    pub failed: Vec<String>,
}

impl Score {
    /// Of these outcomes.
    pub fn new(outcomes: &[CaseOutcome]) -> Self {
        let ran: Vec<&CaseOutcome> = outcomes.iter().filter(|o| o.failed.is_none()).collect();
        let of = |kind: CaseKind| ran.iter().copied().filter(move |o| o.case.kind == kind);
        let seen_of = |kind| of(kind).filter(|o| o.is_detectable());
        let several = |kind| {
            let told = seen_of(kind).filter(|o| o.is_separable());
            Rate::count(told, |o| o.all_are_named())
        };
        let singles: Vec<&CaseOutcome> = of(CaseKind::Single).collect();
        let seen: Vec<&CaseOutcome> = seen_of(CaseKind::Single).collect();
        let right: Vec<&CaseOutcome> = seen
            .iter()
            .copied()
            .filter(|o| o.first_is_right())
            .collect();
        let named = singles.iter().filter(|o| o.first_is_right());
        let estimates: Vec<&ScoredEstimate> = named.flat_map(|o| &o.estimates).collect();
        let errors = |value| quantiles(size_errors(&estimates, value), [0.5, 0.9]);
        let reductions = quantiles(right.iter().map(|o| o.reduction).collect(), [0.5]);
        let hides = |name: &str| {
            let mut hidden = singles.iter().flat_map(|o| &o.case.hidden);
            hidden.any(|h| h.name == name)
        };
        let effects = EFFECTS.iter().filter(|e| hides(e.name));
        let library = ran.iter().filter(|o| o.is_of_library());
        Self {
            false_alarms: Rate::count(of(CaseKind::Clean), |o| o.is_false_alarm()),
            detectable: Rate::count(&singles, |o| o.is_detectable()),
            separable: Rate::count(&seen, |o| o.is_separable()),
            right_first: Rate::count(seen.iter().filter(|o| o.is_separable()), |o| {
                o.first_is_right()
            }),
            seen_first: Rate::count(&seen, |o| o.first_is_right()),
            in_class: Rate::count(&seen, |o| o.is_in_class()),
            explained: Rate::count(&right, |o| o.verdict == Some(Verdict::Explained)),
            confident_wrong: Rate::count(library, |o| o.has_wrong_name()),
            silence: Rate::count(singles.iter().filter(|o| !o.is_detectable()), |o| {
                o.named.is_empty() || o.is_in_class()
            }),
            both_of_pair: several(CaseKind::Pair),
            all_of_triple: several(CaseKind::Triple),
            outside: Rate::count(
                seen_of(CaseKind::Outside).filter(|o| !o.is_imitated()),
                |o| o.is_honest(),
            ),
            imitated: Rate::count(seen_of(CaseKind::Outside), |o| o.is_imitated()),
            left_out: Rate::count(seen_of(CaseKind::LeftOut), |o| o.is_honest()),
            poor: Rate::count(seen_of(CaseKind::Poor), |o| o.is_in_class()),
            proposed: Rate::count(ran.iter().filter(|o| o.leaves_a_class()), |o| {
                o.split.is_some()
            }),
            error: errors(|e| e.given_known),
            raw_error: errors(|e| e.value),
            coverage: covered(&estimates),
            reduction: reductions.map(|[median]| median),
            splits: Rate::count(ran.iter().filter_map(|o| o.split.as_ref()), |s| {
                s.succeeded()
            }),
            effects: effects.map(|e| OfEffect::new(e.name, &singles)).collect(),
            failed: outcomes
                .iter()
                .filter_map(|o| Some(format!("{}: {}", o.case.id, o.failed.as_ref()?)))
                .collect(),
        }
    }
}

/// Relative errors of sizes.
fn size_errors(estimates: &[&ScoredEstimate], value: fn(&ScoredEstimate) -> f64) -> Vec<f64> {
    let sizes = estimates.iter().filter(|e| e.size);
    let error = |e: &&ScoredEstimate| ((value(e) - e.truth) / e.truth).abs();
    sizes.map(error).collect()
}

pub(crate) fn covered(estimates: &[&ScoredEstimate]) -> Rate {
    Rate::count(estimates, |e| e.ci95[0] <= e.truth && e.truth <= e.ci95[1])
}

/// `None` of no values.
fn quantiles<const N: usize>(mut values: Vec<f64>, shares: [f64; N]) -> Option<[f64; N]> {
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    Some(shares.map(|share| values[(share * last as f64).round() as usize]))
}

#[cfg(test)]
mod tests {
    use super::Rate;

    #[test]
    fn the_interval_of_none_and_of_all_is_wilsons() {
        // With no hits its upper end is z²/(n + z²); with hits only it is mirrored.
        let most = 3.8416 / (120.0 + 3.8416);
        let [low, high] = Rate { hits: 0, of: 120 }.interval();
        assert!(low == 0.0 && (high - most).abs() < 1e-12, "{low} {high}");
        let mirrored = Rate { hits: 120, of: 120 }.interval();
        assert!((mirrored[0] - (1.0 - most)).abs() < 1e-12, "{mirrored:?}");
        assert_eq!(Rate { hits: 0, of: 0 }.interval(), [0.0, 1.0]);
    }
}
