//! What is known before a record: the prior, and what earlier moves said.

use nalgebra::{SMatrix, SVector};

use super::assumed::AssumedModel;
use super::coordinates::GAP;
use super::parameter::{AdaptParameter, COUNT, Theta};
use super::record::Record;
use super::residual::{NUISANCES, Residuals};

/// Parameters and nuisances.
pub(super) const ALL: usize = COUNT + NUISANCES;
/// Information about the parameters alone.
pub(super) type Information = SMatrix<f64, COUNT, COUNT>;
/// About all coordinates.
pub(super) type Full = SMatrix<f64, ALL, ALL>;
/// All coordinates.
pub(super) type Column = SVector<f64, ALL>;

/// Deviations of the prior beyond which it gives way.
const GIVES_WAY: f64 = 2.0;

/// What was known before the record.
pub(super) struct Known<'a> {
    pub assumed: &'a AssumedModel,
    /// Estimate that `information` is about.
    pub estimate: Theta,
    pub information: Information,
    /// Half the free travel as estimated from earlier moves, and its variance; rad at the motor.
    pub gap: [f64; 2],
}

impl Known<'_> {
    /// Whether a coordinate is free.
    pub fn free(&self, record: &Record, i: usize) -> bool {
        match AdaptParameter::ALL.get(i) {
            Some(AdaptParameter::Compliance) => {
                record.sees_load && self.assumed.adapts(AdaptParameter::Compliance)
            }
            Some(&parameter) => self.assumed.adapts(parameter),
            None => Residuals::has_nuisance(self.assumed, record, i),
        }
    }

    /// Precision of the prior of a coordinate at a value. Beyond two deviations its pull
    /// falls with the distance, so that data which insist win.
    pub fn precision(&self, record: &Record, i: usize, value: f64) -> f64 {
        let deviation = match AdaptParameter::ALL.get(i) {
            Some(&parameter) => self.assumed.prior.of(parameter).deviation,
            None => Residuals::nuisance_deviation(self.assumed, record, i),
        };
        let far = ((value - self.mean(i)).abs() / deviation / GIVES_WAY).max(1.0);
        let spread = deviation * far;
        1.0 / (spread * spread)
    }

    /// Mean of the prior of a coordinate: 0 but for half the free travel that is assumed.
    fn mean(&self, i: usize) -> f64 {
        match i {
            GAP => self.assumed.half_gap(),
            _ => 0.0,
        }
    }

    /// Least and greatest value of a coordinate.
    pub fn bounds(&self, i: usize) -> [f64; 2] {
        match AdaptParameter::ALL.get(i) {
            Some(&parameter) => self.assumed.bounds(parameter),
            None => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// Gradient and curvature of half the cost of all that is known, the record included.
    pub fn normal(
        &self,
        record: &Record,
        at: &Column,
        residuals: &Residuals,
        weights: &[std::vec::Vec<f64>; 2],
    ) -> (Column, Full) {
        let (mut gradient, mut curvature) = (Column::zeros(), Full::zeros());
        for i in 0..ALL {
            // What is not free has no prior either; its row is never used.
            let precision = self.precision(record, i, at[i]).min(1e300);
            gradient[i] = precision * (at[i] - self.mean(i));
            curvature[(i, i)] = precision;
        }
        let away = SVector::<f64, COUNT>::from_fn(|i, _| at[i] - self.estimate[i]);
        let pull = self.information * away;
        gradient[GAP] += (at[GAP] - self.gap[0]) / self.gap[1];
        curvature[(GAP, GAP)] += 1.0 / self.gap[1];
        for i in 0..COUNT {
            gradient[i] += pull[i];
            for j in 0..COUNT {
                curvature[(i, j)] += self.information[(i, j)];
            }
        }
        residuals.add_to(weights, &mut gradient, &mut curvature);
        (gradient, curvature)
    }

    /// Twice the negative logarithm of the probability of `at`, but for a constant. The
    /// prior's precisions are those at `from`.
    pub fn cost(&self, record: &Record, [at, from]: [&Column; 2], free: &[usize]) -> f64 {
        let prior = |&i: &usize| {
            let away = at[i] - self.mean(i);
            self.precision(record, i, from[i]) * away * away
        };
        let gap = at[GAP] - self.gap[0];
        let away = SVector::<f64, COUNT>::from_fn(|i, _| at[i] - self.estimate[i]);
        free.iter().map(prior).sum::<f64>()
            + gap * gap / self.gap[1]
            + away.dot(&(self.information * away))
    }
}
