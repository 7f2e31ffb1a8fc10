//! Segments in a chain, by arc length.

use crate::error::{ToolpathError, within};
use crate::vector::{add_scaled, norm, sub};
use crate::{PathPoint, PathSegment};

/// How far two segments that meet may differ.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PathTolerances {
    /// Greatest distance between the end of a segment and the begin of the next, m; at most 1e-3.
    pub position: f64,
    /// Greatest angle between their tangents, rad, that is not yet a corner; at most 0.1.
    pub tangent: f64,
}

impl Default for PathTolerances {
    /// 1e-9 m and 1e-6 rad.
    fn default() -> Self {
        Self {
            position: 1e-9,
            tangent: 1e-6,
        }
    }
}

/// A place at which a derivative of the path jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Junction<const D: usize> {
    /// Arc length, m.
    pub s: f64,
    /// The path just before.
    pub before: PathPoint<D>,
    /// The path just after.
    pub after: PathPoint<D>,
    /// What jumps.
    pub kind: JunctionKind,
}

/// The lowest derivative that jumps at a junction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum JunctionKind {
    /// The tangent: the feed must be zero here.
    Corner,
    /// The curvature: at any feed but zero the acceleration of an axis jumps.
    Curvature,
    /// The third derivative at most: the jerk of an axis jumps.
    Third,
}

/// A path in `D` dimensions: segments that follow one another, by arc length.
#[derive(Clone, Debug, PartialEq)]
pub struct Path<const D: usize> {
    segments: Vec<PathSegment<D>>,
    /// Arc length at which each segment begins, and that of the end.
    starts: Vec<f64>,
    junctions: Vec<Junction<D>>,
}

impl<const D: usize> Path<D> {
    /// A path of `segments` with [`PathTolerances::default`].
    ///
    /// # Errors
    /// As [`Path::with_tolerances`].
    pub fn new(segments: Vec<PathSegment<D>>) -> Result<Self, ToolpathError> {
        Self::with_tolerances(segments, &PathTolerances::default())
    }

    /// A path of `segments`, each of which begins where the one before ends.
    ///
    /// # Errors
    /// [`ToolpathError::Count`] without a segment, [`ToolpathError::Gap`] if two do not meet,
    /// [`ToolpathError::Invalid`] for a tolerance.
    pub fn with_tolerances(
        segments: Vec<PathSegment<D>>,
        tolerances: &PathTolerances,
    ) -> Result<Self, ToolpathError> {
        let PathTolerances { position, tangent } = *tolerances;
        within(
            "position tolerance",
            position - 5e-4,
            "m",
            5e-4,
            "from 0 to 1e-3",
        )?;
        within(
            "tangent tolerance",
            tangent - 0.05,
            "rad",
            0.05,
            "from 0 to 0.1",
        )?;
        if segments.is_empty() {
            let valid = "at least one".to_owned();
            return Err(ToolpathError::Count {
                field: "segments",
                count: 0,
                valid,
            });
        }
        let mut path = Self {
            segments,
            starts: vec![0.0],
            junctions: Vec::new(),
        };
        for i in 0..path.segments.len() {
            let start = path.starts[i];
            if i > 0 {
                let before = path.segments[i - 1].at(f64::INFINITY);
                let after = path.segments[i].at(0.0);
                let gap = norm(&sub(&before.position, &after.position));
                // False for a NaN too.
                let holds = gap <= position;
                if !holds {
                    let number = i + 1;
                    return Err(ToolpathError::Gap {
                        number,
                        gap,
                        tolerance: position,
                    });
                }
                path.junctions
                    .push(Junction::new(start, before, after, tangent));
            }
            if let PathSegment::Nurbs(curve) = &path.segments[i] {
                for (k, s) in curve.knots().into_iter().enumerate() {
                    let (before, after) = (curve.beside_knot(k, false), curve.beside_knot(k, true));
                    path.junctions
                        .push(Junction::new(start + s, before, after, tangent));
                }
            }
            path.starts.push(start + path.segments[i].length());
        }
        Ok(path)
    }

    /// A chain of straight lines through `points` (m), of which two that follow one another
    /// differ.
    ///
    /// # Errors
    /// [`ToolpathError::Count`] for fewer than two points, and as [`Line::new`](crate::Line::new).
    pub fn polyline(points: &[[f64; D]]) -> Result<Self, ToolpathError> {
        let lines = points
            .windows(2)
            .map(|p| Ok(crate::Line::new(p[0], p[1])?.into()));
        Self::new(lines.collect::<Result<_, ToolpathError>>()?)
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.starts[self.segments.len()]
    }

    /// Its segments.
    pub fn segments(&self) -> &[PathSegment<D>] {
        &self.segments
    }

    /// Arc length (m) at which each segment begins, and that of the end.
    pub fn starts(&self) -> &[f64] {
        &self.starts
    }

    /// The places at which a derivative may jump, in order: between segments, and at the knots
    /// of a NURBS.
    pub fn junctions(&self) -> &[Junction<D>] {
        &self.junctions
    }

    /// Arc lengths (m) of the corners, at which the feed must be zero.
    pub fn corners(&self) -> Vec<f64> {
        let corners = self
            .junctions
            .iter()
            .filter(|j| j.kind == JunctionKind::Corner);
        corners.map(|j| j.s).collect()
    }

    /// Index of the segment that holds `s`: at a junction, of the later one.
    pub(crate) fn index(&self, s: f64) -> usize {
        let after = self.starts.partition_point(|&start| start <= s);
        after.clamp(1, self.segments.len()) - 1
    }

    /// The path at arc length `s` (m): at a junction, just after it; before the begin and after
    /// the end, those points.
    pub fn at(&self, s: f64) -> PathPoint<D> {
        let i = self.index(s);
        self.segments[i].at(s - self.starts[i])
    }
}

impl<const D: usize> Junction<D> {
    fn new(s: f64, before: PathPoint<D>, after: PathPoint<D>, tangent: f64) -> Self {
        let sizes = before.curvature_size() + after.curvature_size();
        let step = norm(&sub(&before.curvature, &after.curvature));
        let mut junction = Self {
            s,
            before,
            after,
            kind: JunctionKind::Third,
        };
        // Curvatures that are equal come out equal to about 1e-12; 1e-9 1/m is a straight line.
        junction.kind = if junction.angle() > tangent {
            JunctionKind::Corner
        } else if step > 1e-7 * sizes + 1e-9 {
            JunctionKind::Curvature
        } else {
            JunctionKind::Third
        };
        junction
    }

    /// Angle between the tangents, rad.
    pub fn angle(&self) -> f64 {
        let (a, b) = (&self.before.tangent, &self.after.tangent);
        2.0 * libm::atan2(norm(&sub(b, a)), norm(&add_scaled(a, 1.0, b)))
    }
}
