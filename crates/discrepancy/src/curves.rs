//! Curves over variables of the motion, and the loop's answers to them.

use std::sync::Arc;

use axis_sim::{Axis, Probe, Trace};
use rayon::prelude::*;

use crate::fit::{Columns, Fit, Fitter};
use crate::model::LogSet;
use crate::spectrum::Amplitudes;

/// Where a disturbance acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Force,
    Offset,
}

impl Place {
    /// Size of a probe, small beside what the axis feels: N, m.
    pub fn size(self) -> f64 {
        match self {
            Self::Force => 10.0,
            Self::Offset => 2e-7,
        }
    }

    pub fn unit(self) -> &'static str {
        match self {
            Self::Force => "N",
            Self::Offset => "m",
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "torque balance (as a force at the table, against positive motion)",
            Self::Offset => "kinematics (as a displacement of the table on the screw)",
        }
    }

    pub fn probe(self, samples: Vec<f64>) -> Probe {
        match self {
            Self::Force => Probe::Load(samples.into()),
            Self::Offset => Probe::Offset(Arc::from(samples)),
        }
    }
}

/// A variable of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    Speed,
    Position,
    Time,
    Angle,
}

pub const VARIABLES: [Variable; 4] = [
    Variable::Speed,
    Variable::Position,
    Variable::Time,
    Variable::Angle,
];

impl Variable {
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Position => "position",
            Self::Time => "time",
            Self::Angle => "motor angle in its turn",
        }
    }

    pub fn unit(self) -> &'static str {
        match self {
            Self::Speed => "m/s",
            Self::Position => "m",
            Self::Time => "s",
            Self::Angle => "rad",
        }
    }
}

/// The motion of one log as simulated.
pub struct Course {
    pub time: Vec<f64>,
    pub position: Vec<f64>,
    pub speed: Vec<f64>,
    /// In [0, 2π).
    pub angle: Vec<f64>,
}

/// Speed below which a direction is not one, m/s.
pub const STANDS: f64 = 1e-3;

pub fn course(machine: &Axis, set: &LogSet, traces: &[Trace], log: usize) -> Course {
    let trace = &traces[log];
    let position = trace.position().to_vec();
    let radians = 1.0 / machine.travel_per_radian();
    let turn = |x: &f64| (x * radians).rem_euclid(std::f64::consts::TAU);
    Course {
        time: (0..position.len())
            .map(|k| k as f64 * set.logs[log].period)
            .collect(),
        angle: position.iter().map(turn).collect(),
        speed: trace.speed.clone(),
        position,
    }
}

/// A curve: where it acts, on what it depends, and its hats' places.
#[derive(Debug)]
pub struct Shape {
    pub place: Place,
    pub variable: Variable,
    pub knots: Vec<f64>,
}

/// Hats of a curve.
pub const KNOTS: usize = 10;

impl Shape {
    pub fn new(place: Place, variable: Variable, courses: &[Course]) -> Self {
        let of = |c: &Course| match variable {
            Variable::Speed => c.speed.clone(),
            Variable::Position => c.position.clone(),
            Variable::Time => c.time.clone(),
            Variable::Angle => c.angle.clone(),
        };
        let all = courses.iter().flat_map(of);
        let (low, high) = all.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        let knots = match variable {
            Variable::Angle => (0..KNOTS)
                .map(|j| std::f64::consts::TAU * j as f64 / KNOTS as f64)
                .collect(),
            // Denser where machines are slow; none at rest, where the sign jumps.
            Variable::Speed => {
                let half = KNOTS / 2;
                let up = |j: usize| ((j + 1) as f64 / half as f64).powi(2);
                let down = (0..half).rev().map(|j| low.min(-STANDS) * up(j));
                down.chain((0..half).map(|j| high.max(STANDS) * up(j)))
                    .collect()
            }
            _ => (0..KNOTS)
                .map(|j| low + (high - low) * j as f64 / (KNOTS - 1) as f64)
                .collect(),
        };
        Self {
            place,
            variable,
            knots,
        }
    }

    /// The hat of knot j, in time.
    pub fn hat(&self, j: usize, c: &Course) -> Vec<f64> {
        let samples = |k: usize| match self.variable {
            Variable::Speed => {
                let v = c.speed[k];
                if (v > 0.0) != (self.knots[j] > 0.0) {
                    return 0.0;
                }
                // Flat inward of the slowest knot, and nothing at rest.
                let moving = (v / STANDS).tanh().abs();
                moving
                    * self.linear(j, v, |i| {
                        self.knots
                            .get(i)
                            .copied()
                            .filter(|x| (*x > 0.0) == (self.knots[j] > 0.0))
                    })
            }
            Variable::Angle => {
                let step = std::f64::consts::TAU / KNOTS as f64;
                let away = (c.angle[k] - self.knots[j]).rem_euclid(std::f64::consts::TAU);
                let away = away.min(std::f64::consts::TAU - away);
                (1.0 - away / step).max(0.0)
            }
            Variable::Position => self.linear(j, c.position[k], |i| self.knots.get(i).copied()),
            Variable::Time => self.linear(j, c.time[k], |i| self.knots.get(i).copied()),
        };
        (0..c.time.len()).map(samples).collect()
    }

    /// Hat j of piecewise linear interpolation, flat beyond the ends.
    pub fn linear(&self, j: usize, x: f64, knot: impl Fn(usize) -> Option<f64>) -> f64 {
        let own = self.knots[j];
        let next = if x < own {
            j.checked_sub(1).and_then(knot)
        } else {
            knot(j + 1)
        };
        match next {
            Some(next) => (1.0 - (x - own) / (next - own)).max(0.0),
            None => 1.0,
        }
    }
}

/// The motions of all logs.
pub fn courses(machine: &Axis, set: &LogSet, traces: &[Trace]) -> Vec<Course> {
    (0..set.logs.len())
        .map(|log| course(machine, set, traces, log))
        .collect()
}

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
