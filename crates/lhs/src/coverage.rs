//! How the points of a design lie to their nearest neighbours.

use crate::Design;
use rayon::prelude::*;

use crate::distance::distance;

/// The edges of the shortest tree that joins all points.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpanningTree {
    /// Mean length of the n − 1 edges, in the unit of the columns: higher is
    /// better spread.
    pub mean: f64,
    /// Standard deviation of their lengths (divided by n − 1 edges), in the
    /// unit of the columns: lower is more regular.
    pub deviation: f64,
}

/// The minimum spanning tree by Euclidean distance, a criterion of Franco,
/// Vasseur, Corre and Sergent 2009, doi 10.1016/j.chemolab.2009.03.011, by
/// Prim's algorithm in O(n² m) time; none for a single point.
///
/// `mean` is what SciPy's `geometric_discrepancy(method="mst")` returns for a
/// design without coinciding points. SciPy leaves edges of length zero out,
/// here they count.
pub fn spanning_tree(design: &Design) -> Option<SpanningTree> {
    let mut outside: Vec<(&[f64], f64)> = design.rows().map(|r| (r, f64::INFINITY)).collect();
    let (mut last, _) = outside.pop()?;
    let mut edges = Vec::with_capacity(outside.len());
    while !outside.is_empty() {
        let mut nearest = (0, f64::INFINITY);
        for (at, (point, gap)) in outside.iter_mut().enumerate() {
            *gap = gap.min(distance(point, last));
            if *gap < nearest.1 {
                nearest = (at, *gap);
            }
        }
        let (point, gap) = outside.swap_remove(nearest.0);
        edges.push(gap);
        last = point;
    }
    let (mean, deviation) = mean_and_deviation(&edges)?;
    Some(SpanningTree { mean, deviation })
}

/// The coverage measure λ of Gunzburger and Burkardt 2004, "Uniformity
/// measures for point samples in hypercubes": the standard deviation of the
/// nearest-neighbour distances γᵢ (divided by n) over their mean. Without
/// unit; 0 for a regular grid, so lower is more regular. None for a single
/// point and where all points coincide. O(n² m) time by the current rayon
/// pool.
pub fn coverage(design: &Design) -> Option<f64> {
    let (mean, deviation) = mean_and_deviation(&nearest_neighbours(design)?)?;
    (mean > 0.0 && mean.is_finite()).then(|| deviation / mean)
}

/// The mesh ratio, max γᵢ / min γᵢ of the nearest-neighbour distances, as
/// Gunzburger and Burkardt 2004 have it. Without unit, at least 1; 1 for a
/// regular grid, infinite where only some points coincide. None for a single
/// point and where all points coincide. O(n² m) time by the current rayon
/// pool.
pub fn mesh_ratio(design: &Design) -> Option<f64> {
    let gaps = nearest_neighbours(design)?;
    let most = gaps.iter().fold(0.0, |a: f64, &b| a.max(b));
    let least = gaps.iter().fold(f64::INFINITY, |a, &b| a.min(b));
    (most > 0.0 && least.is_finite()).then(|| most / least)
}

/// γᵢ of every point; none for a single point.
fn nearest_neighbours(design: &Design) -> Option<Vec<f64>> {
    let nearest = |(i, a): (usize, &[f64])| {
        let others = design.rows().enumerate().filter(|&(k, _)| k != i);
        others.fold(f64::INFINITY, |best, (_, b)| best.min(distance(a, b)))
    };
    let rows = design.values().par_chunks_exact(design.dims()).enumerate();
    (design.len() > 1).then(|| rows.map(nearest).collect())
}

/// Mean and standard deviation, divided by the number of values; in units of
/// the greatest value, so that no square overflows or vanishes.
fn mean_and_deviation(values: &[f64]) -> Option<(f64, f64)> {
    if values.is_empty() {
        return None;
    }
    let unit = values.iter().fold(0.0, |a: f64, &b| a.max(b));
    if unit == 0.0 || unit.is_infinite() {
        return Some((unit, 0.0));
    }
    let n = values.len() as f64;
    let mean = values.iter().map(|v| v / unit).sum::<f64>() / n;
    let square = |v: &f64| (v / unit - mean) * (v / unit - mean);
    let variance = values.iter().map(square).sum::<f64>() / n;
    Some((mean * unit, variance.sqrt() * unit))
}
