//! What is left and fits nothing in the library: where it sits, on what it
//! depends, and a curve.
//!
//! A force on the table, or a displacement between screw and table, is let
//! depend on one variable of the motion by a curve of hat functions. The loop
//! answers to each hat (by simulation), known parameters and named effects are
//! fitted out, and what a curve explains beyond chance, on logs that were not
//! fitted as well, is not in the model. The curve with the most is reported,
//! and a short term that does as much, where there is one. Terms are empirical.

mod motion;
mod term;

use axis_sim::effects::Machine;
use axis_sim::{Probe, ReplayError};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use self::motion::{Course, KNOTS, Place, Shape, VARIABLES, courses};
use self::term::term;
use crate::fit::{Columns, Fit, Fitter, pinned};
use crate::model::LogSet;
use crate::projector::Projector;
use crate::search::{Found, needed};

/// Something that is in the logs, and neither in the model nor in the library.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    /// Where it acts.
    pub channel: String,
    /// On what it depends, as far as one variable shows it.
    pub depends_on: String,
    /// A short term with its number, empirical; `None` where none does nearly
    /// as much as the curve.
    pub formula: Option<String>,
    /// The curve.
    pub curve: Curve,
    /// Fall of D on the fit logs (0 of what was looked for on the check logs
    /// alone), and on the check logs.
    pub evidence: [f64; 2],
}

/// A curve over a variable of the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Variable with its unit.
    pub variable: String,
    /// Unit of the values.
    pub unit: String,
    /// Places of the variable.
    pub at: Vec<f64>,
    /// Value there.
    pub value: Vec<f64>,
    /// Half-width of its 95 % interval; 0 where there is none.
    pub within: Vec<f64>,
}

/// The loop's answers to all curves on a set of logs.
#[derive(Debug, Default)]
pub struct Curves {
    shapes: Vec<(Shape, Columns)>,
}

impl Curves {
    /// Simulates them at a fit; what they are on the motion hardly depends on
    /// the fit, so they may be kept.
    pub fn new(machine: &Machine, set: &LogSet, fit: &Fit) -> Self {
        let courses = courses(machine, set, &fit.traces);
        let shapes = [Place::Force, Place::Offset]
            .into_iter()
            .flat_map(|place| VARIABLES.map(|v| Shape::new(place, v, &courses)));
        let shapes: Vec<Shape> = shapes.collect();
        let fitter = Fitter { machine, set };
        let answers = |shape: Shape| {
            let column = |j: usize| {
                let series = courses.iter().map(|c| shape.hat(j, c)).collect();
                answer(&fitter, fit, shape.place, series)
            };
            let columns = (0..shape.knots.len()).into_par_iter().map(column).collect();
            (shape, columns)
        };
        Self {
            shapes: shapes.into_par_iter().map(answers).collect(),
        }
    }
}

/// What the loop makes of a disturbance of unit size with this course, one
/// series a log.
fn answer(
    fitter: &Fitter<'_>,
    fit: &Fit,
    place: Place,
    series: Vec<Vec<f64>>,
) -> crate::spectrum::Amplitudes {
    let size = place.size();
    let probes: Vec<Probe> = series
        .into_iter()
        .map(|s| place.probe(s.into_iter().map(|v| size * v).collect()))
        .collect();
    let run = fitter
        .set
        .simulate_with(fitter.machine, &fit.state, Some(&probes));
    match run {
        Ok(traces) => fitter.set.difference(&traces, &fit.traces, size),
        Err(_) => fitter.nothing(fit),
    }
}

/// What no effect explains, if there is any: significant on both sets of logs,
/// and `material` at least.
///
/// # Errors
/// [`ReplayError`] where the fitted machine no longer runs the check logs.
pub fn lack(
    machine: &Machine,
    found: &Found,
    material: f64,
) -> Result<Option<Unknown>, ReplayError> {
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
    let rest = Rest::new(&fitter, found);
    let layout = &found.fit_logs.layout;
    let needed = needed(layout, KNOTS, curves.shapes.len(), 0.01).max(material);
    let mut solved: Vec<(usize, Solved)> = curves
        .shapes
        .iter()
        .enumerate()
        .map(|(i, (_, columns))| (i, rest.solve(columns)))
        .filter(|(_, s)| s.gain >= needed.max(ABOVE * s.of_noise))
        .collect();
    solved.sort_by(|a, b| b.1.gain.total_cmp(&a.1.gain));
    tracing::debug!(gains = ?solved.iter().map(|(i, s)| (curves.shapes[*i].0.place, curves.shapes[*i].0.variable, s.gain, s.of_noise)).collect::<Vec<_>>(), needed, "curves");
    // Of those that are significant, the one that tells most of other motion.
    let courses_check = courses(machine, &found.check_logs, &check.traces);
    let held_out = |(i, s): &(usize, Solved)| -> f64 {
        let shape = &curves.shapes[*i].0;
        let sum = |c: &Course| {
            let mut total = vec![0.0; c.time.len()];
            for (j, by) in s.values.iter().enumerate() {
                for (t, h) in total.iter_mut().zip(shape.hat(j, c)) {
                    *t += by * h;
                }
            }
            total
        };
        let probes: Vec<Probe> = courses_check
            .iter()
            .map(|c| shape.place.probe(sum(c)))
            .collect();
        let traces = found
            .check_logs
            .simulate_with(machine, &check.state, Some(&probes));
        traces.map_or(f64::NEG_INFINITY, |traces| {
            let set = &found.check_logs;
            let amplitudes = set.amplitudes(&set.rest(&traces));
            set.layout.deviance(&check.rest) - set.layout.deviance(&amplitudes)
        })
    };
    let best = solved
        .iter()
        .take(4)
        .map(|s| (s, held_out(s)))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let Some(((index, solution), told)) = best else {
        return Ok(None);
    };
    tracing::debug!(told, "curve on check logs");
    if told < (0.1 * solution.gain).max(25.0) {
        return Ok(None);
    }
    let shape = &curves.shapes[*index].0;
    let formula = term(machine, &fitter, found, &rest, shape.place, solution.gain);
    Ok(Some(Unknown {
        channel: shape.place.name().to_owned(),
        depends_on: shape.variable.name().to_owned(),
        formula,
        curve: Curve {
            variable: format!("{}, {}", shape.variable.name(), shape.variable.unit()),
            unit: shape.place.unit().to_owned(),
            at: shape.knots.clone(),
            value: solution.values.iter().copied().collect(),
            within: solution.deviations.iter().map(|d| 1.96 * d).collect(),
        },
        evidence: [solution.gain, told],
    }))
}

/// Fall of D that a curve must bring, over what noise alone brings in the mean:
/// near zero frequency that is far above its average in a band.
const ABOVE: f64 = 8.0;

/// The fitted logs' rest, with known parameters and effects fitted out.
struct Rest<'a> {
    fitter: &'a Fitter<'a>,
    whitener: crate::spectrum::Whitener,
    projector: Projector,
    rest: DVector<f64>,
    noise: Vec<DVector<f64>>,
}

struct Solved {
    gain: f64,
    /// Mean fall of D that noise alone would bring.
    of_noise: f64,
    values: DVector<f64>,
    deviations: Vec<f64>,
}

impl<'a> Rest<'a> {
    fn new(fitter: &'a Fitter<'a>, found: &Found) -> Self {
        let layout = &fitter.set.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(&found.fit.rest));
        let own = found.columns.iter();
        let own: Vec<DVector<f64>> = own.map(|c| layout.whiten(&whitener, c)).collect();
        let shares = &found.fit.state.shares;
        let projector = Projector::new(fitter.machine, &own, &pinned(fitter.machine, shares));
        let rest = projector.reject_at(&layout.whiten(&whitener, &found.fit.rest), shares);
        let white = |run| projector.reject(&layout.whiten(&whitener, run));
        let noise = found.noise.iter().map(white).collect();
        Self {
            noise,
            fitter,
            whitener,
            projector,
            rest,
        }
    }

    fn solve(&self, columns: &Columns) -> Solved {
        let layout = &self.fitter.set.layout;
        let seen: Vec<DVector<f64>> = columns
            .iter()
            .map(|c| self.projector.reject(&layout.whiten(&self.whitener, c)))
            .collect();
        let n = seen.len();
        let normal = DMatrix::from_fn(n, n, |i, j| seen[i].dot(&seen[j]));
        let right = DVector::from_fn(n, |i, _| seen[i].dot(&self.rest));
        // A hat that the motion hardly visits, or that the model's own
        // parameters can do, stays near 0.
        let ridge = 1e-6 * normal.diagonal().max();
        let inverse = (normal + DMatrix::identity(n, n) * ridge)
            .cholesky()
            .map(|c| c.inverse());
        let inverse = inverse.unwrap_or_else(|| DMatrix::zeros(n, n));
        let values = &inverse * &right;
        let gain_of_noise = |run: &DVector<f64>| {
            let right = DVector::from_fn(n, |i, _| seen[i].dot(run));
            right.dot(&(&inverse * &right))
        };
        let of_noise = self.noise.iter().map(gain_of_noise).sum::<f64>();
        let share = (values.dot(&right) / self.rest.norm_squared()).clamp(0.0, 0.999_999);
        Solved {
            gain: -(self.rest.len() as f64) * (1.0 - share).ln(),
            of_noise: of_noise / self.noise.len().max(1) as f64,
            deviations: (0..n).map(|i| inverse[(i, i)].max(0.0).sqrt()).collect(),
            values,
        }
    }
}
