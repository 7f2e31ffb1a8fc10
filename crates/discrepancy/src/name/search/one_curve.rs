//! A law outside the library in the place of all effects of a torque balance.
//!
//! Effects together imitate a law that is none of them: a load with a spring stands for a force that grows
//! along the stroke in another way. So what is named competes as a whole with every law over one variable,
//! whatever its form, by what each explains of the fitted logs and predicts of the check logs, and by the
//! latter alone. Numbers count by what each brings by chance, and so does the choice: k of E effects against
//! one of V variables.

use super::free_curve::{BY_CHANCE, FreeCurves};
use super::is_form::is_form;
use super::state::Search;
use super::types::{RefusalReason, Refused};
use crate::estimate::columns::free_parameters;

/// Share of what the law explains that effects must explain to be named: where the model itself is not quite
/// right, as in the form of its friction, a free law takes up some of that as well. From `docs/laws/run 7`:
/// effects reached 0.71 at most of hidden laws over position, and 0.94 and more where they were there. Loads that
/// drift and laws over speed they imitate to 0.5 and more, up to all.
const SHARE: f64 = 0.85;

impl Search<'_> {
    /// Without all effects, if a law over one variable is more probable than they are together; they are
    /// said to be refused. Forms of the own friction stay in both, and so does what the engineer accepts.
    pub(super) fn without_imitations(&self) -> Option<Self> {
        // What a loop holds when a log begins is a course in time that repeats from log to log, and in a replay
        // nothing stands for it beside such a law.
        if !self.fit_logs.is_balanced() {
            return None;
        }
        let mut without = self.clone();
        let mut taken = Vec::new();
        while let Some(index) = without.first_in_question() {
            taken.push(without.named[index].clone());
            without = without.without(index)?;
        }
        if taken.is_empty() {
            return None;
        }
        let own = without.own_columns();
        let fitter = without.fitter();
        let curves = FreeCurves::new(&without, &fitter, &own);
        let rival = curves.most_probable(&own, self)?;
        let numbers =
            free_parameters(&self.fit.state).len() - free_parameters(&without.fit.state).len();
        let on_fit = without.fit.deviance - self.fit.deviance - BY_CHANCE * numbers as f64;
        let candidates = self.library.candidates.iter();
        let mut names: Vec<&str> = candidates.map(|c| c.effect.name).collect();
        names.dedup();
        let choice = 2.0 * (ln_choices(names.len(), taken.len()) - ln_choices(curves.count(), 1));
        let of_effects = on_fit + rival.of_effects;
        let of_law = rival.fit + rival.check;
        tracing::debug!(
            effects = ?taken.iter().map(|n| n.name).collect::<Vec<_>>(),
            of_effects,
            of_law,
            choice,
            ?rival,
            "a law over one variable in their place"
        );
        // Slow noise is a law over time, but one that predicts no other log.
        let is_law = of_effects - choice < SHARE * of_law && rival.of_effects < SHARE * rival.check;
        if !is_law {
            return None;
        }
        Some(without.with_refused(Refused {
            effects: taken,
            reason: RefusalReason::OneCurve(rival.over),
        }))
    }

    fn first_in_question(&self) -> Option<usize> {
        let effects = self.fit.state.effects.iter();
        let mut effects = effects.map(|a| !is_form(a) && !self.is_accepted(a.effect.name));
        effects.position(|is_in_question| is_in_question)
    }
}

/// ln of the number of ways to choose k of n.
fn ln_choices(n: usize, k: usize) -> f64 {
    let each = (0..k.min(n)).map(|i| ((n - i) as f64 / (i + 1) as f64).ln());
    each.sum()
}

#[cfg(test)]
mod tests {
    use super::ln_choices;

    #[test]
    fn choices_are_counted() {
        assert!((ln_choices(39, 2).exp() - 741.0).abs() < 1e-9);
        assert!((ln_choices(18, 1).exp() - 18.0).abs() < 1e-12);
        assert!(ln_choices(5, 0).abs() < 1e-15);
    }
}
