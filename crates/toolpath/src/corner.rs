//! A blend in place of a corner at which an arc begins or ends, or of a jump of the curvature there.
//!
//! A Bézier curve from the distance d before the corner to d behind it, along the path, of which the ends have the path's
//! tangent; that of degree 5 has its curvature as well. With positions p, tangents t and curvature vectors c there, and
//! h = d/2, its control points are
//!
//! ```text
//! degree 5    p₀,  p₀ + h t₀,  p₀ + 2h t₀ + (5/4) h² c₀,  p₁ − 2h t₁ + (5/4) h² c₁,  p₁ − h t₁,  p₁
//! degree 3    p₀,  p₀ + (2/3) d t₀,  p₁ − (2/3) d t₁,  p₁
//! ```
//!
//! as C″ = 20 (P₂ − 2 P₁ + P₀) = 25 h² c at an end with C′ = 5 h t. Between lines both are the curves of [`Blend`] (of degree
//! 3 the parabola). d is the greatest at which the curve passes the corner within the tolerance, at most half of each
//! segment and half of an arc's radius.

use crate::vector::{add_scaled, dot, norm, scaled, sub};
use crate::{Blend, PathPoint, PathSegment, ToolpathError};

/// Curvatures that differ by less are the same, 1/m.
const JUMP: f64 = 1e-6;
/// Points of a curve at which its distance from the corner is taken.
const POINTS: u32 = 64;
/// Bisections of d: to 1e-12 of it.
const HALVINGS: u32 = 40;

/// Whether the curvature jumps from one to the other.
pub(crate) fn jumps<const D: usize>(before: &PathPoint<D>, after: &PathPoint<D>) -> bool {
    norm(&sub(&after.curvature, &before.curvature)) > JUMP
}

/// The curve, and how much of both segments it takes, m.
pub(crate) fn between<const D: usize>(
    shape: Blend,
    [before, after]: [&PathSegment<D>; 2],
    tolerance: f64,
) -> Result<(PathSegment<D>, f64), ToolpathError> {
    let (end, begin) = (before.at(f64::INFINITY), after.at(0.0));
    let corner = begin.position;
    let points = |d: f64| control(shape, &before.at(before.length() - d), &after.at(d), d);
    let bent = |point: &PathPoint<D>| 0.5 / point.curvature_size();
    let halves = 0.5 * before.length().min(after.length());
    let most = halves.min(bent(&end)).min(bent(&begin));
    let holds = |d: f64| distance(&points(d), &corner) <= tolerance;
    let mut range = [0.0, most];
    if holds(most) {
        range[0] = most;
    } else {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (range[0] + range[1]);
            range[usize::from(!holds(middle))] = middle;
        }
    }
    let d = range[0];
    Ok((PathSegment::bezier(points(d))?, d))
}

fn control<const D: usize>(
    shape: Blend,
    from: &PathPoint<D>,
    to: &PathPoint<D>,
    d: f64,
) -> Vec<[f64; D]> {
    let inner =
        |point: &PathPoint<D>, along: f64| add_scaled(&point.position, along, &point.tangent);
    if shape == Blend::Quintic {
        let h = 0.5 * d;
        let bent = |point: &PathPoint<D>, along: f64| {
            add_scaled(&inner(point, along), 1.25 * h * h, &point.curvature)
        };
        return vec![
            from.position,
            inner(from, h),
            bent(from, 2.0 * h),
            bent(to, -2.0 * h),
            inner(to, -h),
            to.position,
        ];
    }
    let handle = 2.0 / 3.0 * d;
    vec![
        from.position,
        inner(from, handle),
        inner(to, -handle),
        to.position,
    ]
}

/// Least distance of a Bézier curve from a point, m: at its points, and between them by a parabola over the squares.
fn distance<const D: usize>(control: &[[f64; D]], from: &[f64; D]) -> f64 {
    let squared = |k: u32| {
        let apart = sub(&bezier(control, f64::from(k) / f64::from(POINTS)), from);
        dot(&apart, &apart)
    };
    let all: Vec<f64> = (0..=POINTS).map(squared).collect();
    let least = (1..POINTS as usize).min_by(|a, b| all[*a].total_cmp(&all[*b]));
    let i = least.unwrap_or(1);
    let [a, b, c] = [all[i - 1], all[i], all[i + 1]];
    let bend = a - 2.0 * b + c;
    let below = if bend > 0.0 {
        (a - c) * (a - c) / (8.0 * bend)
    } else {
        0.0
    };
    (b - below).max(0.0).sqrt()
}

/// De Casteljau's algorithm.
fn bezier<const D: usize>(control: &[[f64; D]], u: f64) -> [f64; D] {
    let mut points = control.to_vec();
    for last in (1..points.len()).rev() {
        for i in 0..last {
            points[i] = add_scaled(&scaled(1.0 - u, &points[i]), u, &points[i + 1]);
        }
    }
    points[0]
}
