//! The residual and fits nothing in the library: where it sits, on what it
//! depends, and a curve.
//!
//! A force on the table, or a displacement between screw and table, is let
//! depend on one variable of the motion by a curve of hat functions. The loop
//! answers to each hat (by simulation), known parameters and named effects are
//! fitted out, and what a curve explains beyond chance, on logs that were not
//! fitted as well, is not in the model. The curve with the most is reported,
//! and a short term that does as much, if there is one. Terms are empirical.

use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, ReplayError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::term::{Short, Sought};
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::name::curves::{Beginnings, Over, Place, Rest, Shape, Solved};
use crate::name::gap::is_material;
use crate::name::search::{Found, LawInPlace, needed};
use crate::noise::Excess;

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
    let [fitter, checker] = [&found.fit_logs, &found.check_logs].map(|set| Fitter { machine, set });
    let rest = Rest::new(&fitter, &found.fit, &found.columns, &found.noise);
    let check = checker.at(found.fit.state.clone())?;
    if let Some(said) = in_place([&fitter, &checker], found, &check, &rest) {
        return Ok(Some(said));
    }
    let curves = significant(found, &rest, material);
    let above_noise = curves.iter().filter(|curve| curve.is_above_noise);
    let tried = above_noise
        .take(TRIED)
        .map(|curve| held_out(curve, &checker, &check));
    let tried: Vec<HeldOut<'_>> = tried.collect();
    let holds = simplest_that_holds(&tried);
    // A short term goes on where the curve ends, and may hold where no curve does.
    let Some(explains_most) = holds.or(tried.first().copied()) else {
        return Ok(None);
    };
    let Significant { shape, solved, .. } = explains_most.curve;
    let (place, sought) = (shape.place, Sought::AsGoodAs(solved.gain));
    let short = Short::of([&fitter, &checker], found, &check, &rest, place, sought);
    let short = short.filter(Short::is_determined).and_then(|short| {
        let set = checker.set;
        let left = set.amplitudes(short.left());
        let evidence = set.layout.deviance(&check.rest) - set.layout.deviance(&left);
        tracing::debug!(over = ?short.over(), gain = short.gain(), evidence, "a short term");
        let curve = curves.iter().find(|c| c.is_over(place, short.over()))?;
        (evidence >= curve.least).then_some((short, HeldOut { curve, evidence }))
    });
    // A term with its one number that does as much as the knots of any curve says better on what it
    // depends.
    let does_as_much =
        |(short, _): &&(Short, _)| holds.is_none_or(|h| short.gain() >= h.curve.solved.gain);
    let as_short = short.as_ref().filter(does_as_much);
    let (of_it, after) = match (as_short, holds) {
        (Some((short, of_it)), _) => (*of_it, short.left().clone()),
        (None, Some(first)) => {
            let values = first.curve.solved.values.as_slice();
            let after = (first.curve.shape).rest(machine, checker.set, &check, values)?;
            (first, after)
        }
        (None, None) => return Ok(None),
    };
    if !is_material(machine, checker.set, &check, &after, || None, &[])? {
        return Ok(None);
    }
    // One over something else says less than the curve, and would contradict it.
    let short = short.filter(|(_, short)| short.curve.index == of_it.curve.index);
    let formula = short.map(|(short, _)| short.formula(machine.freedom()));
    let Significant { shape, solved, .. } = of_it.curve;
    let curve = (
        solved.values.iter().copied().collect(),
        solved.deviations.clone(),
    );
    let evidence = [solved.gain, of_it.evidence];
    let said = unknown(shape, machine.freedom(), curve, evidence, formula);
    Ok(Some(said))
}

/// The law that took the place of effects, if one did: it was fitted with simulations, and did better than they did.
fn in_place(
    logs: [&Fitter<'_>; 2],
    found: &Found,
    check: &Fit,
    rest: &Rest<'_>,
) -> Option<Unknown> {
    let (law, evidence) = found.law_in_place()?;
    let freedom = logs[0].machine.freedom();
    let curves = &found.library.curves.shapes;
    match law {
        LawInPlace::Curve { index, values } => {
            let (shape, columns) = &curves[*index];
            let solved = rest.solve(columns);
            let sought = Sought::AsGoodAs(solved.gain);
            let short = Short::of(logs, found, check, rest, shape.place, sought);
            let is_its = |short: &Short| short.over() == (shape.variable, shape.factor);
            let short = short.filter(|short| is_its(short) && short.is_determined());
            let formula = short.map(|short| short.formula(freedom));
            let curve = (values.clone(), solved.deviations);
            Some(unknown(shape, freedom, curve, evidence, formula))
        }
        LawInPlace::Term(words) => {
            let (force, sought) = (Place::Force, Sought::Law(words));
            let short = Short::of(logs, found, check, rest, force, sought)?;
            let is_over = |shape: &Shape| {
                shape.place == force && (shape.variable, shape.factor) == short.over()
            };
            let (shape, columns) = curves.iter().find(|(shape, _)| is_over(shape))?;
            let solved = rest.solve(columns);
            let curve = (solved.values.iter().copied().collect(), solved.deviations);
            let formula = Some(short.formula(freedom));
            Some(unknown(shape, freedom, curve, evidence, formula))
        }
    }
}

/// A curve with its values, their standard deviations and its formula as what has no name.
fn unknown(
    shape: &Shape,
    freedom: Freedom,
    (value, deviations): (Vec<f64>, Vec<f64>),
    evidence: [f64; 2],
    formula: Option<String>,
) -> Unknown {
    Unknown {
        channel: shape.place.name().to_owned(),
        depends_on: shape.depends_on(),
        formula,
        curve: Curve {
            variable: format!(
                "{}, {}",
                shape.variable.name(),
                shape.variable.unit(freedom)
            ),
            unit: shape.unit(freedom).to_owned(),
            at: shape.knots.clone(),
            value,
            within: deviations.iter().map(|d| 1.96 * d).collect(),
        },
        evidence,
    }
}

/// A curve that is significant on the fitted logs.
struct Significant<'a> {
    /// Its place in the list of curves, the simplest first.
    index: usize,
    shape: &'a Shape,
    solved: Solved,
    /// Fall of D of the check logs that is asked of it.
    least: f64,
    /// Whether it explains more of the fitted logs than noise would, if that is known.
    is_above_noise: bool,
}

impl Significant<'_> {
    fn is_over(&self, place: Place, over: Over) -> bool {
        self.shape.place == place && (self.shape.variable, self.shape.factor) == over
    }
}

/// A curve, and the fall of D of the check logs with it.
#[derive(Clone, Copy)]
struct HeldOut<'a> {
    curve: &'a Significant<'a>,
    evidence: f64,
}

/// The curves that are significant on the fitted logs, those that explain most first.
fn significant<'a>(found: &'a Found, rest: &Rest<'_>, material: f64) -> Vec<Significant<'a>> {
    let curves = &found.library.curves.shapes;
    let layout = &found.fit_logs.layout;
    let one = |(index, (shape, columns)): (usize, &'a (Shape, Columns))| {
        let solved = rest.solve(columns);
        let needed = needed(layout, shape.knots.len(), curves.len(), 0.01).max(material);
        let is_above_noise = solved.gain >= ABOVE * solved.of_noise;
        // What noise alone brings is not known of a balance, whose runs are its own rest, drawn anew,
        // with all that it lacks: other logs may say as much as is asked of those that it was fitted
        // to.
        let least = match is_above_noise {
            true => (0.1 * solved.gain).max(25.0),
            false => needed,
        };
        let is_above_noise = is_above_noise || found.fit_logs.is_balanced();
        (solved.gain >= needed).then_some(Significant {
            index,
            shape,
            solved,
            least,
            is_above_noise,
        })
    };
    let mut all: Vec<Significant<'a>> = curves.iter().enumerate().filter_map(one).collect();
    all.sort_by(|a, b| b.solved.gain.total_cmp(&a.solved.gain));
    all
}

/// One of them on the check logs.
fn held_out<'a>(curve: &'a Significant<'a>, checker: &Fitter<'_>, check: &Fit) -> HeldOut<'a> {
    let (values, begins) = (curve.solved.values.as_slice(), Beginnings::default());
    let evidence = curve
        .shape
        .held_out_evidence(checker, check, values, &begins);
    tracing::debug!(place = ?curve.shape.place, over = curve.shape.depends_on(), gain = curve.solved.gain, of_noise = curve.solved.of_noise, evidence, "what depends on what");
    HeldOut { curve, evidence }
}

/// Of those that hold on the check logs, the simplest of those that tell about as much as the best.
fn simplest_that_holds<'a>(tried: &[HeldOut<'a>]) -> Option<HeldOut<'a>> {
    let holds = tried.iter().filter(|t| t.evidence >= t.curve.least);
    let most = holds
        .clone()
        .map(|t| t.evidence)
        .fold(f64::NEG_INFINITY, f64::max);
    let about = holds.filter(|t| t.evidence >= ABOUT * most);
    about.min_by_key(|t| t.curve.index).copied()
}

/// Curves that are tried on the check logs.
const TRIED: usize = 6;

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
