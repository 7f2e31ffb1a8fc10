//! What a path is at one place.

use crate::vector::{add_scaled, cube, dot, norm, scaled};

/// A point of a path and its derivatives by arc length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint<const D: usize> {
    /// Position x, m.
    pub position: [f64; D],
    /// Unit tangent x′, a pure number.
    pub tangent: [f64; D],
    /// Curvature vector x″, 1/m: perpendicular to the tangent, its length is the curvature.
    pub curvature: [f64; D],
    /// Third derivative x‴, 1/m².
    pub third: [f64; D],
}

impl<const D: usize> PathPoint<D> {
    /// Curvature κ = |x″|, 1/m.
    pub fn curvature_size(&self) -> f64 {
        norm(&self.curvature)
    }

    /// From derivatives by any parameter u, `[C, C′, C″, C‴]`.
    ///
    /// With σ = |C′|: u′ = 1/σ, u″ = −C′·C″/σ⁴, u‴ = −(C″·C″ + C′·C‴)/σ⁵ + 4 (C′·C″)²/σ⁷, and
    /// the chain rule.
    pub(crate) fn from_parameter(c: &[[f64; D]; 4]) -> Self {
        let speed = norm(&c[1]);
        let tangent = scaled(1.0 / speed, &c[1]);
        let u1 = 1.0 / speed;
        let along = dot(&tangent, &c[2]) * u1 * u1; // C'·C''/σ³
        let u2 = -along * u1;
        let u3 = u1
            * (4.0 * along * along - (dot(&c[2], &c[2]) + dot(&c[1], &c[3])) * u1 * u1 * u1 * u1);
        let curvature = add_scaled(&scaled(u1 * u1, &c[2]), u2, &c[1]);
        let third = add_scaled(&scaled(cube(u1), &c[3]), 3.0 * u1 * u2, &c[2]);
        Self {
            position: c[0],
            tangent,
            curvature,
            third: add_scaled(&third, u3, &c[1]),
        }
    }
}
