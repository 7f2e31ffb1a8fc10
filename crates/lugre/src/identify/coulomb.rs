//! `T_C` and `σ2` alone from constant-speed runs: friction that does not fall with speed.

use nalgebra::{DMatrix, DVector, SMatrix};

use super::constant_speeds::{VIBRATION_LIMIT, check_runs, distinct_speeds, select};
use super::error::FrictionIdentifyError;
use super::estimate::ParameterEstimate;
use super::least_squares::FitOutcome;
use super::record::ConstantSpeedRun;
use super::static_fit::StaticFit;

/// Fewest different speeds: one more than there are parameters with an offset.
const NEEDED: usize = 4;

/// Fits `T = T_C sign ω + σ2 ω + offset` to constant-speed runs by weighted least squares;
/// those that vibrate by more than [`VIBRATION_LIMIT`] are left out and listed.
///
/// For a contact in which no Stribeck effect is seen
/// ([`FrictionIdentifyError::NoStribeckEffect`]). `T_S` is `T_C` then, and `Ω_S`, which means
/// nothing, the slowest speed. The offset is fitted where at least two runs go either way,
/// `σ2` is not negative. Runs without a standard error weigh as the least certain.
///
/// # Errors
/// [`FrictionIdentifyError`]: a number is not finite or beyond 1e100, a standard error not
/// positive, a vibration negative or NaN; fewer than 4 different speeds are left; `T_C` is
/// not above zero.
pub fn identify_coulomb(runs: &[ConstantSpeedRun]) -> Result<StaticFit, FrictionIdentifyError> {
    check_runs(runs)?;
    let (used, left_out) = select(runs, VIBRATION_LIMIT);
    let kept: Vec<ConstantSpeedRun> = used.iter().map(|&i| runs[i]).collect();
    let speeds = distinct_speeds(&kept);
    let Some(&slowest) = speeds.first().filter(|_| speeds.len() >= NEEDED) else {
        return Err(FrictionIdentifyError::TooFewSpeeds {
            found: speeds.len(),
            needed: NEEDED,
            left_out: left_out.len(),
        });
    };
    let forward = kept.iter().filter(|r| r.speed > 0.0).count();
    let offset = forward.min(kept.len() - forward) >= 2;
    let errors = standard_errors(&kept);
    let free = solve(&kept, &errors, [true, true, offset]);
    let fit = match free {
        Some(fit) if fit.x[1] < 0.0 => solve(&kept, &errors, [true, false, offset]),
        fit => fit,
    };
    let open = |value| FrictionIdentifyError::NotIdentifiable {
        parameter: "coulomb",
        value,
        standard_error: f64::INFINITY,
    };
    let fit = fit.ok_or_else(|| open(0.0))?;
    let [coulomb, viscous, torque_offset] = fit.x;
    if coulomb.is_nan() || coulomb <= 0.0 {
        return Err(open(coulomb));
    }
    let estimate = |i: usize, value: f64| ParameterEstimate {
        value,
        standard_error: fit.covariance[(i, i)].max(0.0).sqrt(),
    };
    // Of (T_C, T_S, Ω_S, σ2, offset) the first two are one, the third is given.
    let places = [Some(0), Some(0), None, Some(1), Some(2)];
    let entry = |i: usize, j: usize| match (places[i], places[j]) {
        (Some(a), Some(b)) => fit.covariance[(a, b)],
        _ => 0.0,
    };
    Ok(StaticFit {
        coulomb: estimate(0, coulomb),
        stiction: estimate(0, coulomb),
        stribeck_speed: ParameterEstimate {
            value: slowest,
            standard_error: 0.0,
        },
        viscous: estimate(1, viscous),
        torque_offset: estimate(2, torque_offset),
        covariance: core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j))),
        residual_rms: fit.residual_rms,
        chi_squared: fit.chi_squared,
        degrees_of_freedom: fit.degrees_of_freedom,
        error_scale: fit.error_scale,
        used,
        left_out,
        outcome: FitOutcome::Converged,
    })
}

/// Least squares over `T_C`, `σ2` and the offset.
struct Linear {
    x: [f64; 3],
    covariance: SMatrix<f64, 3, 3>,
    residual_rms: f64,
    chi_squared: f64,
    degrees_of_freedom: usize,
    error_scale: f64,
}

/// Fits the parameters that are `free`; the others are 0.
fn solve(runs: &[ConstantSpeedRun], errors: &[f64], free: [bool; 3]) -> Option<Linear> {
    let row = |run: &ConstantSpeedRun| [run.speed.signum(), run.speed, 1.0];
    let columns: Vec<usize> = (0..3).filter(|&i| free[i]).collect();
    let matrix = DMatrix::from_fn(runs.len(), columns.len(), |k, i| {
        row(&runs[k])[columns[i]] / errors[k]
    });
    let right = DVector::from_fn(runs.len(), |k, _| runs[k].torque / errors[k]);
    let inverse = matrix.tr_mul(&matrix).cholesky()?.inverse();
    let solution = &inverse * matrix.tr_mul(&right);
    let residuals = right - matrix * &solution;
    let chi_squared = residuals.norm_squared();
    let degrees_of_freedom = runs.len().saturating_sub(columns.len());
    let nu = degrees_of_freedom.max(1) as f64;
    // The Birge ratio where the misfit cannot be the runs' own noise.
    let ratio = chi_squared / nu;
    let scaled = ratio > 1.0 + 3.0 * (2.0 / nu).sqrt();
    let error_scale = if scaled { ratio.sqrt() } else { 1.0 };
    let mut x = [0.0; 3];
    let mut covariance = SMatrix::zeros();
    for (i, &a) in columns.iter().enumerate() {
        x[a] = solution[i];
        for (j, &b) in columns.iter().enumerate() {
            covariance[(a, b)] = inverse[(i, j)] * error_scale * error_scale;
        }
    }
    let torques = residuals.iter().zip(errors).map(|(r, e)| (r * e).powi(2));
    Some(Linear {
        x,
        covariance,
        residual_rms: (torques.sum::<f64>() / runs.len() as f64).sqrt(),
        chi_squared,
        degrees_of_freedom,
        error_scale,
    })
}

/// The runs' standard errors, with a floor of 1e-6 of the largest torque; those that know
/// none have the largest known.
fn standard_errors(runs: &[ConstantSpeedRun]) -> Vec<f64> {
    let largest = runs.iter().map(|r| r.torque.abs()).fold(0.0, f64::max);
    let floor = (1e-6 * largest).max(f64::MIN_POSITIVE);
    let known = runs.iter().filter_map(|r| r.torque_standard_error);
    let most = known.fold(floor, f64::max);
    let one = |r: &ConstantSpeedRun| r.torque_standard_error.unwrap_or(most).max(floor);
    runs.iter().map(one).collect()
}
