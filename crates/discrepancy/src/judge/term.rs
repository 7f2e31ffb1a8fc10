//! Short terms that may do as much as a curve.

use axis_sim::Axis;
use rayon::prelude::*;

use crate::estimate::fit::{Columns, Fitter};
use crate::name::curves::{Course, Factor, Place, Rest, STANDS, Solved, Variable, answer, courses};
use crate::name::search::Found;

/// Of time (s), place (m), speed (m/s) and direction (−1 to 1).
type Value = fn(f64, f64, f64, f64) -> f64;

/// A term: its words and its course. `x` counts from the middle of the motion.
struct Term {
    /// On what it depends.
    over: Over,
    words: &'static str,
    unit: &'static str,
    value: Value,
    /// What it is taken with: a zero of its own, say.
    beside: Option<Value>,
}

/// On what a term depends, as a curve has it.
pub(super) type Over = (Variable, Factor);

const SPEED: Over = (Variable::Speed, Factor::One);
const POSITION: Over = (Variable::Position, Factor::One);
const POSITION_BY_SPEED: Over = (Variable::Position, Factor::Speed);
const POSITION_BY_DIRECTION: Over = (Variable::Position, Factor::Direction);
const TIME: Over = (Variable::Time, Factor::One);
const TIME_BY_DIRECTION: Over = (Variable::Time, Factor::Direction);

const FORCES: [Term; 12] = [
    term_of(SPEED, "√|v|·sign v", "N·(s/m)^½", |_, _, v, s| {
        v.abs().sqrt() * s
    }),
    term_of(SPEED, "|v|·v", "N·s²/m²", |_, _, v, _| v * v.abs()),
    term_of(SPEED, "v³", "N·s³/m³", |_, _, v, _| v.powi(3)),
    with(
        POSITION_BY_SPEED,
        "x·v",
        "N·s/m²",
        |_, x, v, _| x * v,
        |_, _, v, _| v,
    ),
    with(
        POSITION_BY_DIRECTION,
        "x·sign v",
        "N/m",
        |_, x, _, s| x * s,
        |_, _, _, s| s,
    ),
    with(POSITION, "x", "N/m", |_, x, _, _| x, |_, _, _, _| 1.0),
    with(POSITION, "x²", "N/m²", |_, x, _, _| x * x, |_, _, _, _| 1.0),
    term_of(
        TIME_BY_DIRECTION,
        "exp(−t / 1 s)·sign v",
        "N",
        |t, _, _, s| (-t).exp() * s,
    ),
    term_of(
        TIME_BY_DIRECTION,
        "exp(−t / 3 s)·sign v",
        "N",
        |t, _, _, s| (-t / 3.0).exp() * s,
    ),
    term_of(
        TIME_BY_DIRECTION,
        "exp(−t / 10 s)·sign v",
        "N",
        |t, _, _, s| (-t / 10.0).exp() * s,
    ),
    with(
        TIME_BY_DIRECTION,
        "t·sign v",
        "N/s",
        |t, _, _, s| t * s,
        |_, _, _, s| s,
    ),
    with(TIME, "t", "N/s", |t, _, _, _| t, |_, _, _, _| 1.0),
];

const OFFSETS: [Term; 4] = [
    term_of(POSITION, "x²", "1/m", |_, x, _, _| x * x),
    term_of(POSITION, "x³", "1/m²", |_, x, _, _| x.powi(3)),
    term_of(TIME, "t·x", "1/s", |t, x, _, _| t * x),
    term_of(SPEED, "v", "s", |_, _, v, _| v),
];

const fn term_of(over: Over, words: &'static str, unit: &'static str, value: Value) -> Term {
    Term {
        over,
        words,
        unit,
        value,
        beside: None,
    }
}

const fn with(
    over: Over,
    words: &'static str,
    unit: &'static str,
    value: Value,
    beside: Value,
) -> Term {
    Term {
        over,
        words,
        unit,
        value,
        beside: Some(beside),
    }
}

/// A short term, with its number.
pub(super) struct Short {
    /// On what it depends.
    pub over: Over,
    /// In words.
    pub formula: String,
    /// Fall of D on the fit logs.
    pub gain: f64,
}

/// The short term that explains most, where it does nearly as much as the curve.
pub(super) fn term(
    machine: &Axis,
    fitter: &Fitter<'_>,
    found: &Found,
    rest: &Rest<'_>,
    place: Place,
    curve: f64,
) -> Option<Short> {
    let terms: &[Term] = match place {
        Place::Force => &FORCES,
        Place::Offset => &OFFSETS,
    };
    let courses = courses(machine, fitter.set, &found.fit.traces);
    let positions = courses.iter().flat_map(|c| &c.position);
    let (low, high) = positions.fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    let middle = f64::midpoint(low, high);
    let series = |value: Value| -> Vec<Vec<f64>> {
        let one = |c: &Course| {
            let at = |k: usize| {
                let (x, v) = (c.position[k] - middle, c.speed[k]);
                value(c.time[k], x, v, (v / STANDS).tanh())
            };
            (0..c.time.len()).map(at).collect()
        };
        courses.iter().map(one).collect()
    };
    let tried = |term: &Term| {
        let values = [Some(term.value), term.beside];
        let columns: Columns = values
            .into_iter()
            .flatten()
            .map(|value| {
                // Of the size of a probe, whatever the term's unit.
                let mut course = series(value);
                let most = course.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
                let most = most.max(f64::MIN_POSITIVE);
                course.iter_mut().flatten().for_each(|v| *v /= most);
                let mut column = answer(fitter, &found.fit, place, course);
                column.iter_mut().flatten().for_each(|c| *c *= most);
                column
            })
            .collect();
        rest.solve(&columns)
    };
    let all: Vec<Solved> = terms.par_iter().map(tried).collect();
    let (term, solved) = terms
        .iter()
        .zip(&all)
        .max_by(|a, b| a.1.gain.total_cmp(&b.1.gain))?;
    if solved.gain < 0.8 * curve {
        return None;
    }
    let about = if term.words.contains('x') {
        format!(", x from {middle:.3} m")
    } else {
        String::new()
    };
    let formula = format!(
        "{} = {:.4e} {} · {}{about} (empirical; ± {:.1e})",
        if place == Place::Force {
            "force"
        } else {
            "displacement"
        },
        solved.values[0],
        term.unit,
        term.words,
        1.96 * solved.deviations[0]
    );
    Some(Short {
        over: term.over,
        formula,
        gain: solved.gain,
    })
}
