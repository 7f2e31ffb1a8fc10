//! The pieces of a path.

use std::sync::Arc as Shared;

use crate::{Arc, Line, Nurbs, PathPoint};

/// One piece of a path.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PathSegment<const D: usize> {
    /// A straight line.
    Line(Line<D>),
    /// A circular arc or a helix.
    Arc(Arc<D>),
    /// A NURBS curve.
    Nurbs(Shared<Nurbs<D>>),
}

impl<const D: usize> PathSegment<D> {
    /// Length, m.
    pub fn length(&self) -> f64 {
        match self {
            Self::Line(line) => line.length(),
            Self::Arc(arc) => arc.length(),
            Self::Nurbs(curve) => curve.length(),
        }
    }

    /// The point at arc length `s` (m) from its begin; an `s` outside is one of the ends.
    pub fn at(&self, s: f64) -> PathPoint<D> {
        let s = if s > 0.0 { s.min(self.length()) } else { 0.0 };
        match self {
            Self::Line(line) => line.at(s),
            Self::Arc(arc) => arc.at(s),
            Self::Nurbs(curve) => curve.at(s),
        }
    }
}

impl<const D: usize> From<Line<D>> for PathSegment<D> {
    fn from(line: Line<D>) -> Self {
        Self::Line(line)
    }
}

impl<const D: usize> From<Arc<D>> for PathSegment<D> {
    fn from(arc: Arc<D>) -> Self {
        Self::Arc(arc)
    }
}

impl<const D: usize> From<Nurbs<D>> for PathSegment<D> {
    fn from(curve: Nurbs<D>) -> Self {
        Self::Nurbs(Shared::new(curve))
    }
}
