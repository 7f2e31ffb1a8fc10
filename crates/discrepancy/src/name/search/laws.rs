//! Laws outside the library in the place of effects: every curve over one variable, and every short term, fitted with
//! simulations.

use std::borrow::Cow;

use axis_sim::effects::ActiveEffect;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::revise::RIVAL;
use super::state::Search;
use super::types::LawInPlace;
use crate::answers::{Rest as Residual, State};
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::smooth::Smooth;
use crate::name::curves::{Beginnings, Place, Shape, courses};
use crate::name::library::responses;
use crate::name::terms::{Term, terms};
use crate::spectrum::Amplitudes;

/// Fall of D that a number brings by chance, a knot of a curve or a size: as S is estimated from the same
/// data, more than the 1 of χ².
pub(super) const BY_CHANCE: f64 = 4.0;

/// Laws, the best of the linearised model from each start, that are fitted with simulations.
const SIMULATED: usize = 4;

/// Rounds of a law's fit, each weighed by what the last one left.
const ROUNDS: usize = 6;

/// Shares of a step that are tried one after the other.
const SHORTER: [f64; 4] = [1.0, 0.35, 0.12, 0.0];

/// Fall of D that is worth another round with simulations.
const ENOUGH: f64 = 0.5;

/// The law outside the library that is most probable in the place of effects.
#[derive(Debug)]
pub(super) struct Rival {
    /// On what it depends.
    pub(super) over: String,
    pub(super) law: LawInPlace,
    /// How many numbers it has.
    pub(super) numbers: usize,
    /// Fall of D on the fitted logs, beyond chance.
    pub(super) fit: f64,
    /// The same on the check logs, as far as the fitted motion went: of the law itself, not only of the
    /// parameters that were fitted beside it.
    pub(super) check: f64,
    /// Fall of D that all effects bring on the fitted logs.
    pub(super) effects_fit: f64,
    /// And on the check logs, on the same samples as the law.
    pub(super) effects_check: f64,
}

/// A law, and what its numbers do to the fitted logs.
struct Law<'a> {
    form: Form<'a>,
    columns: Cow<'a, Columns>,
    /// Of the values of a curve; none of a term.
    correlation: Option<DMatrix<f64>>,
}

enum Form<'a> {
    Curve(usize, &'a Shape),
    Term(&'static Term, ActiveEffect),
}

/// A law fitted beside all parameters in the linearised model.
struct Beside<'a> {
    law: &'a Law<'a>,
    /// Where that began.
    from: &'a State,
    /// By how much all parameters move, then the law's values.
    step: DVector<f64>,
    /// D of what it leaves, with what its numbers bring by chance.
    deviance: f64,
}

/// Laws against effects, each side beside what is not known of how the logs begin.
pub(super) struct Contest<'a> {
    /// Without the effects in question.
    without: &'a Search<'a>,
    effects: &'a Search<'a>,
    /// Derivatives with respect to all parameters without the effects.
    own: Columns,
    laws: Vec<Law<'a>>,
    fit_begins: Beginnings,
    check_begins: Beginnings,
    /// D of the fitted logs without the effects, and with them.
    deviances: [f64; 2],
}

impl<'a> Contest<'a> {
    /// Of a search with effects, and one without some of them.
    pub(super) fn of(without: &'a Search<'a>, effects: &'a Search<'a>) -> Self {
        let (fitter, with) = (without.fitter(), effects.fitter());
        let curves = without.library.curves.shapes.iter().enumerate();
        let curves = curves.map(|(index, (shape, columns))| Law {
            form: Form::Curve(index, shape),
            columns: Cow::Borrowed(columns),
            correlation: Some(shape.correlation()),
        });
        let motions = courses(without.machine, fitter.set, &without.fit.traces);
        let terms = terms(Place::Force).iter().filter_map(|term| {
            let active = term.as_effect(&motions)?;
            let columns = responses(&fitter, &without.fit, active.effect, &active.values);
            Some(Law {
                form: Form::Term(term, active),
                columns: Cow::Owned(columns),
                correlation: None,
            })
        });
        let fit_begins = Beginnings::of(&fitter, &without.fit);
        let check_begins = Beginnings::of(&without.checker(), &without.check);
        let deviance = |fitter: &Fitter<'_>, fit: &Fit| {
            let left = fit_begins.taken_out(&fitter.set.layout, fit.rest.clone());
            fitter.set.layout.deviance(&left) + fitter.departure(&fit.state)
        };
        Self {
            own: without.own_columns(),
            laws: curves.chain(terms).collect(),
            deviances: [
                deviance(&fitter, &without.fit),
                deviance(&with, &effects.fit),
            ],
            without,
            effects,
            fit_begins,
            check_begins,
        }
    }

    /// Number of laws.
    pub(super) fn count(&self) -> usize {
        self.laws.len()
    }

    /// The law that does most on the fitted and the check logs together; `None` if the machine runs with none.
    pub(super) fn most_probable(&self) -> Option<Rival> {
        let fitter = self.without.fitter();
        // Without effects known parameters make up for them, and with them they are where they belong, which may be
        // too far for a linearised model.
        let mut state = self.without.fit.state.clone();
        state.shares.clone_from(&self.effects.fit.state.shares);
        let starts = [Some(self.without.fit.clone()), fitter.at(state).ok()];
        let starts: Vec<Fit> = starts.into_iter().flatten().collect();
        let pairs = self.laws.iter().flat_map(|law| {
            let of_law = starts.iter().map(move |start| (law, start));
            of_law.collect::<Vec<_>>()
        });
        let pairs: Vec<(&Law<'_>, &Fit)> = pairs.collect();
        let beside = pairs.into_par_iter();
        let mut all: Vec<Beside<'_>> = beside.map(|(law, start)| self.beside(law, start)).collect();
        all.sort_by(|a, b| a.deviance.total_cmp(&b.deviance));
        // What promises far less than the effects bring is not simulated.
        let [without, with] = self.deviances;
        all.retain(|beside| without - beside.deviance >= RIVAL * (without - with));
        let rivals = all.iter().take(SIMULATED * starts.len());
        let rivals = rivals.filter_map(|beside| self.rival(beside));
        let rivals = rivals.filter(|rival| (rival.fit + rival.check).is_finite());
        rivals.max_by(|a, b| (a.fit + a.check).total_cmp(&(b.fit + b.check)))
    }

    /// What all parameters, a law's numbers and the beginnings do to the fitted logs, without the effects.
    fn columns(&self, law: &Law<'_>) -> Columns {
        let begins = self.fit_begins.columns();
        let columns = self.own.iter().chain(law.columns.iter()).chain(begins);
        columns.cloned().collect()
    }

    /// A law beside all parameters. Weighed in each round by what the last one left, as of a large gap the first is weighed by
    /// the gap itself.
    fn beside<'b>(&self, law: &'b Law<'b>, start: &'b Fit) -> Beside<'b> {
        let columns = self.columns(law);
        let (step, deviance) = self.linear(&columns, law, start);
        Beside {
            law,
            from: &start.state,
            deviance: deviance + BY_CHANCE * law.columns.len() as f64,
            step,
        }
    }

    /// A curve with these values as a Gaussian process among the [`Contest::columns`]; none of a term.
    fn curve<'b>(&self, law: &'b Law<'_>, values: &'b [f64]) -> Option<Smooth<'b>> {
        let correlation = law.correlation.as_ref()?;
        Some(Smooth {
            first: self.own.len(),
            correlation,
            values,
        })
    }

    /// Where D of the linearised model is least with these columns, those of a law among them, and D there.
    fn linear(&self, columns: &Columns, law: &Law<'_>, start: &Fit) -> (DVector<f64>, f64) {
        let fitter = self.without.fitter();
        let none = vec![0.0; law.columns.len()];
        let curve = self.curve(law, &none);
        let mut left = start.rest.clone();
        let mut step = DVector::zeros(columns.len());
        for _ in 0..ROUNDS {
            step = fitter
                .solve_beside(&left, start, columns, curve.as_ref())
                .step;
            left.clone_from(&start.rest);
            for (column, by) in columns.iter().zip(step.iter()) {
                let pairs = left.iter_mut().flatten().zip(column.iter().flatten());
                pairs.for_each(|(l, c)| *l -= c * *by);
            }
        }
        let deviance = fitter.set.layout.deviance(&left)
            + fitter.departure(&fitter.moved(&start.state, &step, 1.0));
        (step, deviance)
    }

    /// Share of what the effects bring on the fitted logs that they still bring beside a law, as the linearised model has
    /// it: little where the law does what they do.
    pub(super) fn effects_beside(&self, law: &LawInPlace) -> f64 {
        let is_it = |form: &Form<'_>| match (form, law) {
            (Form::Curve(own, _), LawInPlace::Curve { index, .. }) => own == index,
            (Form::Term(own, _), LawInPlace::Term(words)) => own.words == *words,
            _ => false,
        };
        let Some(law) = self.laws.iter().find(|law| is_it(&law.form)) else {
            return 0.0;
        };
        let [without, with] = self.deviances;
        let start = &self.without.fit;
        let pairs = start.rest.iter().zip(&self.effects.fit.rest);
        let does: Amplitudes = pairs
            .map(|(before, after)| before.iter().zip(after).map(|(b, a)| b - a).collect())
            .collect();
        let mut columns = self.columns(law);
        let (_, of_law) = self.linear(&columns, law, start);
        columns.push(does);
        let (_, of_both) = self.linear(&columns, law, start);
        (of_law - of_both) / (without - with).max(f64::MIN_POSITIVE)
    }

    /// A law, simulated. `None` if the machine does not run with it.
    fn rival(&self, beside: &Beside<'_>) -> Option<Rival> {
        let [without, with] = self.deviances;
        let numbers = beside.law.columns.len();
        let (over, law, fitted, [check, effects_check]) = match &beside.law.form {
            Form::Curve(index, shape) => {
                let (fitted, values) = self.refitted_curve(shape, beside)?;
                let falls = self.falls_with_curve(shape, &fitted, &values)?;
                let law = LawInPlace::Curve {
                    index: *index,
                    values,
                };
                (shape.depends_on(), law, fitted.deviance, falls)
            }
            Form::Term(term, active) => {
                let fitted = self.refitted_term(active, beside)?;
                let layout = &self.without.fit_logs.layout;
                let left = self.fit_begins.taken_out(layout, fitted.rest);
                let departure = self.without.fitter().departure(&fitted.state);
                let deviance = layout.deviance(&left) + departure;
                let with_term = self.without.checker().at(fitted.state).ok()?;
                let falls = [&with_term, &self.effects.check].map(|with| self.fall(with));
                (
                    term.depends_on(),
                    LawInPlace::Term(term.words),
                    deviance,
                    falls,
                )
            }
        };
        Some(Rival {
            over,
            law,
            numbers,
            fit: without - fitted - BY_CHANCE * numbers as f64,
            check,
            effects_fit: without - with,
            effects_check,
        })
    }

    /// Fall of D of the check logs with something.
    fn fall(&self, with: &Fit) -> f64 {
        let set = &self.without.check_logs;
        let [before, after] = [&self.without.check, with].map(|fit| {
            let rest = set.amplitudes(&set.rest(&fit.traces));
            let left = self.check_begins.taken_out(&set.layout, rest);
            set.layout.deviance(&left)
        });
        before - after
    }

    /// Fall of D of the check logs with a curve, and with the effects on the same samples: beyond the outermost knots nothing is
    /// known of the curve, so nothing counts there of either.
    fn falls_with_curve(&self, shape: &Shape, fitted: &Fit, values: &[f64]) -> Option<[f64; 2]> {
        let (checker, check) = (self.without.checker(), &self.without.check);
        let (set, begins) = (checker.set, &self.check_begins);
        let moved = checker.at(fitted.state.clone()).ok()?;
        let fall = |mut after: Residual| {
            let mut before = set.rest(&check.traces);
            shape.fall_inside(&checker, check, [&mut before, &mut after], begins)
        };
        let with_law = fall(shape.rest(checker.machine, set, &moved, values).ok()?);
        // With other parameters the rest may be nearer by itself; the law must do it.
        let by_itself = shape.held_out_evidence(&checker, &moved, values, begins);
        let with_effects = fall(set.rest(&self.effects.check.traces));
        Some([with_law.min(by_itself), with_effects])
    }

    /// A short term fitted together with all that is there, from where the linearised model leads; `None` also if the 95 %
    /// interval of its own number holds zero: then it is what it is taken with, and another law.
    fn refitted_term(&self, active: &ActiveEffect, beside: &Beside<'_>) -> Option<Fit> {
        let fitter = self.without.fitter();
        let at = |length: f64| {
            let mut state = fitter.moved(beside.from, &beside.step, length);
            let mut active = active.clone();
            let sizes = (active.values.iter_mut()).zip(active.effect.parameters);
            let sizes = sizes.filter(|(_, parameter)| parameter.is_size());
            let steps = beside.step.iter().skip(self.own.len());
            sizes
                .zip(steps)
                .for_each(|((size, _), by)| *size = length * by);
            state.effects.push(active);
            fitter.at(state).ok()
        };
        let start = SHORTER.iter().find_map(|length| at(*length))?;
        let fit = fitter.refine(start, &self.own, ROUNDS);
        let added = fit.state.effects.last()?;
        let mut numbers = added.values.iter().zip(added.effect.parameters);
        let (number, _) = numbers.find(|(_, parameter)| parameter.is_size())?;
        let deviation = fitter.deviation_of_added(&fit, &self.own);
        (number.abs() > 1.96 * deviation).then_some(fit)
    }

    /// A curve fitted together with all that is there, from where the linearised model leads on with simulations: known
    /// parameters may have moved far to make up for it. The curve's values, and the fit with it, of
    /// which the beginnings are taken out.
    fn refitted_curve(&self, shape: &Shape, beside: &Beside<'_>) -> Option<(Fit, Vec<f64>)> {
        let fitter = self.without.fitter();
        let at = |from: &State, values: &[f64], step: &DVector<f64>, length: f64| {
            let alone = fitter.at(fitter.moved(from, step, length)).ok()?;
            let steps = step.iter().skip(self.own.len());
            let values: Vec<f64> = (values.iter().zip(steps))
                .map(|(value, by)| value + length * by)
                .collect();
            let rest = shape.rest(fitter.machine, fitter.set, &alone, &values);
            let rest = fitter.set.amplitudes(&rest.ok()?);
            let rest = self.fit_begins.taken_out(&fitter.set.layout, rest);
            let deviance = fitter.set.layout.deviance(&rest) + fitter.departure(&alone.state);
            let fit = Fit {
                rest,
                deviance,
                ..alone
            };
            Some((fit, values))
        };
        let columns = self.columns(beside.law);
        let none = vec![0.0; shape.knots.len()];
        let mut best =
            (SHORTER.iter()).find_map(|length| at(beside.from, &none, &beside.step, *length))?;
        for _ in 0..ROUNDS {
            let (fit, values) = &best;
            let curve = self.curve(beside.law, values);
            let step = fitter
                .solve_beside(&fit.rest, fit, &columns, curve.as_ref())
                .step;
            let next = (SHORTER.iter()).find_map(|length| {
                let next = at(&fit.state, values, &step, *length)?;
                (next.0.deviance < fit.deviance - ENOUGH).then_some(next)
            });
            match next {
                Some(next) => best = next,
                None => break,
            }
        }
        Some(best)
    }
}
