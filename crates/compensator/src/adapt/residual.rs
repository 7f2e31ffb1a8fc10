//! Residuals of the two balances, weighed.

use std::vec::Vec;

use nalgebra::{SMatrix, SVector};

use super::assumed::AssumedModel;
use super::balance::{Balance, torque, wind_up};
use super::coordinates::{HELD, OFFSET};
use super::parameter::AdaptParameter;
use super::record::Record;
use super::smooth::Point;
use super::weight::weights;

/// Unknowns of a record that no model keeps.
pub(super) const NUISANCES: usize = 3;

/// Deviation of [`HELD`].
const HELD_DEVIATION: f64 = 0.1;
/// That of [`GAP`], in wind-ups by the Coulomb level.
const FREE: f64 = 0.2;
/// A residual below this share of the whole is not trusted.
const FINEST: f64 = 1e-4;

/// Weight of each value of the two balances.
pub(super) type Weights = [Vec<f64>; 2];

/// Share of the Coulomb level from which a transmission lies on one side, and how many points
/// of a record must lie on either for it to tell the free travel between: from one side alone
/// it cannot be told from the angle between the two scales.
const ON_A_SIDE: f64 = 0.1;
const POINTS: usize = 10;

fn both_sides(assumed: &AssumedModel, record: &Record) -> bool {
    let level = assumed.model.travel * assumed.value(AdaptParameter::StandingLoad);
    let side = |sign: f64| {
        let lies = |p: &&Point| sign * p.transmitted > ON_A_SIDE * level;
        record.points.iter().filter(lies).count()
    };
    side(1.0) >= POINTS && side(-1.0) >= POINTS
}

/// Residuals of the torque and of the wind-up, and their rates of change.
#[derive(Clone, Debug)]
pub(super) struct Residuals([Balance; 2]);

impl Residuals {
    /// At parameters and nuisances.
    pub fn at<const N: usize>(
        assumed: &AssumedModel,
        record: &Record,
        at: &SVector<f64, N>,
        free: &[usize],
    ) -> Self {
        Self([
            torque(assumed, record, at, free),
            wind_up(assumed, record, at, free),
        ])
    }

    /// Whether a record has this nuisance.
    pub fn has_nuisance(assumed: &AssumedModel, record: &Record, i: usize) -> bool {
        let friction = assumed.model.friction.parameters().coulomb > 0.0;
        match i {
            HELD => friction,
            OFFSET => record.sees_load,
            _ => record.sees_load && friction && both_sides(assumed, record),
        }
    }

    /// Deviation of a nuisance, in its unit.
    pub fn nuisance_deviation(assumed: &AssumedModel, record: &Record, i: usize) -> f64 {
        let wound = assumed.wound();
        let leads = record.points.iter().map(|p| p.lead.abs());
        match i {
            HELD => HELD_DEVIATION,
            // The two scales begin anywhere.
            OFFSET => 1e3 * leads.fold(wound.max(1e-9), f64::max),
            _ => FREE * wound.max(1e-12),
        }
    }

    /// Σ w e² over both.
    pub fn square(&self, weights: &Weights) -> f64 {
        let channels = self.0.iter().zip(weights);
        let of = channels.map(|(balance, weights)| {
            let pairs = balance.values.iter().zip(weights);
            pairs.map(|(e, w)| w * e * e).sum::<f64>()
        });
        of.sum()
    }

    /// The torque balance at each point, N·m.
    pub fn torque(&self) -> &[f64] {
        &self.0[0].values
    }

    /// RMS of the torque balance, N·m.
    pub fn rms(&self) -> f64 {
        self.weighed(&std::vec![1.0; self.0[0].values.len()])
    }

    /// The same by weights.
    pub fn weighed(&self, weights: &[f64]) -> f64 {
        let pairs = self.0[0].values.iter().zip(weights);
        let square: f64 = pairs.map(|(e, w)| w * e * e).sum();
        (square / weights.iter().sum::<f64>()).sqrt()
    }

    /// Weight of each value, `free` coordinates being fitted; see [`weights`].
    pub fn weights(&self, free: usize, even: bool) -> Weights {
        let of = |b: &Balance| weights(&b.values, FINEST * b.scale, free, even);
        [of(&self.0[0]), of(&self.0[1])]
    }

    /// Adds gradient and curvature of ½ Σ w e².
    pub fn add_to<const N: usize>(
        &self,
        weights: &Weights,
        gradient: &mut SVector<f64, N>,
        curvature: &mut SMatrix<f64, N, N>,
    ) {
        for (balance, weights) in self.0.iter().zip(weights) {
            for (i, a) in &balance.columns {
                let weighed: Vec<f64> = a.iter().zip(weights).map(|(a, w)| a * w).collect();
                let dot = |b: &[f64]| weighed.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                gradient[*i] -= dot(&balance.values);
                for (j, b) in &balance.columns {
                    curvature[(*i, *j)] += dot(b);
                }
            }
        }
    }
}
