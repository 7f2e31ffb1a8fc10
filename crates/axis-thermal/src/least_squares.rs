//! Least squares by Levenberg and Marquardt's method, with differences for the derivatives.

use nalgebra::{DMatrix, DVector};

use crate::error::ThermalError;

/// Step of the differences over unknowns of the size 1: losses are solved to 5 mK, and differences of the
/// same steps nearly cancel that.
pub(crate) const DIFFERENCE: f64 = 0.02;
/// Change of the unknowns below which the fit has ended.
const ENDED: f64 = 1e-3;
/// Greatest damping.
const STIFFEST: f64 = 1e8;

/// Where the sum of squares is least.
pub(crate) struct Least {
    pub at: DVector<f64>,
    pub residuals: DVector<f64>,
}

/// The least sum of squares from `at` on, in so many steps at most, until a step takes no more than `enough` of it.
pub(crate) fn least(
    mut at: DVector<f64>,
    (iterations, enough): (u32, f64),
    of: impl Fn(&DVector<f64>) -> Result<DVector<f64>, ThermalError>,
) -> Result<Least, ThermalError> {
    let mut residuals = of(&at)?;
    let mut damping = 1e-2;
    for _ in 0..iterations {
        let slopes = derivatives(&at, &residuals, &of)?;
        let normal = slopes.tr_mul(&slopes);
        let gradient = slopes.tr_mul(&residuals);
        let mut moved = None;
        while damping < STIFFEST && moved.is_none() {
            let mut damped = normal.clone();
            for k in 0..at.len() {
                damped[(k, k)] *= 1.0 + damping;
            }
            let step = damped.cholesky().map(|c| -c.solve(&gradient));
            let next = step.map(|step| &at + step);
            // A step beyond what numbers may be is too long.
            let better = next.and_then(|next| {
                let there = of(&next).ok()?;
                (there.norm_squared() < residuals.norm_squared()).then_some((next, there))
            });
            match better {
                Some(better) => moved = Some(better),
                None => damping *= 4.0,
            }
        }
        let Some((next, there)) = moved else {
            break;
        };
        damping = (0.25 * damping).max(1e-6);
        let change = (&next - &at).amax();
        let taken = residuals.norm_squared() - there.norm_squared();
        (at, residuals) = (next, there);
        if change < ENDED || taken < enough {
            break;
        }
    }
    Ok(Least { at, residuals })
}

/// Derivatives of the residuals by each unknown.
pub(crate) fn derivatives(
    at: &DVector<f64>,
    residuals: &DVector<f64>,
    of: impl Fn(&DVector<f64>) -> Result<DVector<f64>, ThermalError>,
) -> Result<DMatrix<f64>, ThermalError> {
    let mut slopes = DMatrix::zeros(residuals.len(), at.len());
    for k in 0..at.len() {
        let mut moved = at.clone();
        moved[k] += DIFFERENCE;
        slopes.set_column(k, &((of(&moved)? - residuals) / DIFFERENCE));
    }
    Ok(slopes)
}
