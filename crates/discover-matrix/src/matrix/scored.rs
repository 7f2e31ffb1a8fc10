//! What was said in a case, beside what was hidden.

use discrepancy::{PredictedEffect, Verdict};

use super::case::CaseKind;
use super::outcome::CaseOutcome;

impl CaseOutcome {
    /// Whether all that is hidden can be seen, by what was known beforehand.
    pub fn is_detectable(&self) -> bool {
        self.predicted.iter().all(|f| f.detectable)
    }

    /// Whether each can be told from all other effects, likewise.
    pub(super) fn is_separable(&self) -> bool {
        self.predicted.iter().all(|f| f.class.is_empty())
    }

    /// Whether all that is hidden is in the library that is searched.
    pub(super) fn is_of_library(&self) -> bool {
        use CaseKind::{Pair, Poor, Single, Triple};
        matches!(self.case.kind, Single | Pair | Triple | Poor)
    }

    /// Whether something was said of a clean machine.
    pub(super) fn is_false_alarm(&self) -> bool {
        self.case.kind == CaseKind::Clean && self.verdict != Some(Verdict::NothingMissing)
    }

    pub(super) fn first_is_right(&self) -> bool {
        let first = self.named.first();
        first.is_some_and(|n| self.hides(&n.name))
    }

    /// Whether what is hidden is the first, or was said to look like it.
    pub(super) fn is_in_class(&self) -> bool {
        let first = self.named.first();
        first.is_some_and(|n| self.hides(&n.name) || n.alike.iter().any(|name| self.hides(name)))
    }

    /// Whether what is hidden was named with others that do the same, or as one.
    pub(super) fn leaves_a_class(&self) -> bool {
        self.named.iter().any(|n| {
            let own = self.hides(&n.name) && !n.alike.is_empty();
            own || n.alike.iter().any(|name| self.hides(name))
        })
    }

    pub(super) fn all_are_named(&self) -> bool {
        let mut hidden = self.case.hidden.iter();
        hidden.all(|h| self.named.iter().any(|n| n.name == h.name))
    }

    /// Whether a name is neither hidden nor alike to what is.
    pub(super) fn has_wrong_name(&self) -> bool {
        self.named.iter().any(|n| {
            let alike = n.alike.iter().any(|name| self.hides(name));
            let predicted = self.predicted.iter().any(|f| f.class.contains(&n.name));
            !self.hides(&n.name) && !alike && !predicted
        })
    }

    /// Whether the library's effects can imitate what is outside the library.
    pub(super) fn is_imitated(&self) -> bool {
        let complete = |f: &PredictedEffect| f.imitation.as_ref().is_some_and(|i| i.complete);
        self.predicted.iter().any(complete)
    }

    /// Not called explained; or by an effect that was predicted to look the same.
    pub(super) fn is_honest(&self) -> bool {
        match self.verdict {
            Some(Verdict::Unknown | Verdict::PartlyExplained) => true,
            Some(Verdict::Explained) => self.first_is_predicted(),
            _ => false,
        }
    }

    /// What the case counts against; empty where all is as it should be.
    pub fn faults(&self) -> Vec<&'static str> {
        if self.failed.is_some() {
            return vec!["no verdict"];
        }
        let kind = self.case.kind;
        let (seen, told) = (self.is_detectable(), self.is_separable());
        let alone = matches!(kind, CaseKind::Single | CaseKind::Poor);
        let several = matches!(kind, CaseKind::Pair | CaseKind::Triple);
        let absent = kind == CaseKind::LeftOut || kind == CaseKind::Outside && !self.is_imitated();
        let all = [
            (self.is_false_alarm(), "false alarm"),
            (
                alone && seen && !self.is_in_class(),
                "neither first nor in the class of the first",
            ),
            (
                kind == CaseKind::Single && seen && told && !self.first_is_right(),
                "distinguishable from all others, and not first",
            ),
            (
                several && seen && told && !self.all_are_named(),
                "not all are named",
            ),
            (
                self.is_of_library() && self.has_wrong_name(),
                "a wrong name",
            ),
            (
                absent && seen && !self.is_honest(),
                "neither unknown nor a look-alike",
            ),
            (
                self.leaves_a_class() && self.split.is_none(),
                "no experiment was proposed",
            ),
            (
                self.split.as_ref().is_some_and(|s| !s.succeeded()),
                "the class is not split",
            ),
        ];
        let faults = all.into_iter().filter(|(holds, _)| *holds);
        faults.map(|(_, fault)| fault).collect()
    }

    fn hides(&self, name: &str) -> bool {
        self.case.hidden.iter().any(|h| h.name == name)
    }

    fn first_is_predicted(&self) -> bool {
        let predicted = |f: &PredictedEffect, name: &String| {
            let imitation = f.imitation.as_ref().filter(|i| i.complete);
            f.class.contains(name) || imitation.is_some_and(|i| i.by.contains(name))
        };
        let first = self.named.first();
        first.is_some_and(|n| self.predicted.iter().any(|f| predicted(f, &n.name)))
    }
}
