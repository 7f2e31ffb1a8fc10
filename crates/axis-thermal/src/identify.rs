//! A thermal model from hours of logged growth.
//!
//! Growth is what a probe finds at a few places, or the motor's encoder less a scale. Single conductances
//! are hardly determined by it (several give the same growth), so that the factors are held near 1 by a
//! prior, and what counts is the growth that the model predicts, not its numbers.
//!
//! ```text
//! least   Σ ((δ_model(x, t) − δ_log)/σ)² + Σ (ln f_k/s)²        over the factors f_k of the unknowns
//! ```
//!
//! by Levenberg and Marquardt's method over ln f, with differences for the derivatives.

use nalgebra::{DMatrix, DVector};

use crate::duty::Duty;
use crate::error::{ThermalError, check};
use crate::model::{ThermalModel, ThermalState};
use crate::parameters::ThermalParameters;
use crate::run::ThermalAccuracy;
use crate::unknown::ThermalUnknown;
use crate::work::AxisAtWork;

/// A stretch of a log: a duty, and growth that was found at its end.
#[derive(Clone, Debug)]
pub struct GrowthStretch {
    /// Losses of the reference; a standstill is a duty too.
    pub duty: Duty,
    /// How long, s.
    pub duration: f64,
    /// Temperature of the air at its begin and its end, °C.
    pub air: [f64; 2],
    /// Position (m) and growth of the screw since the log's begin (m), at the end of the stretch.
    pub found: Vec<[f64; 2]>,
}

/// How a model is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrowthFit {
    /// σ: by which growth in the log and in the best model differ, m.
    pub uncertainty: f64,
    /// s: by which the logarithms of the factors may differ from 0.
    pub prior: f64,
    /// Most steps.
    pub iterations: u32,
}

impl Default for GrowthFit {
    /// 1 µm; 0.7, about twofold; 30 steps.
    fn default() -> Self {
        Self {
            uncertainty: 1e-6,
            prior: 0.7,
            iterations: 30,
        }
    }
}

/// A model that was fitted.
#[derive(Clone, Debug)]
pub struct FittedGrowth {
    /// Its numbers.
    pub parameters: ThermalParameters,
    /// The factor on each unknown.
    pub factors: Vec<(ThermalUnknown, f64)>,
    /// Root mean square of model less log, m.
    pub rms: f64,
}

impl ThermalParameters {
    /// These numbers with the unknowns' factors such that the model grows as a log says. All
    /// bodies begin at the first air's temperature.
    ///
    /// # Errors
    /// [`ThermalError`] if the log's duties are of another screw, nothing was found in it, or the
    /// numbers make no model.
    pub fn fit(
        &self,
        log: &[GrowthStretch],
        unknowns: &[ThermalUnknown],
        how: &GrowthFit,
    ) -> Result<FittedGrowth, ThermalError> {
        let found: usize = log.iter().map(|stretch| stretch.found.len()).sum();
        let valid = "a log with growth at one place or more";
        check(
            found > 0,
            "number of growths found",
            found as f64,
            "",
            valid,
        )?;
        check(
            how.uncertainty > 0.0,
            "uncertainty",
            how.uncertainty,
            "m",
            "above 0",
        )?;
        check(how.prior > 0.0, "prior", how.prior, "", "above 0")?;
        let problem = Problem {
            assumed: self,
            log,
            unknowns,
            how,
        };
        let logarithms = problem.solve()?;
        let parameters = problem.parameters(&logarithms);
        let residuals = problem.growth_residuals(&logarithms)?;
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let factors = unknowns.iter().zip(&logarithms).map(|(u, l)| (*u, l.exp()));
        Ok(FittedGrowth {
            parameters,
            factors: factors.collect(),
            rms: how.uncertainty * (squares / found as f64).sqrt(),
        })
    }
}

struct Problem<'a> {
    assumed: &'a ThermalParameters,
    log: &'a [GrowthStretch],
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

    /// Model less log over σ.
    fn growth_residuals(&self, logarithms: &DVector<f64>) -> Result<Vec<f64>, ThermalError> {
        let model = ThermalModel::new(self.parameters(logarithms))?;
        let first = self.log.first().map_or(0.0, |stretch| stretch.air[0]);
        let cold = model.at_rest(first);
        let mut state = cold.clone();
        let mut residuals = Vec::new();
        let mut at_work: Option<(&Duty, AxisAtWork)> = None;
        for stretch in self.log {
            // The same duty goes on in the same network.
            let network = match at_work.take() {
                Some((duty, network)) if *duty == stretch.duty => network,
                _ => model.under(&stretch.duty)?,
            };
            follow(&network, &mut state, stretch)?;
            at_work = Some((&stretch.duty, network));
            for &[x, growth] in &stretch.found {
                let predicted = model.growth(&cold, &state, x).screw;
                residuals.push((predicted - growth) / self.how.uncertainty);
            }
        }
        Ok(residuals)
    }

    /// With the prior's.
    fn residuals(&self, logarithms: &DVector<f64>) -> Result<DVector<f64>, ThermalError> {
        let mut all = self.growth_residuals(logarithms)?;
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

/// A stretch from its begin to its end, in air that changes linearly.
fn follow(
    at_work: &AxisAtWork,
    state: &mut ThermalState,
    stretch: &GrowthStretch,
) -> Result<(), ThermalError> {
    let (begun, [from, to]) = (state.time, stretch.air);
    let air = |t: f64| from + (to - from) * (t - begun) / stretch.duration;
    at_work.run_in(state, air, stretch.duration, &ThermalAccuracy::default())?;
    Ok(())
}
