//! Short terms that may do as much as a curve.

use axis_sim::ReplayError;
use axis_sim::effects::ActiveEffect;
use axis_sim::mechanism::Freedom;
use rayon::prelude::*;

use super::units::ReadUnit;
use crate::answers;
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::name::curves::{Over, Place, Rest, Solved, answer, courses};
use crate::name::search::Found;
use crate::name::terms::{Term, middle, terms};

/// Share of what a curve explains that a term must explain to be said in its place: it has one
/// number, where the curve has ten.
const SHORT: f64 = 0.8;

/// Which term is looked for.
#[derive(Clone, Copy)]
pub(super) enum Sought<'a> {
    /// One that does nearly as much as a curve that makes D fall by this.
    AsGoodAs(f64),
    /// The one of these words.
    Law(&'a str),
}

/// A short term, with its number.
pub(super) struct Short {
    term: &'static Term,
    place: Place,
    middle: f64,
    /// Fall of D on the fit logs, as the linearised model has it.
    gain: f64,
    /// The term's number, and its standard deviation.
    number: [f64; 2],
    /// The number of what it is taken with, if it is.
    beside: Option<f64>,
    /// The residual with it on the check logs.
    left: answers::Rest,
}

impl Short {
    /// The term that explains most at a place, of those that are sought, fitted: with known
    /// parameters and effects for a force. `check` is the fit of the check logs without it.
    /// `None` also where the machine does not run with it.
    pub(super) fn of(
        [fitter, checker]: [&Fitter<'_>; 2],
        found: &Found,
        check: &Fit,
        rest: &Rest<'_>,
        place: Place,
        sought: Sought<'_>,
    ) -> Option<Self> {
        let machine = fitter.machine;
        let motions = courses(machine, fitter.set, &found.fit.traces);
        let middle = middle(&motions);
        let tried = |term: &'static Term| {
            let column = |mut course: Vec<Vec<f64>>| {
                // Of the size of a probe, whatever the term's unit.
                let most = course.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
                let most = most.max(f64::MIN_POSITIVE);
                course.iter_mut().flatten().for_each(|v| *v /= most);
                let mut column = answer(fitter, &found.fit, place, course);
                column.iter_mut().flatten().for_each(|c| *c *= most);
                column
            };
            let series = term.series(&motions, middle).into_iter();
            let columns: Columns = series.map(column).collect();
            (term, rest.solve(&columns))
        };
        let all: Vec<(&Term, Solved)> = terms(place).par_iter().map(tried).collect();
        let most = all
            .into_iter()
            .filter(|(term, solved)| match sought {
                Sought::AsGoodAs(curve) => solved.gain >= SHORT * curve,
                Sought::Law(words) => term.words == words,
            })
            .max_by(|a, b| a.1.gain.total_cmp(&b.1.gain));
        let (term, solved) = most?;
        let set = checker.set;
        let (number, beside, traces) = match term.as_effect(&motions) {
            Some(active) => {
                let begun = Term::sized(active, solved.values.as_slice());
                let (fit, deviation) = fitted(fitter, found, begun).ok()?;
                let last = &fit.state.effects[fit.state.effects.len() - 1];
                let [factor, per_size] = Term::factor(last);
                let traces = set.simulate(machine, &fit.state).ok()?;
                (
                    [factor, per_size * deviation],
                    Term::factor_beside(last),
                    traces,
                )
            }
            None => {
                let motions = courses(machine, set, &check.traces);
                let probes = term.probes(place, solved.values.as_slice(), &motions, middle);
                let traces = set
                    .simulate_with(machine, &check.state, Some(&probes))
                    .ok()?;
                let beside = solved.values.get(1).copied();
                ([solved.values[0], solved.deviations[0]], beside, traces)
            }
        };
        Some(Self {
            term,
            place,
            middle,
            gain: solved.gain,
            number,
            beside,
            left: set.rest(&traces),
        })
    }

    /// On what it depends.
    pub(super) fn over(&self) -> Over {
        self.term.over
    }

    /// Fall of D on the fit logs.
    pub(super) fn gain(&self) -> f64 {
        self.gain
    }

    /// Whether the 95 % interval of its number leaves out zero.
    pub(super) fn is_determined(&self) -> bool {
        let [number, deviation] = self.number;
        number.abs() > 1.96 * deviation
    }

    /// The residual with it on the check logs.
    pub(super) fn left(&self) -> &answers::Rest {
        &self.left
    }

    /// In words, for a load that moves like this.
    pub(super) fn formula(&self, freedom: Freedom) -> String {
        let Term {
            words,
            unit,
            beside,
            ..
        } = self.term;
        let about = match has_place(words) {
            true => format!(", x from {:.3} {}", self.middle, turned("m", freedom)),
            false => String::new(),
        };
        let what = match self.place {
            Place::Force => "force",
            Place::Offset => "displacement",
        };
        let number = said(self.number, turned(unit, freedom));
        let (mut law, mut numbers) = (format!("c · {words}"), format!("c = {number}"));
        if let (Some(with), Some(factor)) = (beside, self.beside) {
            let times = if with.words.is_empty() { "" } else { " · " };
            let factor = said_alone(factor, turned(with.unit, freedom));
            law.push_str(&format!(" + b{times}{}", with.words));
            numbers.push_str(&format!(", b = {factor}"));
        }
        format!("{what} = {law}{about}, {numbers} (empirical)")
    }
}

/// Whether the place x is in a formula, as which letters of a function's name do not count.
fn has_place(formula: &str) -> bool {
    let mut names = formula.split(|c: char| !c.is_alphabetic());
    names.any(|name| name == "x")
}

/// A number and its 95 % interval from its standard deviation, in this unit.
fn said([number, deviation]: [f64; 2], unit: String) -> String {
    let interval = [-1.96, 1.96].map(|by| number + by * deviation);
    if !(1e-3..1e6).contains(&number.abs()) {
        let [low, high] = interval;
        return format!("{number:.3e} {unit} (95 %: {low:.3e} to {high:.3e})");
    }
    let unit = ReadUnit {
        factor: 1.0,
        name: unit,
    };
    unit.said_within(number, interval)
}

/// A number without an interval.
fn said_alone(number: f64, unit: String) -> String {
    if number.abs() >= 1e6 || number != 0.0 && number.abs() < 1e-3 {
        return format!("{number:.3e} {unit}");
    }
    let unit = ReadUnit {
        factor: 1.0,
        name: unit,
    };
    unit.said(number)
}

/// Rounds of a fit with a term.
const ROUNDS: usize = 8;

/// The fit with one effect more, and the standard deviation of its first size.
fn fitted(
    fitter: &Fitter<'_>,
    found: &Found,
    active: ActiveEffect,
) -> Result<(Fit, f64), ReplayError> {
    let mut state = found.fit.state.clone();
    state.effects.push(active);
    let fit = fitter.refine(fitter.at(state)?, &found.columns, ROUNDS);
    let deviation = fitter.deviation_of_added(&fit, &found.columns);
    Ok((fit, deviation))
}

/// A unit of a load that moves along a line, as it is on one that moves like this.
fn turned(unit: &str, freedom: Freedom) -> String {
    match freedom {
        Freedom::Linear => unit.to_owned(),
        Freedom::Rotary => unit.replace('m', "rad").replace('N', "N·m"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Freedom, has_place, said, turned};

    #[test]
    fn what_turns_has_torques_and_angles() {
        assert_eq!(turned("N·s²/m²", Freedom::Linear), "N·s²/m²");
        assert_eq!(turned("N·s²/m²", Freedom::Rotary), "N·m·s²/rad²");
        assert_eq!(turned("1/m", Freedom::Rotary), "1/rad");
    }

    #[test]
    fn a_formula_says_from_where_it_counts_the_place_that_is_in_it() {
        assert!(
            ["x", "x²", "x·v", "t·x", "x·sign v"]
                .into_iter()
                .all(has_place)
        );
        assert!(!["exp(−t / 3 s)·sign v", "v³"].into_iter().any(has_place));
    }

    #[test]
    fn numbers_are_read_as_they_are() {
        let of = |number, deviation| said([number, deviation], "N/m".to_owned());
        assert_eq!(of(39.944, 0.0867), "39.94 N/m (95 %: 39.77 to 40.11)");
        assert_eq!(of(-18760.0, 306.0), "-18760 N/m (95 %: -19360 to -18160)");
        assert_eq!(of(2e-7, 1e-9), "2.000e-7 N/m (95 %: 1.980e-7 to 2.020e-7)");
    }
}
