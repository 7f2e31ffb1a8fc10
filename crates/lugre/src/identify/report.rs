//! From the minimum of a curve fit to estimates with standard errors.

use nalgebra::SMatrix;

use super::curve::Curve;
use super::error::FrictionIdentifyError;
use super::estimate::ParameterEstimate;
use super::least_squares::{Minimum, square};
use super::static_fit::{LeftOut, StaticFit};

/// The estimates; the covariance of (`T_C`, `T_S`, …) from that of
/// (`T_C`, `T_S − T_C`, …).
pub(super) fn report(
    curve: &Curve<'_>,
    minimum: Minimum<5>,
    used: Vec<usize>,
    left_out: Vec<LeftOut>,
) -> Result<StaticFit, FrictionIdentifyError> {
    let [coulomb, rise, stribeck, viscous, offset] = minimum.x;
    let chi_squared = square(&minimum.residuals);
    let degrees_of_freedom = curve.degrees_of_freedom();
    let error_scale = error_scale(chi_squared, degrees_of_freedom);
    let inverse = minimum
        .inverse
        .ok_or(FrictionIdentifyError::NoStribeckEffect {
            rise,
            standard_error: f64::INFINITY,
        })?;
    let mut to_stiction = SMatrix::<f64, 5, 5>::identity();
    to_stiction[(1, 0)] = 1.0;
    let c = to_stiction * inverse * to_stiction.transpose() * (error_scale * error_scale);
    let estimate = |i: usize, value: f64| ParameterEstimate {
        value,
        standard_error: c[(i, i)].max(0.0).sqrt(),
    };
    let torque_squares: f64 = minimum
        .residuals
        .iter()
        .zip(&curve.errors)
        .map(|(r, e)| (r * e) * (r * e))
        .sum();
    Ok(StaticFit {
        coulomb: estimate(0, coulomb),
        stiction: estimate(1, coulomb + rise),
        stribeck_speed: estimate(2, stribeck),
        viscous: estimate(3, viscous),
        torque_offset: estimate(4, offset),
        covariance: core::array::from_fn(|i| core::array::from_fn(|j| c[(i, j)])),
        residual_rms: (torque_squares / curve.runs.len() as f64).sqrt(),
        chi_squared,
        degrees_of_freedom,
        error_scale,
        used,
        left_out,
        outcome: minimum.outcome,
    })
}

/// 1, or the Birge ratio where the misfit cannot be the runs' own noise: χ²/ν
/// has the standard deviation √(2/ν).
fn error_scale(chi_squared: f64, degrees_of_freedom: usize) -> f64 {
    let nu = degrees_of_freedom as f64;
    let ratio = chi_squared / nu;
    if ratio > 1.0 + 3.0 * (2.0 / nu).sqrt() {
        ratio.sqrt()
    } else {
        1.0
    }
}
