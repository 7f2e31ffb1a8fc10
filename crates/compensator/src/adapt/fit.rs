//! Gauss–Newton on one record: the most probable parameters of it and of what was known.

use std::vec::Vec;

use nalgebra::{SMatrix, SVector};

use super::parameter::{AdaptParameter, Belief, COUNT, Theta};
use super::record::Record;
use super::residual::{NUISANCES, Residuals, Weights};

/// Parameters and nuisances.
pub(super) const ALL: usize = COUNT + NUISANCES;
/// Information about the parameters alone.
pub(super) type Information = SMatrix<f64, COUNT, COUNT>;
type Full = SMatrix<f64, ALL, ALL>;
type Column = SVector<f64, ALL>;

/// Most Gauss–Newton steps.
const STEPS: usize = 30;
/// A step below this share of the standard error ends them.
const CLOSE: f64 = 1e-2;
/// Deviations of the prior beyond which it gives way.
const GIVES_WAY: f64 = 2.0;
/// No move tells a parameter to better than this: a model is none of the axis to more.
const MODEL: f64 = 5e-4;

/// What was known before the record.
pub(super) struct Known<'a> {
    pub belief: &'a Belief,
    /// Estimate that `information` is about.
    pub estimate: Theta,
    pub information: Information,
}

/// What a record says.
pub(super) struct Fit {
    pub estimate: Theta,
    /// Of the record and of what was known, the prior left out.
    pub information: Information,
    /// Posterior variances, the prior included.
    pub variances: Theta,
    /// RMS of the torque balance before and after, N·m.
    pub rms: [f64; 2],
}

impl Known<'_> {
    /// Whether a coordinate is free.
    fn free(&self, record: &Record, i: usize) -> bool {
        match AdaptParameter::ALL.get(i) {
            Some(AdaptParameter::Compliance) => {
                record.sees_load && self.belief.adapts(AdaptParameter::Compliance)
            }
            Some(&parameter) => self.belief.adapts(parameter),
            None => Residuals::has_nuisance(self.belief, record, i - COUNT),
        }
    }

    /// Precision of the prior of a coordinate at a value.
    fn precision(&self, record: &Record, i: usize, value: f64) -> f64 {
        let deviation = match AdaptParameter::ALL.get(i) {
            Some(&parameter) => self.belief.prior.of(parameter).deviation,
            None => Residuals::nuisance_deviation(self.belief, record, i - COUNT),
        };
        let far = (value.abs() / deviation / GIVES_WAY).max(1.0);
        1.0 / (deviation * far).powi(2)
    }

    fn bounds(&self, i: usize) -> [f64; 2] {
        match AdaptParameter::ALL.get(i) {
            Some(&parameter) => self.belief.bounds(parameter),
            None => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// Gradient and curvature of the prior and of what was known.
    fn before(&self, record: &Record, at: &Column) -> (Column, Full) {
        let (mut gradient, mut curvature) = (Column::zeros(), Full::zeros());
        for i in 0..ALL {
            let precision = self.precision(record, i, at[i]);
            gradient[i] = precision * at[i];
            curvature[(i, i)] = precision;
        }
        for i in 0..COUNT {
            for j in 0..COUNT {
                let information = self.information[(i, j)];
                gradient[i] += information * (at[j] - self.estimate[j]);
                curvature[(i, j)] += information;
            }
        }
        (gradient, curvature)
    }

    /// Twice the negative logarithm of prior and record, but for a constant. The prior's
    /// precisions are those at `from`.
    fn cost(&self, record: &Record, at: &Column, from: &Column, r: &Residuals, w: &Weights) -> f64 {
        let prior = |i: usize| self.precision(record, i, from[i]) * at[i] * at[i];
        let away = SVector::<f64, COUNT>::from_fn(|i, _| at[i] - self.estimate[i]);
        (0..ALL).map(prior).sum::<f64>() + away.dot(&(self.information * away)) + r.square(w)
    }

    /// The most probable parameters of what was known and the record.
    pub fn fit(&self, record: &Record) -> Fit {
        let mut at = Column::zeros();
        for i in 0..COUNT {
            at[i] = self.estimate[i];
        }
        let free: Vec<usize> = (0..ALL).filter(|&i| self.free(record, i)).collect();
        let mut residuals = Residuals::at(self.belief, record, &at, &free);
        let rms = residuals.rms(0);
        let mut weights = residuals.weights(record, free.len(), true);
        let mut settled = 0;
        for _ in 0..STEPS {
            let (gradient, curvature) = self.normal(record, &at, &residuals, &weights);
            let held = |i: &usize| {
                let [least, most] = self.bounds(*i);
                (at[*i] <= least && gradient[*i] > 0.0) || (at[*i] >= most && gradient[*i] < 0.0)
            };
            let moving: Vec<usize> = free.iter().copied().filter(|i| !held(i)).collect();
            let Some(inverse) = inverse(&curvature, &moving) else {
                break;
            };
            let step = -(inverse * gradient);
            let before = self.cost(record, &at, &at, &residuals, &weights);
            let mut share = 1.0;
            let mut better = None;
            while share > 1e-3 && better.is_none() {
                let mut next = at + share * step;
                for i in 0..ALL {
                    let [least, most] = self.bounds(i);
                    next[i] = next[i].clamp(least, most);
                }
                let there = Residuals::at(self.belief, record, &next, &free);
                let cost = self.cost(record, &next, &at, &there, &weights);
                // Not a number is no improvement.
                if cost <= before {
                    better = Some((next, there));
                }
                share *= 0.5;
            }
            let small = |i: &usize| step[*i].abs() <= CLOSE * inverse[(*i, *i)].sqrt();
            let close = moving.iter().all(small);
            let stuck = better.is_none();
            if let Some((next, there)) = better {
                (at, residuals) = (next, there);
            }
            // First all alike, then by what is left: weights of residuals far off would keep
            // them there.
            if close || stuck {
                settled += 1;
                if settled > 2 {
                    break;
                }
            }
            weights = residuals.weights(record, free.len(), settled == 0);
        }
        self.result(record, &at, &residuals, &weights, &free, rms)
    }

    fn normal(&self, record: &Record, at: &Column, r: &Residuals, w: &Weights) -> (Column, Full) {
        let (mut gradient, mut curvature) = self.before(record, at);
        r.add_to(w, &mut gradient, &mut curvature);
        (gradient, curvature)
    }

    fn result(
        &self,
        record: &Record,
        at: &Column,
        residuals: &Residuals,
        weights: &Weights,
        free: &[usize],
        before: f64,
    ) -> Fit {
        if let Ok(p) = std::env::var("DUMP") {
            use std::fmt::Write;
            let mut o = String::new();
            for (i, q) in record.points.iter().enumerate() {
                writeln!(
                    o,
                    "{} {} {} {} {} {} {}",
                    q.sample,
                    residuals.values[0][i],
                    residuals.values[1].get(i).unwrap_or(&0.0),
                    q.left,
                    q.acceleration,
                    record.speeds[q.sample],
                    q.transmitted
                )
                .unwrap();
            }
            std::fs::write(p, o).unwrap();
        }
        // What the record says of the parameters once the nuisances are integrated out.
        let (mut unused, mut of_record) = (Column::zeros(), Full::zeros());
        residuals.add_to(weights, &mut unused, &mut of_record);
        for i in COUNT..ALL {
            of_record[(i, i)] += self.precision(record, i, at[i]);
        }
        let nuisances: Vec<usize> = free.iter().copied().filter(|&i| i >= COUNT).collect();
        let within = inverse(&of_record, &nuisances).unwrap_or_else(Full::zeros);
        let marginal = of_record - of_record * within * of_record;
        let parameters: Vec<usize> = free.iter().copied().filter(|&i| i < COUNT).collect();
        // (M⁻¹ + ε²)⁻¹ = M − M (M + ε⁻²)⁻¹ M, whatever M does not determine.
        let mut blunt = marginal;
        for i in 0..COUNT {
            blunt[(i, i)] += 1.0 / (MODEL * MODEL);
        }
        let blunt = inverse(&blunt, &parameters).unwrap_or_else(Full::zeros);
        let blunted = marginal - marginal * blunt * marginal;
        let mut information = self.information;
        for &i in &parameters {
            for &j in &parameters {
                information[(i, j)] += 0.5 * (blunted[(i, j)] + blunted[(j, i)]);
            }
        }
        let mut all = Full::zeros();
        for i in 0..COUNT {
            all[(i, i)] = self.precision(record, i, at[i]);
            for j in 0..COUNT {
                all[(i, j)] += information[(i, j)];
            }
        }
        let adapted: Vec<usize> = (0..COUNT).filter(|&i| all[(i, i)].is_finite()).collect();
        let covariance = inverse(&all, &adapted).unwrap_or_else(Full::zeros);
        Fit {
            estimate: std::array::from_fn(|i| at[i]),
            information,
            variances: std::array::from_fn(|i| covariance[(i, i)].max(0.0)),
            rms: [before, residuals.rms(0)],
        }
    }
}

/// Inverse of the rows and columns of `kept`, scaled so that units do not matter; 0
/// elsewhere.
fn inverse(curvature: &Full, kept: &[usize]) -> Option<Full> {
    let scale = |i: usize| 1.0 / curvature[(i, i)].abs().sqrt().max(1e-150);
    let mut scaled = Full::identity();
    for &i in kept {
        for &j in kept {
            scaled[(i, j)] = curvature[(i, j)] * scale(i) * scale(j);
        }
    }
    let mut inverse = scaled.cholesky()?.inverse();
    for i in 0..ALL {
        for j in 0..ALL {
            let both = kept.contains(&i) && kept.contains(&j);
            inverse[(i, j)] *= if both { scale(i) * scale(j) } else { 0.0 };
        }
    }
    Some(inverse)
}
