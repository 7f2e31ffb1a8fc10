//! What the adapted model leaves unexplained along a log: the ground of a
//! [`ResidualLearner`](crate::ResidualLearner).

use std::vec::Vec;

use super::belief::Belief;
use super::known::Column;
use super::record::Record;
use super::residual::Residuals;
use super::{AdaptError, AdaptPrior, Adaptation};
use crate::{Sample, Unexplained};

/// Deviation of the Gaussian over the log, s: short, as cogging varies quickly.
const SMOOTHING: f64 = 1e-3;

/// The torque that a log needed besides the model's.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// At instants [`Rest::spacing`] apart.
    pub instants: Vec<Unexplained>,
    /// Time between them, s.
    pub spacing: f64,
    /// Deviation of the Gaussian that all signals have passed, s.
    pub smoothing: f64,
}

impl Adaptation {
    /// What the present model leaves unexplained along a log.
    ///
    /// # Errors
    /// As [`Adaptation::learn`], where the log is too short or not usable.
    pub fn unexplained(&self, log: &[Sample]) -> Result<Rest, AdaptError> {
        let belief = Belief {
            model: self.model(),
            prior: AdaptPrior::default(),
        };
        let record = Record::smoothed(&belief, log, SMOOTHING)?;
        let residuals = Residuals::at(&belief, &record, &Column::zeros(), &[]);
        let model = &belief.model;
        let shares = shares(&belief, &record);
        let points = record.points.iter().zip(residuals.torque());
        let instants = points.map(|(point, &torque)| {
            let sample = &log[point.sample];
            Unexplained {
                position: sample.position,
                motor_angle: sample.motor_angle,
                motor_speed: record.speeds[point.sample] * model.lever / model.travel,
                direction: shares[point.sample],
                torque,
            }
        });
        let instants: Vec<Unexplained> = instants.collect();
        let cycles = record.points.windows(2).map(|w| w[1].sample - w[0].sample);
        let spacing = cycles.min().unwrap_or(1) as f64 * record.period;
        Ok(Rest {
            instants,
            spacing,
            smoothing: SMOOTHING.max(record.period),
        })
    }
}

/// Share of the Coulomb level that the bristles hold at each sample, from relaxed on.
fn shares(belief: &Belief, record: &Record) -> Vec<f64> {
    let law = &belief.model.friction;
    let mut bristle = 0.0;
    let mut before = 0.0;
    let each = record.speeds.iter().map(|&speed| {
        bristle = law.step(bristle, before, speed, record.period);
        before = speed;
        law.coulomb_share(bristle)
    });
    each.collect()
}
