//! One S-curve along one line or one arc.

use trajectories::{Limits, Motion, SCurve};

use super::FeedLimits;
use crate::error::ToolpathError;
use crate::{Path, PathSegment};

/// The S-curve over `from` to `to` (m), if that is one segment of constant curvature.
///
/// Along a line the limits of axis i are its own over |x′_i|. On an arc, over whose turn axis i has
/// the amplitudes c₁ of x′ and c₂ = c₁κ, c₃ = c₁κ² of x″ and x‴ in quadrature: with a feed V, an
/// acceleration A and a jerk J in s
///
/// ```text
/// c₁ √((κV²)² + A²) ≤ a_i          c₁ √((κ²V³ + J)² + (3κVA)²) ≤ j_i
/// ```
///
/// keep those of the axis. V and A are those of least duration among 40 × 40.
pub(super) fn plan<const D: usize>(
    path: &Path<D>,
    limits: &FeedLimits<D>,
    (from, to): (f64, f64),
) -> Result<Option<SCurve<f64>>, ToolpathError> {
    let index = path.index(from);
    if path.starts()[index] != from || path.starts()[index + 1] != to {
        return Ok(None);
    }
    match &path.segments()[index] {
        PathSegment::Line(line) => {
            let direction = line.direction();
            let least = |values: &[f64; D]| {
                (0..D)
                    .map(|i| values[i] / direction[i].abs())
                    .fold(f64::INFINITY, f64::min)
            };
            let feed = least(&limits.velocity).min(limits.feed);
            let (acceleration, jerk) = (least(&limits.acceleration), least(&limits.jerk));
            let limits = Limits::<f64>::new(feed, acceleration, jerk)?;
            Ok(Some(SCurve::plan(from, to, &limits)?))
        }
        PathSegment::Arc(arc) => {
            let amplitudes: [[f64; 3]; D] = std::array::from_fn(|i| arc.amplitudes(i));
            let most = |order: usize, values: &[f64; D]| {
                (0..D)
                    .map(|i| values[i] / amplitudes[i][order])
                    .fold(f64::INFINITY, f64::min)
            };
            // In units of s: limits of the axis with the least room for each.
            let kappa = amplitudes
                .iter()
                .map(|a| a[1] / a[0].max(1e-300))
                .fold(0.0, f64::max);
            let a = most(0, &limits.acceleration);
            let j = most(0, &limits.jerk);
            let feed = limits.feed.min(most(0, &limits.velocity));
            fastest((from, to), feed, a, j, kappa)
        }
        PathSegment::Nurbs(_) => Ok(None),
    }
}

fn fastest(
    (from, to): (f64, f64),
    feed: f64,
    a: f64,
    j: f64,
    kappa: f64,
) -> Result<Option<SCurve<f64>>, ToolpathError> {
    const STEPS: u32 = 40;
    let most = feed
        .min((a / kappa).sqrt())
        .min(libm::cbrt(j / (kappa * kappa)));
    let mut best: Option<SCurve<f64>> = None;
    for m in 1..=STEPS {
        let v = most * f64::from(m) / f64::from(STEPS);
        let centripetal = kappa * v * v;
        let room = (a * a - centripetal * centripetal).max(0.0).sqrt();
        for n in 1..=STEPS {
            let along = room * f64::from(n) / f64::from(STEPS);
            let cross = 3.0 * kappa * v * along;
            let jerk = (j * j - cross * cross).max(0.0).sqrt() - kappa * kappa * v * v * v;
            // False for a NaN too.
            let holds = jerk > 0.0 && along > 0.0;
            if !holds {
                continue;
            }
            let Ok(limits) = Limits::<f64>::new(v, along, jerk) else {
                continue;
            };
            let curve = SCurve::plan(from, to, &limits)?;
            if best
                .as_ref()
                .is_none_or(|best| curve.duration() < best.duration())
            {
                best = Some(curve);
            }
        }
    }
    Ok(best)
}
