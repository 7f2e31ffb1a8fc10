//! What a fit says of the parameters: the inverse of their covariance (information), and their variances.

use std::vec::Vec;

use super::coordinates::GAP;
use super::known::{ALL, Column, Full, Information, Known};
use super::parameter::{COUNT, Theta};
use super::record::Record;
use super::residual::{Residuals, Weights};

/// Least standard error of a parameter after a move, as a share: no model fits an axis more closely.
const MODEL: f64 = 5e-4;

/// Information about the parameters without the prior; their variances with it; the
/// transmission's free travel and its standard error, rad.
pub(super) fn information_from(
    known: &Known<'_>,
    record: &Record,
    at: &Column,
    (residuals, weights): (&Residuals, &Weights),
    free: &[usize],
) -> (Information, Theta, Option<[f64; 2]>) {
    // What the record says of the parameters once the nuisances are integrated out.
    let (mut unused, mut of_record) = (Column::zeros(), Full::zeros());
    residuals.add_to(weights, &mut unused, &mut of_record);
    let [parameters, nuisances]: [Vec<usize>; 2] = [true, false].map(|of| {
        free.iter()
            .copied()
            .filter(|&i| (i < COUNT) == of)
            .collect()
    });
    for &i in &nuisances {
        of_record[(i, i)] += known.precision(record, i, at[i]);
    }
    let within = inverse(&of_record, &nuisances).unwrap_or_else(Full::zeros);
    let marginal = of_record - of_record * within * of_record;
    // (M⁻¹ + ε²)⁻¹ = M − M (M + ε⁻²)⁻¹ M, whatever M does not determine.
    let mut sharp = marginal;
    for &i in &parameters {
        sharp[(i, i)] += 1.0 / (MODEL * MODEL);
    }
    let sharp = inverse(&sharp, &parameters).unwrap_or_else(Full::zeros);
    let blunt = marginal - marginal * sharp * marginal;
    let mut information = known.information;
    for &i in &parameters {
        for &j in &parameters {
            information[(i, j)] += 0.5 * (blunt[(i, j)] + blunt[(j, i)]);
        }
    }

    let mut all = Full::zeros();
    for i in 0..COUNT {
        all[(i, i)] = known.precision(record, i, at[i]);
        for j in 0..COUNT {
            all[(i, j)] += information[(i, j)];
        }
    }
    let adapted: Vec<usize> = (0..COUNT).filter(|&i| all[(i, i)].is_finite()).collect();
    let covariance = inverse(&all, &adapted).unwrap_or_else(Full::zeros);
    let (_, curvature) = known.normal(record, at, residuals, weights);
    let gap = free.contains(&GAP).then(|| {
        let variance = inverse(&curvature, free).map_or(f64::INFINITY, |v| v[(GAP, GAP)]);
        [2.0 * at[GAP], 2.0 * variance.sqrt()]
    });
    let variances = std::array::from_fn(|i| covariance[(i, i)].max(0.0));
    (information, variances, gap)
}

/// Inverse of the rows and columns of `kept`, scaled so that units do not matter; 0
/// elsewhere.
pub(super) fn inverse(curvature: &Full, kept: &[usize]) -> Option<Full> {
    let scale = |i: usize| 1.0 / curvature[(i, i)].abs().sqrt().max(1e-150);
    let mut scaled = Full::identity();
    for &i in kept {
        for &j in kept {
            scaled[(i, j)] = curvature[(i, j)] * scale(i) * scale(j);
        }
    }
    let mut inverse = scaled.cholesky()?.inverse();
    for i in 0..ALL {
        for j in 0..ALL {
            let both = kept.contains(&i) && kept.contains(&j);
            inverse[(i, j)] *= if both { scale(i) * scale(j) } else { 0.0 };
        }
    }
    Some(inverse)
}
