//! A straight segment.

use crate::PathPoint;
use crate::error::{ToolpathError, coordinates, positive};
use crate::vector::{add_scaled, norm, scaled, sub};

/// A straight line between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<const D: usize> {
    from: [f64; D],
    direction: [f64; D],
    length: f64,
}

impl<const D: usize> Line<D> {
    /// The line from `from` to `to`, m.
    ///
    /// # Errors
    /// [`ToolpathError::Invalid`] if a coordinate is not finite or beyond 1e6 m, or the points
    /// are less than 1e-9 m apart.
    pub fn new(from: [f64; D], to: [f64; D]) -> Result<Self, ToolpathError> {
        coordinates("from", from)?;
        coordinates("to", to)?;
        let offset = sub(&to, &from);
        let length = positive("length of a line", norm(&offset), "m")?;
        let direction = scaled(1.0 / length, &offset);
        Ok(Self {
            from,
            direction,
            length,
        })
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// First point, m.
    pub fn from(&self) -> [f64; D] {
        self.from
    }

    /// Last point, m.
    pub fn to(&self) -> [f64; D] {
        add_scaled(&self.from, self.length, &self.direction)
    }

    /// Unit vector from the first point to the last.
    pub fn direction(&self) -> [f64; D] {
        self.direction
    }

    /// The point at arc length `s` (m), also beyond the ends.
    pub fn at(&self, s: f64) -> PathPoint<D> {
        PathPoint {
            position: add_scaled(&self.from, s, &self.direction),
            tangent: self.direction,
            curvature: [0.0; D],
            third: [0.0; D],
        }
    }
}
