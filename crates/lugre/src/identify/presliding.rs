//! `σ0` and `σ1` from small motions about a standstill.

use nalgebra::{Matrix4, SMatrix};

use super::error::{FrictionIdentifyError, check_finite, check_positive};
use super::estimate::ParameterEstimate;
use super::least_squares::{FitOutcome, Minimum, Problem, dot, square};
use super::series::correlation_time;
use super::static_fit::StaticKnowledge;
use super::trial::{Trial, Unknowns};
use crate::law::LuGre;
use crate::parameters::LugreError;

/// How the motion at the friction's location was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeasuredMotion<'a> {
    /// Speed at each sample, rad/s; taken as linear in between.
    Speed(&'a [f64]),
    /// Displacement at each sample, rad, from any origin; speeds are central
    /// differences, so noise in it is amplified by `1/(√2 time_step)`.
    Displacement(&'a [f64]),
}

/// A pre-sliding test, sampled at equal steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreslidingRecord<'a> {
    /// Time between samples, s.
    pub time_step: f64,
    /// The motion, one value a sample.
    pub motion: MeasuredMotion<'a>,
    /// The friction torque, N·m, one value a sample.
    pub torque: &'a [f64],
}

/// Result of [`identify_presliding`].
#[derive(Debug, Clone, PartialEq)]
pub struct PreslidingFit {
    /// `σ0`, N·m/rad.
    pub stiffness: ParameterEstimate,
    /// `σ1`, N·m·s/rad; not negative.
    pub damping: ParameterEstimate,
    /// Bristle torque `σ0 z` at the first sample, N·m.
    pub initial_bristle_torque: ParameterEstimate,
    /// Constant torque offset, N·m.
    pub torque_offset: ParameterEstimate,
    /// Covariance of the four estimates above, in that order, with the
    /// uncertainty of the static parameters carried over.
    pub covariance: [[f64; 4]; 4],
    /// RMS of the torque residuals, N·m.
    pub residual_rms: f64,
    /// Correlation of neighbouring residuals: of white noise about 0 (±2/√n). More says that noise is
    /// slow, or the model or the given motion wrong somewhere; the standard errors are wider then,
    /// as so many fewer samples are independent.
    pub residual_correlation: f64,
    /// Samples whose bristles were more than a tenth away from steady sliding.
    pub presliding_samples: usize,
    /// All samples.
    pub samples: usize,
    /// How the fit ended.
    pub outcome: FitOutcome,
    /// The static parameters that were used.
    pub statics: StaticKnowledge,
}

impl PreslidingFit {
    /// The law with all six parameters.
    ///
    /// # Errors
    /// [`LugreError`], if what was fitted makes no law.
    pub fn law(&self) -> Result<LuGre, LugreError> {
        LuGre::new(
            self.statics
                .parameters
                .with_bristles(self.stiffness.value, self.damping.value),
        )
    }
}

/// Fits `σ0` and `σ1` by the output error: the bristle is simulated with
/// [`LuGre::step`] along the measured motion, and the torque of equation (3)
/// compared with the measured one. The standard errors are those of residuals that are correlated
/// as they turn out to be.
///
/// Unknown as well, and fitted: the bristle torque `σ0 z` at the start and a
/// constant torque offset. As long as nothing slides the two cannot be told
/// apart; what decides then is only that |σ0 z| does not exceed about `T_S`,
/// which enters as an observation of 0 ± `T_S`.
///
/// The start is the best of a grid over `σ0` and the initial bristle torque,
/// with `σ1` and the offset by linear least squares, in which the torque is
/// linear in them; Levenberg–Marquardt follows.
///
/// # Errors
/// [`FrictionIdentifyError`]: channels of unequal length, fewer than 32 samples, a
/// number that is not finite, static parameters that make no law, no motion,
/// no samples in the pre-sliding range, or `σ0` left open by the data.
pub fn identify_presliding(
    statics: impl Into<StaticKnowledge>,
    record: &PreslidingRecord<'_>,
) -> Result<PreslidingFit, FrictionIdentifyError> {
    let statics = statics.into();
    check(&statics, record)?;
    let speeds = match record.motion {
        MeasuredMotion::Speed(speeds) => speeds.to_vec(),
        MeasuredMotion::Displacement(x) => central_speeds(x, record.time_step),
    };
    check_finite("speed", &speeds)?;
    let trial = Trial {
        time_step: record.time_step,
        speeds: &speeds,
        torque: record.torque,
        statics: statics.parameters,
        prior: noise_level(record.torque) / statics.parameters.stiction,
    };
    let start = trial.search().ok_or(FrictionIdentifyError::NoMotion)?;
    let minimum = refine(&trial, start);
    let found = trial.presliding_samples(&minimum.x);
    const NEEDED: usize = 8;
    if found < NEEDED {
        return Err(FrictionIdentifyError::NoPreslidingMotion {
            found,
            needed: NEEDED,
        });
    }
    report(&trial, &statics, minimum, found)
}

fn check(
    statics: &StaticKnowledge,
    record: &PreslidingRecord<'_>,
) -> Result<(), FrictionIdentifyError> {
    const NEEDED: usize = 32;
    check_positive("time_step", record.time_step)?;
    let (name, motion) = match record.motion {
        MeasuredMotion::Speed(w) => ("speed", w),
        MeasuredMotion::Displacement(x) => ("displacement", x),
    };
    if motion.len() != record.torque.len() {
        return Err(FrictionIdentifyError::LengthMismatch {
            motion: motion.len(),
            torque: record.torque.len(),
        });
    }
    if motion.len() < NEEDED {
        return Err(FrictionIdentifyError::TooFewSamples {
            found: motion.len(),
            needed: NEEDED,
        });
    }
    check_finite(name, motion)?;
    check_finite("torque", record.torque)?;
    for row in &statics.covariance {
        check_finite("covariance", row)?;
    }
    check_positive("stiction", statics.parameters.stiction)?;
    LuGre::new(statics.parameters.with_bristles(1.0, 0.0))?;
    Ok(())
}

/// Central differences, one-sided of second order at the ends.
pub(super) fn central_speeds(x: &[f64], h: f64) -> Vec<f64> {
    let n = x.len();
    (0..n)
        .map(|i| {
            if i == 0 {
                (-3.0 * x[0] + 4.0 * x[1] - x[2]) / (2.0 * h)
            } else if i == n - 1 {
                (3.0 * x[n - 1] - 4.0 * x[n - 2] + x[n - 3]) / (2.0 * h)
            } else {
                (x[i + 1] - x[i - 1]) / (2.0 * h)
            }
        })
        .collect()
}

/// White noise of a smooth signal: second differences remove the signal and
/// leave noise of variance 6 σ². Not below 1e-9 of the signal itself.
fn noise_level(torque: &[f64]) -> f64 {
    let sum: f64 = torque
        .windows(3)
        .map(|t| (t[0] - 2.0 * t[1] + t[2]).powi(2))
        .sum();
    let noise = (sum / (6.0 * (torque.len() - 2) as f64)).sqrt();
    let rms = (square(torque) / torque.len() as f64).sqrt();
    noise.max(1e-9 * rms)
}

fn refine(trial: &Trial<'_>, start: Unknowns) -> Minimum<4> {
    let residuals = |x: &Unknowns, out: &mut [f64]| trial.residuals(&trial.statics, x, out);
    let problem = Problem {
        residuals: &residuals,
        count: trial.speeds.len() + 1,
        scale: trial.scale(&start),
        lower: [f64::NEG_INFINITY, 0.0, f64::NEG_INFINITY, f64::NEG_INFINITY],
        free: [true; 4],
    };
    problem.minimise(start)
}

/// Covariance of the estimates: noise, plus the share of the static
/// parameters. A change `δs` of these moves the minimum by
/// `−(JᵀJ)⁻¹ Jᵀ (∂r/∂s) δs`.
fn covariance(
    trial: &Trial<'_>,
    statics: &StaticKnowledge,
    minimum: &Minimum<4>,
    inverse: &Matrix4<f64>,
    variance: f64,
) -> Matrix4<f64> {
    let known = Matrix4::from_fn(|i, j| statics.covariance[i][j]);
    let mut total = inverse * variance;
    if known.iter().all(|&c| c == 0.0) {
        return total;
    }
    let columns = trial.static_sensitivities(&minimum.x);
    let cross = SMatrix::<f64, 4, 4>::from_fn(|i, j| dot(&minimum.jacobian[i], &columns[j]));
    let shift = inverse * cross;
    total += shift * known * shift.transpose();
    total
}

fn report(
    trial: &Trial<'_>,
    statics: &StaticKnowledge,
    minimum: Minimum<4>,
    presliding_samples: usize,
) -> Result<PreslidingFit, FrictionIdentifyError> {
    let [log_stiffness, damping, bristle_torque, offset] = minimum.x;
    let stiffness = log_stiffness.exp();
    let open = |standard_error| FrictionIdentifyError::NotIdentifiable {
        parameter: "stiffness",
        value: stiffness,
        standard_error,
    };
    let n = trial.speeds.len();
    let residuals = &minimum.residuals[..n];
    let squares = square(residuals);
    // Residuals that last tell as much as fewer independent ones.
    let variance = squares / (n - 4) as f64 * correlation_time(residuals);
    let inverse = minimum.inverse.ok_or_else(|| open(f64::INFINITY))?;
    let mut c = covariance(trial, statics, &minimum, &inverse, variance);
    // From ln σ0 to σ0.
    for i in 0..4 {
        c[(0, i)] *= stiffness;
        c[(i, 0)] *= stiffness;
    }
    let estimate = |i: usize, value: f64| ParameterEstimate {
        value,
        standard_error: c[(i, i)].max(0.0).sqrt(),
    };
    let fit = PreslidingFit {
        stiffness: estimate(0, stiffness),
        damping: estimate(1, damping),
        initial_bristle_torque: estimate(2, bristle_torque),
        torque_offset: estimate(3, offset),
        covariance: core::array::from_fn(|i| core::array::from_fn(|j| c[(i, j)])),
        residual_rms: (squares / n as f64).sqrt(),
        residual_correlation: if squares > 0.0 {
            dot(residuals, &residuals[1..]) / squares
        } else {
            0.0
        },
        presliding_samples,
        samples: n,
        outcome: minimum.outcome,
        statics: *statics,
    };
    if fit.stiffness.standard_error < 0.5 * stiffness {
        Ok(fit)
    } else {
        Err(open(fit.stiffness.standard_error))
    }
}
