//! A thermal model from hours of logged growth.
//!
//! Growth is what a probe finds at a few places, or a scale less the motor's encoder. Single conductances
//! are hardly determined by it (several give the same growth), so that the factors are held near 1 by a
//! prior, and what counts is the growth that the model predicts, not its numbers. Growth says little of
//! how friction falls; the power that the motor spends on friction says that.
//!
//! ```text
//! least   Σ ((δ_model(x, t) − δ_log)/σ)² + Σ (t_i/t̄) ((P_model/P_log − 1)/ρ)² + Σ (ln f_k/s)²     over the factors f_k
//! ```
//!
//! t_i is the duration of the stretch that a power is the mean of, t̄ = Σ t_i²/Σ t_i over all logs: in seconds a mean
//! says little, and stretches of the same duration count alike.
//!
//! by Levenberg and Marquardt's method over ln f, with differences for the derivatives.

use nalgebra::{DMatrix, DVector};

use crate::error::{ThermalError, check};
use crate::growth_log::{FollowedLog, GrowthLog};
use crate::model::ThermalModel;
use crate::parameters::ThermalParameters;
use crate::unknown::ThermalUnknown;

/// How a model is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct GrowthFit {
    /// σ: by which growth in the log and in the best model differ, m.
    pub uncertainty: f64,
    /// ρ: the share by which the friction's power in the log and in the best model differ, over a stretch of the logs'
    /// usual duration.
    pub friction_uncertainty: f64,
    /// s: by which the logarithms of the factors may differ from 0.
    pub prior: f64,
    /// Most steps.
    pub iterations: u32,
}

impl Default for GrowthFit {
    /// 1 µm; 1 %; 0.7, about twofold; 30 steps.
    fn default() -> Self {
        Self {
            uncertainty: 1e-6,
            friction_uncertainty: 0.01,
            prior: 0.7,
            iterations: 30,
        }
    }
}

/// A model that was fitted.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FittedGrowth {
    /// Its numbers.
    pub parameters: ThermalParameters,
    /// The factor on each unknown.
    pub factors: Vec<(ThermalUnknown, f64)>,
    /// Root mean square of model less log, m.
    pub rms: f64,
}

impl ThermalParameters {
    /// These numbers with the unknowns' factors such that the model grows as the logs say. In each log
    /// all bodies begin at the first air's temperature.
    ///
    /// # Errors
    /// [`ThermalError`] if a log's duties are of another screw, no growth in them can be compared, or the
    /// numbers make no model.
    pub fn fit(
        &self,
        logs: &[GrowthLog],
        unknowns: &[ThermalUnknown],
        how: &GrowthFit,
    ) -> Result<FittedGrowth, ThermalError> {
        let found: usize = logs.iter().map(GrowthLog::comparisons).sum();
        let valid = "a log with growth at one place or more; at one place twice or more, if it counts from the first reading there";
        let name = "number of growths to compare";
        check(found > 0, name, found as f64, "", valid)?;
        check(
            how.uncertainty > 0.0,
            "uncertainty",
            how.uncertainty,
            "m",
            "above 0",
        )?;
        check(how.prior > 0.0, "prior", how.prior, "", "above 0")?;
        let share = how.friction_uncertainty;
        check(share > 0.0, "friction_uncertainty", share, "", "above 0")?;
        let problem = Problem {
            assumed: self,
            logs,
            unknowns,
            how,
        };
        let logarithms = problem.solve()?;
        let parameters = problem.parameters(&logarithms);
        let followed = problem.followed(&logarithms)?;
        let errors: Vec<f64> = followed.iter().flat_map(FollowedLog::errors).collect();
        let squares: f64 = errors.iter().map(|e| e * e).sum();
        let factors = unknowns.iter().zip(&logarithms).map(|(u, l)| (*u, l.exp()));
        Ok(FittedGrowth {
            parameters,
            factors: factors.collect(),
            rms: (squares / errors.len() as f64).sqrt(),
        })
    }
}

struct Problem<'a> {
    assumed: &'a ThermalParameters,
    logs: &'a [GrowthLog],
    unknowns: &'a [ThermalUnknown],
    how: &'a GrowthFit,
}

/// Step of the differences over ln f: losses are solved to 5 mK, and differences of the same steps
/// nearly cancel that.
const DIFFERENCE: f64 = 0.02;
/// Change of ln f below which the fit has ended.
const ENDED: f64 = 1e-3;
/// Greatest damping.
const STIFFEST: f64 = 1e8;

impl Problem<'_> {
    fn parameters(&self, logarithms: &DVector<f64>) -> ThermalParameters {
        let mut parameters = self.assumed.clone();
        for (unknown, l) in self.unknowns.iter().zip(logarithms) {
            unknown.scale(&mut parameters, l.exp());
        }
        parameters
    }

    fn followed(&self, logarithms: &DVector<f64>) -> Result<Vec<FollowedLog>, ThermalError> {
        let model = ThermalModel::new(self.parameters(logarithms))?;
        self.logs.iter().map(|log| model.follow(log)).collect()
    }

    /// Model less log over their uncertainties, and the prior's.
    fn residuals(&self, logarithms: &DVector<f64>) -> Result<DVector<f64>, ThermalError> {
        let mut all = Vec::new();
        let followed = self.followed(logarithms)?;
        // A standstill has no friction to compare.
        let powers = || followed.iter().flat_map(|log| &log.friction);
        let worked = || powers().filter(|read| read.found > 0.0);
        let total: f64 = worked().map(|read| read.duration).sum();
        let squares: f64 = worked().map(|read| read.duration * read.duration).sum();
        let usual = squares / total;
        all.extend(
            followed
                .iter()
                .flat_map(|log| log.errors().map(|error| error / self.how.uncertainty)),
        );
        all.extend(worked().map(|read| {
            let share = self.how.friction_uncertainty;
            (read.duration / usual).sqrt() * (read.predicted / read.found - 1.0) / share
        }));
        all.extend(logarithms.iter().map(|l| l / self.how.prior));
        Ok(DVector::from_vec(all))
    }

    fn solve(&self) -> Result<DVector<f64>, ThermalError> {
        let n = self.unknowns.len();
        let mut at = DVector::zeros(n);
        let mut residuals = self.residuals(&at)?;
        let mut damping = 1e-2;
        for _ in 0..self.how.iterations {
            let mut jacobian = DMatrix::zeros(residuals.len(), n);
            for k in 0..n {
                let mut moved = at.clone();
                moved[k] += DIFFERENCE;
                let change = (self.residuals(&moved)? - &residuals) / DIFFERENCE;
                jacobian.set_column(k, &change);
            }
            let normal = jacobian.tr_mul(&jacobian);
            let gradient = jacobian.tr_mul(&residuals);
            let mut moved = None;
            while damping < STIFFEST && moved.is_none() {
                let mut damped = normal.clone();
                for k in 0..n {
                    damped[(k, k)] *= 1.0 + damping;
                }
                let step = damped.cholesky().map(|c| -c.solve(&gradient));
                let next = step.map(|step| &at + step);
                // A step beyond what numbers may be is too long.
                let better = next.and_then(|next| {
                    let there = self.residuals(&next).ok()?;
                    (there.norm_squared() < residuals.norm_squared()).then_some((next, there))
                });
                match better {
                    Some(better) => moved = Some(better),
                    None => damping *= 4.0,
                }
            }
            let Some((next, there)) = moved else {
                return Ok(at);
            };
            damping = (0.25 * damping).max(1e-6);
            let change = (&next - &at).amax();
            (at, residuals) = (next, there);
            if change < ENDED {
                return Ok(at);
            }
        }
        Ok(at)
    }
}
