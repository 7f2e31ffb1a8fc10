//! The residual and fits nothing in the library: where it sits, on what it
//! depends, and a curve.
//!
//! A force on the table, or a displacement between screw and table, is let
//! depend on one variable of the motion by a curve of hat functions. The loop
//! answers to each hat (by simulation), known parameters and named effects are
//! fitted out, and what a curve explains beyond chance, on logs that were not
//! fitted as well, is not in the model. The curve with the most is reported,
//! and a short term that does as much, if there is one. Terms are empirical.

use axis_sim::{Axis, ReplayError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::term::{Short, Sought};
use crate::estimate::fit::Fitter;
use crate::name::curves::{Place, Rest, Solved};
use crate::name::gap::is_material;
use crate::name::search::{Found, needed};
use crate::noise::Excess;
use crate::posterior::Answer;

/// Something that is in the logs, and neither in the model nor in the library.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Unknown {
    /// Where it acts.
    pub channel: String,
    /// On what it depends, as far as one variable shows it.
    pub depends_on: String,
    /// A short term over the same with its number, empirical; `None` if none does
    /// nearly as much as the curve.
    pub formula: Option<String>,
    /// The curve.
    pub curve: Curve,
    /// Fall of D on the fit logs (0 of what was looked for on the check logs
    /// alone), and on the check logs.
    pub evidence: [f64; 2],
}

/// A curve over a variable of the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Curve {
    /// Variable with its unit.
    pub variable: String,
    /// Unit of the values.
    pub unit: String,
    /// Places of the variable.
    pub at: Vec<f64>,
    /// Value there.
    pub value: Vec<f64>,
    /// Half-width of its 95 % interval; 0 if there is none.
    pub within: Vec<f64>,
}

/// What no effect explains, if there is any: significant on both sets of logs,
/// and `material` at least.
///
/// # Errors
/// [`ReplayError`] if the fitted machine no longer runs the check logs.
pub fn lack(machine: &Axis, found: &Found, material: f64) -> Result<Option<Unknown>, ReplayError> {
    let fitter = Fitter {
        machine,
        set: &found.fit_logs,
    };
    let checker = Fitter {
        machine,
        set: &found.check_logs,
    };
    let check = checker.at(found.fit.state.clone())?;
    let curves = &found.library.curves;
    let rest = Rest::new(&fitter, &found.fit, &found.columns, &found.noise);
    let layout = &found.fit_logs.layout;
    let needed = |knots: usize| needed(layout, knots, curves.shapes.len(), 0.01).max(material);
    let knots = |i: usize| curves.shapes[i].0.knots.len();
    let solved = curves.shapes.iter().map(|(_, columns)| rest.solve(columns));
    let mut solved: Vec<(usize, Solved)> = solved.enumerate().collect();
    solved.retain(|(i, s)| s.gain >= needed(knots(*i)));
    solved.sort_by(|a, b| b.1.gain.total_cmp(&a.1.gain));
    let held_out = |i: usize, s: &Solved| -> f64 {
        let shape = &curves.shapes[i].0;
        shape.told(machine, &found.check_logs, &check, s.values.as_slice())
    };
    let is_above_noise = |s: &Solved| s.gain >= ABOVE * s.of_noise;
    let least = |s: &Solved| (0.1 * s.gain).max(25.0);
    let tried = solved.iter().filter(|(_, s)| is_above_noise(s));
    let told = tried.take(TOLD).map(|(i, s)| (*i, s, held_out(*i, s)));
    let told: Vec<(usize, &Solved, f64)> = told.collect();
    tracing::debug!(curves = ?told.iter().map(|(i, s, told)| (curves.shapes[*i].0.place, curves.shapes[*i].0.depends_on(), s.gain, s.of_noise, told)).collect::<Vec<_>>(), "what depends on what");
    // Of those that are significant, the one that tells most of other motion.
    let holds = told
        .iter()
        .filter(|(_, s, told)| *told >= least(s))
        .copied();
    let holds: Vec<(usize, &Solved, f64)> = holds.collect();
    let most = holds.iter().map(|t| t.2).fold(f64::NEG_INFINITY, f64::max);
    // The simplest of those that tell about as much: they stand in the order of the list.
    let about = holds.into_iter().filter(|t| t.2 >= ABOUT * most);
    let first = about.min_by_key(|t| t.0);
    // A short term goes on where the curve ends, and may hold where no curve does.
    let Some(explains_most) = first.or(told.first().copied()) else {
        return Ok(None);
    };
    // A law that took the place of effects was simulated, and did better than they did.
    let (place, sought) = match found.law_in_place() {
        Some(words) => (Place::Force, Sought::Law(words)),
        None => {
            let (i, curve, _) = explains_most;
            (curves.shapes[i].0.place, Sought::AsGoodAs(curve.gain))
        }
    };
    let short = Short::of([&fitter, &checker], found, &check, &rest, place, sought);
    let set = &found.check_logs;
    let short = short.and_then(|short| {
        let over = |i: &usize| {
            let shape = &curves.shapes[*i].0;
            shape.place == place && (shape.variable, shape.factor) == short.over()
        };
        let (i, solution) = solved.iter().find(|(i, _)| over(i))?;
        let left = set.amplitudes(short.left());
        let told = set.layout.deviance(&check.rest) - set.layout.deviance(&left);
        tracing::debug!(over = ?short.over(), gain = short.gain(), told, "a short term");
        (told >= least(solution)).then_some((short, (*i, solution, told)))
    });
    // A term with its one number that does as much as the knots of any curve says better on what it
    // depends.
    let as_short = short.as_ref().filter(|(short, _)| {
        matches!(sought, Sought::Law(_)) || first.is_none_or(|first| short.gain() >= first.1.gain)
    });
    let (index, solution, told) = match (as_short, first) {
        (Some((_, of_it)), _) => *of_it,
        (None, Some(first)) => first,
        (None, None) => return Ok(None),
    };
    let after = match as_short {
        Some((short, _)) => short.left().clone(),
        None => (curves.shapes[index].0).rest(machine, set, &check, solution.values.as_slice())?,
    };
    if !is_material(machine, set, &check, &after, || None, &[])? {
        return Ok(None);
    }
    let (shape, freedom) = (&curves.shapes[index].0, machine.freedom());
    // One over something else says less than the curve, and would contradict it.
    let short = short.filter(|(_, (of_it, ..))| *of_it == index);
    Ok(Some(Unknown {
        channel: shape.place.name().to_owned(),
        depends_on: shape.depends_on(),
        formula: short.map(|(short, _)| short.formula(freedom)),
        curve: Curve {
            variable: format!(
                "{}, {}",
                shape.variable.name(),
                shape.variable.unit(freedom)
            ),
            unit: shape.unit(freedom).to_owned(),
            at: shape.knots.clone(),
            value: solution.values.iter().copied().collect(),
            within: solution.deviations.iter().map(|d| 1.96 * d).collect(),
        },
        evidence: [solution.gain, told],
    }))
}

/// The law outside the library that is probable, in words and figures.
///
/// # Errors
/// As [`lack`].
pub fn lack_of(
    machine: &Axis,
    found: &Found,
    answer: &Answer,
) -> Result<Option<Unknown>, ReplayError> {
    let Some(law) = &answer.law else {
        return Ok(None);
    };
    let [fitter, checker] = [&found.fit_logs, &found.check_logs].map(|set| Fitter { machine, set });
    let check = checker.at(found.fit.state.clone())?;
    let (shape, columns) = &found.library.curves.shapes[law.law];
    let rest = Rest::new(&fitter, &found.fit, &found.columns, &found.noise);
    let gain = rest.solve(columns).gain;
    let as_good = Sought::AsGoodAs(gain);
    let short = Short::of(
        [&fitter, &checker],
        found,
        &check,
        &rest,
        shape.place,
        as_good,
    );
    let short = short.filter(|short| short.over() == (shape.variable, shape.factor));
    let values: Vec<f64> = law.values.iter().map(|v| v[0]).collect();
    let told = shape.told(machine, &found.check_logs, &check, &values);
    let freedom = machine.freedom();
    Ok(Some(Unknown {
        channel: shape.place.name().to_owned(),
        depends_on: shape.depends_on(),
        formula: short.map(|short| short.formula(freedom)),
        curve: Curve {
            variable: format!(
                "{}, {}",
                shape.variable.name(),
                shape.variable.unit(freedom)
            ),
            unit: shape.unit(freedom).to_owned(),
            at: shape.knots.clone(),
            within: law.values.iter().map(|v| 1.96 * v[1]).collect(),
            value: values,
        },
        evidence: [gain, told],
    }))
}

/// Curves of which it is seen how much they tell of other motion.
const TOLD: usize = 6;

/// Share of what the best curve tells of other motion that a simpler one must tell to be
/// taken in its place.
const ABOUT: f64 = 0.9;

/// Fall of D that a curve must bring, over what noise alone brings in the mean:
/// near zero frequency that is far above its average in a band.
const ABOVE: f64 = 8.0;

/// What is known of a residual that shows in no curve over the motion.
pub fn in_frequency(excess: Excess) -> Unknown {
    let (worst, fall) = excess.out[0];
    let ([low, high], _) = excess.bands[worst];
    let middles = excess
        .bands
        .iter()
        .map(|([low, high], _)| 0.5 * (low + high));
    let values: Vec<f64> = excess.bands.iter().map(|(_, v)| *v).collect();
    Unknown {
        channel: "residual of all channels together".to_owned(),
        depends_on: format!("frequency, most from {low:.0} to {high:.0} Hz"),
        formula: None,
        curve: Curve {
            variable: "frequency, Hz".to_owned(),
            unit: "times the power of the noise".to_owned(),
            at: middles.collect(),
            within: vec![0.0; values.len()],
            value: values,
        },
        evidence: [0.0, fall],
    }
}
