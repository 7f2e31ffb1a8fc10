//! L2 discrepancies beside the centred one: how evenly a design fills the unit
//! cube, each by its sum over all pairs of points.

use crate::Design;
use crate::power::power;
use rayon::prelude::*;

/// The squared wrap-around L2 discrepancy WD² (lower is more even), Hickernell
/// 1998, "Lattice rules: how well do they measure up?", doi
/// 10.1007/978-1-4612-1702-2_3. With t = |xᵢⱼ − xₖⱼ|:
///
/// WD² = −(4/3)^m + (1/n²) Σᵢ Σₖ Πⱼ (3/2 − t(1 − t)).
///
/// It does not change when all points are moved round the torus. This is the
/// number that SciPy's `discrepancy(method="WD")` returns. O(n² m) time by the
/// current rayon pool, bits independent of the number of threads; values
/// outside [0, 1] give a number without meaning.
pub fn wrap_around_discrepancy(design: &Design) -> f64 {
    let pairs = mean_of_pairs(design, |x, y| {
        let t = (x - y).abs();
        1.5 - t * (1.0 - t)
    });
    pairs - power(4.0 / 3.0, design.dims())
}

/// The squared mixture L2 discrepancy MD² (lower is more even), Zhou, Fang and
/// Ning 2013, doi 10.1016/j.jco.2012.11.006. With z = x − ½ and
/// t = |xᵢⱼ − xₖⱼ|:
///
/// MD² = (19/12)^m − (2/n) Σᵢ Πⱼ (5/3 − ¼|zᵢⱼ| − ¼zᵢⱼ²)
///       + (1/n²) Σᵢ Σₖ Πⱼ (15/8 − ¼|zᵢⱼ| − ¼|zₖⱼ| − ¾t + ½t²).
///
/// This is the number that SciPy's `discrepancy(method="MD")` returns. O(n² m)
/// time by the current rayon pool, bits independent of the number of threads;
/// values outside [0, 1] give a number without meaning.
pub fn mixture_discrepancy(design: &Design) -> f64 {
    let points = mean_of_points(design, |x| {
        let z = (x - 0.5).abs();
        5.0 / 3.0 - 0.25 * z - 0.25 * z * z
    });
    let pairs = mean_of_pairs(design, |x, y| {
        let (a, b, t) = ((x - 0.5).abs(), (y - 0.5).abs(), (x - y).abs());
        1.875 - 0.25 * a - 0.25 * b - 0.75 * t + 0.5 * t * t
    });
    power(19.0 / 12.0, design.dims()) - 2.0 * points + pairs
}

/// The L2-star discrepancy, not squared (lower is more even): the formula of
/// Warnock 1972 as Hickernell 1998, doi 10.1090/S0025-5718-98-00894-1, gives
/// it:
///
/// D² = 3⁻ᵐ − (2/n) Σᵢ Πⱼ (1 − xᵢⱼ²)/2 + (1/n²) Σᵢ Σₖ Πⱼ (1 − max(xᵢⱼ, xₖⱼ)).
///
/// This is the root that SciPy's `discrepancy(method="L2-star")` returns; its
/// other methods, like the other functions here, return squares. A square that
/// rounding has left below zero counts as zero. O(n² m) time by the current
/// rayon pool, bits independent of the number of threads; values outside
/// [0, 1] give a number without meaning.
pub fn l2_star_discrepancy(design: &Design) -> f64 {
    let points = mean_of_points(design, |x| 0.5 * (1.0 - x * x));
    let pairs = mean_of_pairs(design, |x, y| 1.0 - x.max(y));
    let square = power(1.0 / 3.0, design.dims()) - 2.0 * points + pairs;
    if square < 0.0 { 0.0 } else { square.sqrt() }
}

/// (1/n) Σᵢ Πⱼ factor(xᵢⱼ).
fn mean_of_points(design: &Design, factor: impl Fn(f64) -> f64) -> f64 {
    let product = |row: &[f64]| row.iter().map(|&x| factor(x)).product::<f64>();
    design.rows().map(product).sum::<f64>() / design.len() as f64
}

/// (1/n²) Σᵢ Σₖ Πⱼ factor(xᵢⱼ, xₖⱼ) of a symmetric factor. Collected in order
/// and summed in order, whoever computed the rows.
fn mean_of_pairs(design: &Design, factor: impl Fn(f64, f64) -> f64 + Sync) -> f64 {
    let dims = design.dims();
    let product = |a: &[f64], b: &[f64]| {
        let factors = a.iter().zip(b).map(|(&x, &y)| factor(x, y));
        factors.product::<f64>()
    };
    let row_sum = |(i, a): (usize, &[f64])| {
        let before = design.rows().take(i).map(|b| product(a, b));
        2.0 * before.sum::<f64>() + product(a, a)
    };
    let rows = design.values().par_chunks_exact(dims).enumerate();
    let rows: Vec<f64> = rows.map(row_sum).collect();
    let n = design.len() as f64;
    rows.iter().sum::<f64>() / (n * n)
}
