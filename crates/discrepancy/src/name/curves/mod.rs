//! Curves over variables of the motion, and the loop's answers to them.

mod beginnings;
mod course;
mod rest;
mod shape;
mod variable;

use axis_sim::{Axis, Probe};
use rayon::prelude::*;

pub use self::beginnings::Beginnings;
pub use self::course::{Course, STANDS, angles, courses, slope};
pub use self::rest::{Rest, Solved};
pub use self::shape::Shape;
pub use self::variable::{Factor, Over, Place, Variable, depends_on};
use crate::answers::LogSet;
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::spectrum::Amplitudes;

/// All curves that are tried: a line each, the simple ones first.
const CURVES: &[(Place, Factor, Variable)] = &[
    (Place::Force, Factor::One, Variable::Speed),
    (Place::Force, Factor::One, Variable::Position),
    (Place::Force, Factor::One, Variable::Time),
    (Place::Force, Factor::One, Variable::Angle),
    (Place::Force, Factor::One, Variable::Acceleration),
    (Place::Force, Factor::One, Variable::Effort),
    (Place::Offset, Factor::One, Variable::Speed),
    (Place::Offset, Factor::One, Variable::Position),
    (Place::Offset, Factor::One, Variable::Time),
    (Place::Offset, Factor::One, Variable::Angle),
    (Place::Offset, Factor::One, Variable::Effort),
    (Place::Force, Factor::Speed, Variable::Position),
    (Place::Force, Factor::Speed, Variable::Time),
    (Place::Force, Factor::Direction, Variable::Position),
    (Place::Force, Factor::Direction, Variable::Time),
    (Place::Force, Factor::Direction, Variable::Angle),
    (Place::Force, Factor::Direction, Variable::Acceleration),
    (Place::Force, Factor::Direction, Variable::Effort),
];

/// The loop's answers to all curves on a set of logs.
#[derive(Debug, Default)]
pub struct Curves {
    pub shapes: Vec<(Shape, Columns)>,
}

impl Curves {
    /// Simulates them at a fit; what they are on the motion hardly depends on
    /// the fit, so they may be kept.
    pub fn new(machine: &Axis, set: &LogSet, fit: &Fit) -> Self {
        let courses = courses(machine, set, &fit.traces);
        let moves = |v: Variable| courses.iter().all(|c| !c.of(v).is_empty());
        let all = CURVES.iter().filter(|(_, _, v)| moves(*v));
        let shapes: Vec<Shape> = all
            .map(|&(place, factor, v)| Shape::new(place, factor, v, &courses))
            .collect();
        let fitter = Fitter { machine, set };
        let answers = |shape: Shape| {
            let columns = shape.columns(&fitter, fit, &courses);
            (shape, columns)
        };
        Self {
            shapes: shapes.into_par_iter().map(answers).collect(),
        }
    }
}

/// What the loop makes of a disturbance of unit size with this course, one
/// series a log.
pub fn answer(fitter: &Fitter<'_>, fit: &Fit, place: Place, series: Vec<Vec<f64>>) -> Amplitudes {
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
