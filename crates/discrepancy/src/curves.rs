//! Curves over variables of the motion, and the loop's answers to them.

use std::sync::Arc;

use axis_sim::effects::{self, Measure};
use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, Probe, ReplayError, Trace};
use rayon::prelude::*;

use crate::fit::{Columns, Fit, Fitter};
use crate::model::LogSet;
use crate::noise::Rest;
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
    Acceleration,
    /// What the drive gives: its current, or its command.
    Effort,
}

/// What a curve is multiplied by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    One,
    Speed,
    /// Of motion: −1 to 1, without a jump.
    Direction,
}

/// All curves that are tried: a line each, the simple ones first.
const CURVES: &[(Place, Factor, Variable)] = &[
    (Place::Force, Factor::One, Variable::Speed),
    (Place::Force, Factor::One, Variable::Position),
    (Place::Force, Factor::One, Variable::Time),
    (Place::Force, Factor::One, Variable::Angle),
    (Place::Force, Factor::One, Variable::Acceleration),
    (Place::Offset, Factor::One, Variable::Speed),
    (Place::Offset, Factor::One, Variable::Position),
    (Place::Offset, Factor::One, Variable::Time),
    (Place::Offset, Factor::One, Variable::Angle),
    (Place::Offset, Factor::One, Variable::Effort),
    (Place::Force, Factor::Speed, Variable::Position),
    (Place::Force, Factor::Speed, Variable::Time),
    (Place::Force, Factor::Direction, Variable::Position),
    (Place::Force, Factor::Direction, Variable::Time),
    (Place::Force, Factor::Direction, Variable::Effort),
];

impl Variable {
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Position => "position",
            Self::Time => "time",
            Self::Angle => "motor angle in its turn",
            Self::Acceleration => "acceleration",
            Self::Effort => "what the drive gives",
        }
    }

    /// On a load that moves like this.
    pub fn unit(self, freedom: Freedom) -> &'static str {
        match self {
            Self::Speed => Measure::Speed.unit(freedom),
            Self::Position => Measure::Way.unit(freedom),
            Self::Time => "s",
            Self::Angle => "rad",
            Self::Acceleration => Measure::Acceleration.unit(freedom),
            Self::Effort => "in the unit of the drive's channel",
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
    pub acceleration: Vec<f64>,
    /// Empty where no channel shows it.
    pub effort: Vec<f64>,
}

impl Course {
    fn of(&self, variable: Variable) -> &[f64] {
        match variable {
            Variable::Speed => &self.speed,
            Variable::Position => &self.position,
            Variable::Time => &self.time,
            Variable::Angle => &self.angle,
            Variable::Acceleration => &self.acceleration,
            Variable::Effort => &self.effort,
        }
    }
}

/// Channels that show what a drive gives.
const EFFORTS: [&str; 5] = [
    "iq_a",
    "iq_ref_a",
    "torque_ref_n_m",
    "force_ref_n",
    "drive_command_v",
];

/// Speed below which a direction is not one, m/s.
pub const STANDS: f64 = 1e-3;

pub fn course(machine: &Axis, set: &LogSet, traces: &[Trace], log: usize) -> Course {
    let trace = &traces[log];
    let position = trace.position().to_vec();
    let radians = 1.0 / machine.travel_per_radian();
    let turn = |x: &f64| (x * radians).rem_euclid(std::f64::consts::TAU);
    let period = set.logs[log].period;
    let effort = EFFORTS.iter().find_map(|name| trace.channel(name));
    Course {
        time: (0..position.len()).map(|k| k as f64 * period).collect(),
        angle: position.iter().map(turn).collect(),
        acceleration: slope(&trace.speed, period),
        effort: effort.unwrap_or_default().to_vec(),
        speed: trace.speed.clone(),
        position,
    }
}

/// Central differences.
fn slope(samples: &[f64], period: f64) -> Vec<f64> {
    let last = samples.len().saturating_sub(1);
    let at = |k: usize| {
        let (from, to) = (k.saturating_sub(1), (k + 1).min(last));
        (samples[to] - samples[from]) / (period * (to - from).max(1) as f64)
    };
    (0..samples.len()).map(at).collect()
}

/// A curve: where it acts, on what it depends, and its hats' places.
#[derive(Debug)]
pub struct Shape {
    pub place: Place,
    pub factor: Factor,
    pub variable: Variable,
    pub knots: Vec<f64>,
}

/// Hats of a curve, and of one that is multiplied by something.
pub const KNOTS: usize = 10;
const KNOTS_OF_PRODUCT: usize = 6;

impl Shape {
    pub fn new(place: Place, factor: Factor, variable: Variable, courses: &[Course]) -> Self {
        let all = courses.iter().flat_map(|c| c.of(variable));
        let (low, high) = all.fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
        let count = if factor == Factor::One {
            KNOTS
        } else {
            KNOTS_OF_PRODUCT
        };
        let knots = match variable {
            Variable::Angle => (0..count)
                .map(|j| std::f64::consts::TAU * j as f64 / count as f64)
                .collect(),
            // Denser where machines are slow; none at rest, where the sign jumps.
            Variable::Speed => {
                let half = count / 2;
                let up = |j: usize| ((j + 1) as f64 / half as f64).powi(2);
                let down = (0..half).rev().map(|j| low.min(-STANDS) * up(j));
                down.chain((0..half).map(|j| high.max(STANDS) * up(j)))
                    .collect()
            }
            _ => (0..count)
                .map(|j| low + (high - low) * j as f64 / (count - 1) as f64)
                .collect(),
        };
        Self {
            place,
            factor,
            variable,
            knots,
        }
    }

    /// Whether it is over what an effect is shown over, or over a product with it.
    pub fn is_over(&self, variable: effects::Variable) -> bool {
        match variable {
            effects::Variable::Speed => {
                self.variable == Variable::Speed || self.factor != Factor::One
            }
            effects::Variable::Position => self.variable == Variable::Position,
            effects::Variable::MotorAngle => self.variable == Variable::Angle,
            effects::Variable::Acceleration => self.variable == Variable::Acceleration,
            effects::Variable::Current => self.variable == Variable::Effort,
            effects::Variable::Way | effects::Variable::Time => self.variable == Variable::Time,
        }
    }

    /// What is left on logs of which this is the fit with these values at the knots.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run with it.
    pub fn rest(
        &self,
        machine: &Axis,
        set: &LogSet,
        fit: &Fit,
        values: &[f64],
    ) -> Result<Rest, ReplayError> {
        let sum = |course: &Course| {
            let mut total = vec![0.0; course.time.len()];
            for (j, by) in values.iter().enumerate() {
                for (t, h) in total.iter_mut().zip(self.hat(j, course)) {
                    *t += by * h;
                }
            }
            total
        };
        let probes: Vec<Probe> = (courses(machine, set, &fit.traces).iter())
            .map(|course| self.place.probe(sum(course)))
            .collect();
        Ok(set.rest(&set.simulate_with(machine, &fit.state, Some(&probes))?))
    }

    /// Fall of D on logs that were not fitted, of which this is the fit, with these values at
    /// the knots; nothing where it does not run.
    pub fn told(&self, machine: &Axis, set: &LogSet, fit: &Fit, values: &[f64]) -> f64 {
        let rest = self.rest(machine, set, fit, values);
        rest.map_or(f64::NEG_INFINITY, |rest| {
            set.layout.deviance(&fit.rest) - set.layout.deviance(&set.amplitudes(&rest))
        })
    }

    /// On what it depends, in words.
    pub fn depends_on(&self) -> String {
        match self.factor {
            Factor::One => self.variable.name().to_owned(),
            Factor::Speed => format!("the product of speed and {}", self.variable.name()),
            Factor::Direction => format!("{} and the direction of motion", self.variable.name()),
        }
    }

    /// Unit of its values.
    pub fn unit(&self, freedom: Freedom) -> &'static str {
        match (self.place, self.factor) {
            (Place::Force, Factor::Speed) => Measure::Damping.unit(freedom),
            (Place::Force, _) => Measure::Force.unit(freedom),
            (Place::Offset, _) => Measure::Way.unit(freedom),
        }
    }

    /// The hat of knot j, in time.
    pub fn hat(&self, j: usize, c: &Course) -> Vec<f64> {
        let values = c.of(self.variable);
        let factor = |k: usize| match self.factor {
            Factor::One => 1.0,
            Factor::Speed => c.speed[k],
            Factor::Direction => (c.speed[k] / STANDS).tanh(),
        };
        let samples = |k: usize| match values.get(k) {
            Some(&at) => factor(k) * self.hat_at(j, at),
            None => 0.0,
        };
        (0..c.time.len()).map(samples).collect()
    }

    fn hat_at(&self, j: usize, at: f64) -> f64 {
        match self.variable {
            Variable::Speed => {
                let same_way = |x: f64| (x > 0.0) == (self.knots[j] > 0.0);
                if !same_way(at) {
                    return 0.0;
                }
                // Flat inward of the slowest knot, and nothing at rest.
                let moving = (at / STANDS).tanh().abs();
                moving
                    * self.linear(j, at, |i| {
                        self.knots.get(i).copied().filter(|x| same_way(*x))
                    })
            }
            Variable::Angle => {
                let step = std::f64::consts::TAU / self.knots.len() as f64;
                let away = (at - self.knots[j]).rem_euclid(std::f64::consts::TAU);
                let away = away.min(std::f64::consts::TAU - away);
                (1.0 - away / step).max(0.0)
            }
            _ => self.linear(j, at, |i| self.knots.get(i).copied()),
        }
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
        let moves = |v: Variable| courses.iter().all(|c| !c.of(v).is_empty());
        let all = CURVES.iter().filter(|(_, _, v)| moves(*v));
        let shapes: Vec<Shape> = all
            .map(|&(place, factor, v)| Shape::new(place, factor, v, &courses))
            .collect();
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
