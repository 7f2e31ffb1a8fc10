//! What the adapted model leaves unexplained along a log: the ground of a
//! [`ResidualLearner`](crate::ResidualLearner).

use std::vec::Vec;

use super::assumed::AssumedModel;
use super::known::Column;
use super::record::Record;
use super::residual::Residuals;
use super::{AdaptError, AdaptPrior, Adaptation};
use crate::{Residual, ResidualAt, Sample, Unexplained};

/// Deviation of the Gaussian over the log, s: short, as cogging varies quickly; and not so
/// short that modes beyond the first, which no `DriveModel` has, pass it. Near them (from
/// some 80 Hz on, on the paper's axis) the torque that a motion needs is not the model's.
const SMOOTHING: f64 = 2.5e-3;

/// The torque that a log needed besides the model's.
#[derive(Clone, Debug, PartialEq)]
pub struct UnexplainedTorque {
    /// At instants [`UnexplainedTorque::spacing`] apart.
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
    pub fn unexplained(&self, log: &[Sample]) -> Result<UnexplainedTorque, AdaptError> {
        self.unexplained_of(log, &[])
    }

    /// The same where `residual` is held to act beside the model: what it takes is part of
    /// what the model leaves, and not of what holds the bristles where the log begins.
    ///
    /// # Errors
    /// As [`Adaptation::learn`].
    pub fn unexplained_beside(
        &self,
        log: &[Sample],
        residual: &mut impl Residual,
    ) -> Result<UnexplainedTorque, AdaptError> {
        let besides = self.besides(log, residual)?;
        self.unexplained_of(log, &besides)
    }

    fn unexplained_of(
        &self,
        log: &[Sample],
        besides: &[[f64; 2]],
    ) -> Result<UnexplainedTorque, AdaptError> {
        let assumed = self.now();
        let record = Record::new(&assumed, log, SMOOTHING, besides)?;
        let residuals = Residuals::at(&assumed, &record, &Column::zeros(), &[]);
        let along = along(&assumed, &record, log);
        let points = record.points.iter().zip(residuals.torque());
        let instants = points.map(|(point, &torque)| {
            let at = along[point.sample];
            Unexplained {
                position: at.position,
                motor_angle: at.motor_angle,
                motor_speed: at.motor_speed,
                direction: at.direction,
                torque: torque + point.besides,
            }
        });
        let instants: Vec<Unexplained> = instants.collect();
        let cycles = record.points.windows(2).map(|w| w[1].sample - w[0].sample);
        let spacing = cycles.min().unwrap_or(1) as f64 * record.period;
        Ok(UnexplainedTorque {
            instants,
            spacing,
            smoothing: SMOOTHING.max(record.period),
        })
    }

    /// Torque that a residual takes at each sample of a log: at the motor, and on the load
    /// (both N·m at the motor).
    pub(super) fn besides(
        &self,
        log: &[Sample],
        residual: &mut impl Residual,
    ) -> Result<Vec<[f64; 2]>, AdaptError> {
        let assumed = self.now();
        let record = Record::new(&assumed, log, SMOOTHING, &[])?;
        let travel = assumed.model.travel;
        let taken = along(&assumed, &record, log).into_iter().map(|at| {
            let [torque, force] = residual.besides(&at);
            [torque, travel * force]
        });
        Ok(taken.collect())
    }

    /// The present model as the assumed one.
    fn now(&self) -> AssumedModel {
        AssumedModel {
            model: self.model(),
            prior: AdaptPrior::default(),
        }
    }
}

/// Where a residual is asked for, at each sample of a log. The bristles begin as at a start
/// that has relaxed.
fn along(assumed: &AssumedModel, record: &Record, log: &[Sample]) -> Vec<ResidualAt> {
    let model = &assumed.model;
    let law = &model.friction;
    let mut bristle = 0.0;
    let mut before = 0.0;
    let samples = log.iter().zip(&record.speeds).map(|(sample, &speed)| {
        bristle = law.step(bristle, before, speed, record.period);
        before = speed;
        ResidualAt {
            motor_angle: sample.motor_angle,
            motor_speed: speed * model.lever / model.travel,
            position: sample.position,
            direction: law.coulomb_share(bristle),
        }
    });
    samples.collect()
}
