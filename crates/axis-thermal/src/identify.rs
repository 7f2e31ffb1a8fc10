//! A thermal model from hours of logged growth.
//!
//! Growth is what a probe finds at a few places, or a scale less the motor's encoder. Single conductances
//! are hardly determined by it (several give the same growth), so that the factors are held near 1 by a
//! prior, and what counts is the growth that the model predicts, not its numbers. Growth says little of
//! how friction falls; the power that the motor spends on friction says that.
//!
//! ```text
//! least   Σ ((δ_model(x, t) − δ_log)/σ)² + Σ (t_i/t̄) ((P_model/P_log − 1)/ρ)² + Σ ((T_model − T_log)/τ)² + Σ (ln f_k/s)²     over the factors f_k
//! ```
//!
//! t_i is the duration of the stretch that a power is the mean of, t̄ = Σ t_i²/Σ t_i over all logs: in seconds a mean
//! says little, and stretches of the same duration count alike.
//!
//! by Levenberg and Marquardt's method over ln f, with differences for the derivatives.

use nalgebra::DVector;

use crate::error::{ThermalError, check};
use crate::growth_log::{FollowedLog, GrowthLog, usual_duration};
use crate::least_squares::least;
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
    /// By which a temperature in the log and that of its body differ, K: a sensor shows one place of a body that has
    /// one temperature in the model.
    pub temperature_uncertainty: f64,
    /// s: by which the logarithms of the factors may differ from 0.
    pub prior: f64,
    /// Most steps.
    pub iterations: u32,
}

impl Default for GrowthFit {
    /// 1 µm; 1 %; 0.5 K; 0.7, about twofold; 30 steps.
    fn default() -> Self {
        Self {
            uncertainty: 1e-6,
            friction_uncertainty: 0.01,
            temperature_uncertainty: 0.5,
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
    /// all bodies begin at the first air's temperature. Logs without the friction's power leave the dry friction's fall as it
    /// is.
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
        let kelvins = how.temperature_uncertainty;
        check(
            kelvins > 0.0,
            "temperature_uncertainty",
            kelvins,
            "K",
            "above 0",
        )?;
        // Growth alone does not show how dry friction falls.
        let mut stretches = logs.iter().flat_map(|log| &log.stretches);
        let has_power = stretches.any(|s| s.friction.is_some_and(|power| power > 0.0));
        let shown = |unknown: &ThermalUnknown| has_power || *unknown != ThermalUnknown::DryFall;
        let unknowns: Vec<ThermalUnknown> = unknowns.iter().copied().filter(shown).collect();
        let problem = Problem {
            assumed: self,
            logs,
            unknowns: &unknowns,
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
        let followed = self.followed(logarithms)?;
        let usual = usual_duration(&followed);
        let growth = followed.iter().flat_map(FollowedLog::errors);
        let powers = followed.iter().flat_map(FollowedLog::powers);
        let temperatures = followed.iter().flat_map(|log| &log.temperatures);
        let mut all: Vec<f64> = growth.map(|error| error / self.how.uncertainty).collect();
        all.extend(powers.map(|read| read.deviation(usual) / self.how.friction_uncertainty));
        all.extend(temperatures.map(|(_, error)| error / self.how.temperature_uncertainty));
        all.extend(logarithms.iter().map(|l| l / self.how.prior));
        Ok(DVector::from_vec(all))
    }

    fn solve(&self) -> Result<DVector<f64>, ThermalError> {
        let cold = DVector::zeros(self.unknowns.len());
        let least = least(cold, (self.how.iterations, 0.0), |at| self.residuals(at))?;
        Ok(least.at)
    }
}
