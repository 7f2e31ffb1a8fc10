//! What was said in a case, beside what was hidden.

use axis_sim::effects::Effect;
use discrepancy::{PredictedEffect, Verdict};

use super::outcome::{CaseOutcome, Deviance};
use crate::hidden::{Form, LawVariable};
use crate::matrix::{CaseKind, NamedEffect};

impl CaseOutcome {
    /// Whether all that is hidden can be seen: by what was known beforehand, which is linear
    /// about the file's values, and by the truth's explaining the fitted logs better than known
    /// parameters inside their tolerance do.
    pub fn is_seen(&self) -> bool {
        let better = |d: Deviance| d.calibrated - d.truth >= d.needed;
        let predicted = self.predicted.iter().all(|f| f.detectable);
        self.failed.is_none() && predicted && self.deviance.is_none_or(better)
    }

    /// Whether each of it can be told from every other effect, likewise.
    pub fn is_told_apart(&self) -> bool {
        self.predicted.iter().all(|f| f.class.is_empty())
    }

    /// Whether effects of the library can do what is hidden outside of it.
    pub fn is_imitated(&self) -> bool {
        let complete = |f: &PredictedEffect| f.imitation.as_ref().is_some_and(|i| i.complete);
        self.predicted.iter().any(complete)
    }

    /// Names of effects that are not there, whatever the verdict. A name beside which the
    /// search lists what is hidden as a look-alike is that of a class, and right; one that
    /// says the form of a law ([`Form::said_by`]) is neither.
    pub fn wrong_names(&self) -> Vec<&str> {
        let wrong = |n: &&NamedEffect| {
            let alike = n.alike.iter().any(|name| self.hides(name));
            !(self.hides(&n.name) || alike)
        };
        let named = self.counted().filter(wrong);
        named.map(|n| n.name.as_str()).collect()
    }

    /// Whether the fitted logs speak for the truth against what was found, by as much as naming
    /// an effect takes. Where they do not, nothing in them contradicts what was found, right or
    /// wrong.
    pub fn is_truth_better(&self) -> bool {
        self.deviance.is_some_and(|d| d.found - d.truth >= d.needed)
    }

    /// Whether a clean machine was given a name that is not there, or, where its laws are
    /// those of the model, anything was said of it.
    pub fn is_false_alarm(&self) -> bool {
        let silent = self.verdict == Some(Verdict::NothingMissing);
        let as_model = self.case.form == Form::Same;
        !self.wrong_names().is_empty() || as_model && !silent
    }

    /// Whether the first name that counts is that of what is hidden.
    pub fn is_first(&self) -> bool {
        self.counted().next().is_some_and(|n| self.hides(&n.name))
    }

    /// Names that are right or wrong: all but those of what is not hidden and says the form
    /// of a law.
    fn counted(&self) -> impl Iterator<Item = &NamedEffect> {
        let form = |n: &NamedEffect| self.case.form.said_by().contains(&n.name.as_str());
        let all = self.named.iter();
        all.filter(move |n| self.hides(&n.name) || !form(n))
    }

    /// Whether everything that is hidden is named.
    pub fn are_all_named(&self) -> bool {
        let mut hidden = self.case.hidden.iter();
        hidden.all(|h| self.named.iter().any(|n| n.name == h.name))
    }

    /// Whether it was called unknown, and over nothing but what it depends on.
    pub fn is_unknown_of_right_variable(&self) -> bool {
        self.verdict == Some(Verdict::Unknown) && self.has_right_variable()
    }

    /// Whether something was said to be left over nothing but what the hidden law depends on.
    pub fn has_right_variable(&self) -> bool {
        let said = self.unknown.as_ref().map_or("", |u| &u.depends_on);
        let right = self.right_variables();
        let told: Vec<&str> = Self::words()
            .into_iter()
            .filter(|w| said.contains(w))
            .collect();
        !told.is_empty() && told.iter().all(|w| right.contains(w))
    }

    /// What the hidden law depends on, in the search's words.
    pub fn right_variables(&self) -> Vec<&'static str> {
        let of_law = self.case.law.iter().flat_map(|law| law.variables());
        let effects = self
            .case
            .hidden
            .iter()
            .filter_map(|h| Effect::named(&h.name));
        let all = of_law.chain(effects.map(|e| LawVariable::of(e.shown_over)));
        all.map(LawVariable::words).collect()
    }

    fn words() -> [&'static str; 6] {
        [
            LawVariable::Speed,
            LawVariable::Position,
            LawVariable::Angle,
            LawVariable::Acceleration,
            LawVariable::Time,
            LawVariable::Current,
        ]
        .map(LawVariable::words)
    }

    /// Whether something of the library is hidden.
    pub(super) fn is_of_library(&self) -> bool {
        matches!(self.case.kind, CaseKind::Single | CaseKind::Pair)
    }

    fn hides(&self, name: &str) -> bool {
        let rejected = self.case.rejected.iter().any(|r| r == name);
        !rejected && self.case.hidden.iter().any(|h| h.name == name)
    }
}
