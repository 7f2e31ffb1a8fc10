//! A curve over a variable: hat functions, and what they do to logs.

use std::f64::consts::PI;

use axis_sim::effects::Measure;
use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, Probe, ReplayError};

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::answer;
use super::beginnings::Beginnings;
use super::course::{Course, STANDS, courses};
use super::variable::{Factor, Place, Variable, depends_on};
use crate::answers::{self, LogSet};
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};

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

/// Knots over which the values of a curve are alike.
const ALIKE: f64 = 3.0;

/// How far beyond its outermost knots a curve is taken to go on as there, as a share of what it
/// spans.
const BEYOND: f64 = 0.1;

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

    /// The residual on logs of which this is the fit with these values at the knots.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine does not run with it.
    pub fn rest(
        &self,
        machine: &Axis,
        set: &LogSet,
        fit: &Fit,
        values: &[f64],
    ) -> Result<answers::Rest, ReplayError> {
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
    /// the knots; nothing if it does not run. Motion beyond the outermost knots does not
    /// count: nothing tells how the curve goes on there.
    pub fn held_out_evidence(
        &self,
        checker: &Fitter<'_>,
        fit: &Fit,
        values: &[f64],
        begins: &Beginnings,
    ) -> f64 {
        let Ok(mut after) = self.rest(checker.machine, checker.set, fit, values) else {
            return f64::NEG_INFINITY;
        };
        let mut before = checker.set.rest(&fit.traces);
        self.fall_inside(checker, fit, [&mut before, &mut after], begins)
    }

    /// Fall of D from one residual to another where motion is within the outermost knots, beside what is not
    /// known of the beginnings of the logs.
    pub fn fall_inside(
        &self,
        checker: &Fitter<'_>,
        fit: &Fit,
        [before, after]: [&mut answers::Rest; 2],
        begins: &Beginnings,
    ) -> f64 {
        let set = checker.set;
        let inside: Vec<Vec<bool>> = (courses(checker.machine, set, &fit.traces).iter())
            .map(|course| self.inside(course))
            .collect();
        let all = inside.iter().flatten();
        let (counted, samples) = (all.clone().filter(|i| **i).count(), all.count());
        let [before, after] = [before, after].map(|rest| {
            for (channels, inside) in rest.iter_mut().zip(&inside) {
                for channel in channels {
                    let beyond = channel.iter_mut().zip(inside).filter(|(_, i)| !**i);
                    beyond.for_each(|(r, _)| *r = 0.0);
                }
            }
            let left = begins.taken_out(&set.layout, set.amplitudes(rest));
            set.layout.deviance(&left)
        });
        // As many independent values as count.
        (before - after) * counted as f64 / samples.max(1) as f64
    }

    /// Of each sample of a motion, whether the fitted motion went so far.
    fn inside(&self, course: &Course) -> Vec<bool> {
        let (Some(&low), Some(&high)) = (self.knots.first(), self.knots.last()) else {
            return Vec::new();
        };
        if self.variable == Variable::Angle {
            return vec![true; course.time.len()];
        }
        let [below, above] = match self.variable {
            // Either way has its own knots.
            Variable::Speed => [BEYOND * low.abs(), BEYOND * high.abs()],
            _ => [BEYOND * (high - low); 2],
        };
        let values = course.of(self.variable).iter();
        values
            .map(|x| (low - below..=high + above).contains(x))
            .collect()
    }

    /// What each of its hats does to the logs of a fit, on the courses of its motion.
    pub(super) fn columns(&self, fitter: &Fitter<'_>, fit: &Fit, courses: &[Course]) -> Columns {
        let column = |j: usize| {
            let series = courses.iter().map(|c| self.hat(j, c)).collect();
            answer(fitter, fit, self.place, series)
        };
        (0..self.knots.len()).into_par_iter().map(column).collect()
    }

    /// Correlation of its values: Matérn's of order 3/2 over [`ALIKE`] knots (Rasmussen and Williams, Gaussian Processes for Machine
    /// Learning, 2006, equation 4.17). Either way over speed is by itself, as a law may jump at standstill.
    pub fn correlation(&self) -> DMatrix<f64> {
        let count = self.knots.len();
        let away = |i: usize, j: usize| match self.variable {
            Variable::Speed if (2 * i < count) != (2 * j < count) => f64::INFINITY,
            // The chord of a circle of as many knots.
            Variable::Angle => {
                let turn = PI / count as f64;
                (turn * i.abs_diff(j) as f64).sin() / turn
            }
            _ => i.abs_diff(j) as f64,
        };
        DMatrix::from_fn(count, count, |i, j| {
            match 3.0_f64.sqrt() * away(i, j) / ALIKE {
                f64::INFINITY => 0.0,
                r => (1.0 + r) * (-r).exp(),
            }
        })
    }

    /// On what it depends, in words.
    pub fn depends_on(&self) -> String {
        depends_on((self.variable, self.factor))
    }

    /// Unit of its values.
    pub fn unit(&self, freedom: Freedom) -> &'static str {
        match (self.place, self.factor) {
            (Place::Force, Factor::Speed) => Measure::Damping.unit(freedom),
            (Place::Force, _) => Measure::Force.unit(freedom),
            (Place::Offset, _) => Measure::Displacement.unit(freedom),
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

#[cfg(test)]
mod tests {
    use super::{Course, Factor, Place, Shape, Variable};

    fn course(values: &[f64]) -> Course {
        Course {
            time: vec![0.0; values.len()],
            position: values.to_vec(),
            speed: values.to_vec(),
            angle: values.to_vec(),
            acceleration: values.to_vec(),
            effort: Vec::new(),
        }
    }

    #[test]
    fn motion_beyond_the_fitted_is_outside_of_a_curve() {
        let fitted = [course(&[-0.3, 0.0, 1.0])];
        let inside = |variable: Variable| {
            let shape = Shape::new(Place::Force, Factor::One, variable, &fitted);
            shape.inside(&course(&[-0.45, -0.4, -0.32, 0.5, 1.05, 1.2]))
        };
        // A tenth of the fastest that way.
        assert_eq!(
            inside(Variable::Speed),
            [false, false, true, true, true, false]
        );
        // A tenth of the whole way.
        assert_eq!(
            inside(Variable::Position),
            [false, true, true, true, true, false]
        );
        assert_eq!(inside(Variable::Angle), [true; 6]);
    }
}
