//! Short terms that may do as much as a curve.

use axis_sim::Axis;
use rayon::prelude::*;

use crate::estimate::fit::{Columns, Fitter};
use crate::name::curves::{Course, Place, Rest, STANDS, Solved, answer, courses};
use crate::name::search::Found;

/// Of time (s), place (m), speed (m/s) and direction (−1 to 1).
type Value = fn(f64, f64, f64, f64) -> f64;

/// A term: its words and its course. `x` counts from the middle of the motion.
struct Term {
    words: &'static str,
    unit: &'static str,
    value: Value,
    /// What it is taken with: a zero of its own, say.
    beside: Option<Value>,
}

const FORCES: [Term; 12] = [
    term_of("√|v|·sign v", "N·(s/m)^½", |_, _, v, s| {
        v.abs().sqrt() * s
    }),
    term_of("|v|·v", "N·s²/m²", |_, _, v, _| v * v.abs()),
    term_of("v³", "N·s³/m³", |_, _, v, _| v.powi(3)),
    with("x·v", "N·s/m²", |_, x, v, _| x * v, |_, _, v, _| v),
    with("x·sign v", "N/m", |_, x, _, s| x * s, |_, _, _, s| s),
    with("x", "N/m", |_, x, _, _| x, |_, _, _, _| 1.0),
    with("x²", "N/m²", |_, x, _, _| x * x, |_, _, _, _| 1.0),
    term_of("exp(−t / 1 s)·sign v", "N", |t, _, _, s| (-t).exp() * s),
    term_of("exp(−t / 3 s)·sign v", "N", |t, _, _, s| {
        (-t / 3.0).exp() * s
    }),
    term_of("exp(−t / 10 s)·sign v", "N", |t, _, _, s| {
        (-t / 10.0).exp() * s
    }),
    with("t·sign v", "N/s", |t, _, _, s| t * s, |_, _, _, s| s),
    with("t", "N/s", |t, _, _, _| t, |_, _, _, _| 1.0),
];

const OFFSETS: [Term; 4] = [
    term_of("x²", "1/m", |_, x, _, _| x * x),
    term_of("x³", "1/m²", |_, x, _, _| x.powi(3)),
    term_of("t·x", "1/s", |t, x, _, _| t * x),
    term_of("v", "s", |_, _, v, _| v),
];

const fn term_of(words: &'static str, unit: &'static str, value: Value) -> Term {
    Term {
        words,
        unit,
        value,
        beside: None,
    }
}

const fn with(words: &'static str, unit: &'static str, value: Value, beside: Value) -> Term {
    Term {
        words,
        unit,
        value,
        beside: Some(beside),
    }
}

/// The short term that explains most, where it does nearly as much as the curve.
pub(super) fn term(
    machine: &Axis,
    fitter: &Fitter<'_>,
    found: &Found,
    rest: &Rest<'_>,
    place: Place,
    curve: f64,
) -> Option<String> {
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
    Some(format!(
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
    ))
}
