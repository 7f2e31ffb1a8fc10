//! How evenly a design fills the unit cube.

pub use crate::coverage::{SpanningTree, coverage, mesh_ratio, spanning_tree};
pub use crate::discrepancies::{l2_star_discrepancy, mixture_discrepancy, wrap_around_discrepancy};
use crate::distance::distance;

use crate::Design;
use crate::kernel::Kernel;
use crate::power::power;
use rayon::prelude::*;

/// The squared centred L2 discrepancy CD² of a design in the unit cube (lower
/// is more even), Hickernell 1998, "A generalized discrepancy and quadrature
/// error bound", doi 10.1090/S0025-5718-98-00894-1. With z = x − ½:
///
/// CD² = (13/12)^m − (2/n) Σᵢ Πⱼ (1 + ½|zᵢⱼ| − ½zᵢⱼ²)
///       + (1/n²) Σᵢ Σₖ Πⱼ (1 + ½|zᵢⱼ| + ½|zₖⱼ| − ½|zᵢⱼ − zₖⱼ|).
///
/// This is the number that SciPy's `discrepancy(method="CD")` returns. All n²
/// pairs are summed, in O(n² m) time, by the current rayon pool; the bits do
/// not depend on the number of threads. Terms of size (13/12)^m cancel, which
/// leaves an absolute error of about 10⁻¹⁴ of that. Values outside [0, 1]
/// give a number without meaning.
pub fn centred_discrepancy(design: &Design) -> f64 {
    let kernel = Kernel::new(design);
    let n = kernel.len();
    // Collected in order and summed in order, whoever computed them.
    let rows: Vec<f64> = (0..n)
        .into_par_iter()
        .map(|i| 2.0 * kernel.row_sum(i) + kernel.own(i, i, 0))
        .collect();
    let pairs: f64 = rows.iter().sum();
    let means: f64 = (0..n).map(|i| kernel.mean(i, i, 0)).sum();
    let n = n as f64;
    power(13.0 / 12.0, kernel.dims()) - 2.0 * means / n + pairs / (n * n)
}

/// The least Euclidean distance between two points of the design (higher is
/// better spread: Johnson, Moore and Ylvisaker 1990, doi
/// 10.1016/0378-3758(90)90122-B); in the unit of the columns, infinite for a
/// single point.
pub fn minimum_distance(design: &Design) -> f64 {
    // In the order of the first column, points further on in it than the best
    // distance so far need not be looked at.
    let mut order: Vec<&[f64]> = design.rows().collect();
    order.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut best = f64::INFINITY;
    for (i, a) in order.iter().enumerate() {
        for b in &order[i + 1..] {
            if b[0] - a[0] >= best {
                break;
            }
            best = best.min(distance(a, b));
        }
    }
    best
}

/// φ_p = (Σ over pairs of d⁻ᵖ)^(1/p) of Morris and Mitchell 1995, doi
/// 10.1016/0378-3758(94)00035-T (lower is better spread); as p grows it tends
/// to the reciprocal of [`minimum_distance`]. In the reciprocal unit of the
/// columns; 0 for a single point, infinite when two points coincide.
///
/// `p` > 0 is the exponent; any other value returns NaN. O(n² m) time, by the
/// current rayon pool, bits independent of the number of threads.
pub fn phi_p(design: &Design, p: f64) -> f64 {
    // Written so that NaN is caught as well.
    if !(p > 0.0 && p.is_finite()) {
        return f64::NAN;
    }
    let least = minimum_distance(design);
    if !(least > 0.0 && least.is_finite()) {
        return 1.0 / least;
    }
    // In units of the least distance each term is at most 1: no overflow.
    let row_sum = |i: usize| -> f64 {
        let mut rows = design.rows();
        let others = rows.clone().take(i);
        let Some(a) = rows.nth(i) else { return 0.0 };
        let share = |b| {
            let nearness = least / distance(a, b);
            any_power(nearness * nearness, 0.5 * p)
        };
        others.map(share).sum()
    };
    let rows: Vec<f64> = (0..design.len()).into_par_iter().map(row_sum).collect();
    libm::pow(rows.iter().sum(), 1.0 / p) / least
}

/// x^e. By multiplications where `e` is a small whole number, because they
/// are many times faster; else by libm, which gives the same bits anywhere.
fn any_power(x: f64, e: f64) -> f64 {
    if e.fract() == 0.0 && e <= 64.0 {
        power(x, e as usize)
    } else {
        libm::pow(x, e)
    }
}
