//! Blends in place of the corners of a path.

use crate::corner;
use crate::error::positive;
use crate::vector::{add_scaled, norm};
use crate::{Blend, Line, Path, PathSegment, ToolpathError};

/// How the corners of a path are blended.
///
/// As in LinuxCNC under `G64 P`, the path passes each programmed corner within the tolerance (LinuxCNC documentation, *G Codes*, section
/// "G64 Path Blending", <https://linuxcnc.org/docs/html/gcode/g-code.html#gcode:g64>). A blend takes at most half of each segment, so that it
/// may be smaller than the tolerance allows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PathBlending {
    /// Greatest distance of the path from a corner, m.
    pub tolerance: f64,
    /// Shape of the blends.
    pub shape: Blend,
}

/// Angles between which a corner is blended, rad: below, it is none; above, the path turns back and stops.
const ANGLES: (f64, f64) = (1e-6, std::f64::consts::PI - 1e-3);

/// Lines shorter than this are left out, m.
const SHORTEST: f64 = 1e-9;

impl<const D: usize> Path<D> {
    /// The same path with blends in place of the corners of lines and arcs, and of shape [`Blend::Quintic`] in place of the jumps of
    /// curvature at which an arc begins or ends, too. At an arc the other shapes are a curve of degree 3, as a parabola has no
    /// place for the tangents of an arc. Corners at a NURBS stay corners, as do those at which the path turns back.
    ///
    /// # Errors
    /// [`ToolpathError::Invalid`] for a tolerance that is not from 1e-9 to 1e9 m.
    pub fn blended(&self, blending: &PathBlending) -> Result<Self, ToolpathError> {
        positive("tolerance of a blend", blending.tolerance, "m")?;
        let all = vec![Some(blending.tolerance); self.segments().len()];
        Self::new(blended(self.segments(), &all, blending.shape)?)
    }
}

/// What a blend takes of the segment behind it.
struct Taken<const D: usize> {
    length: f64,
    /// Where it ends.
    to: [f64; D],
}

/// Segments with blends where the tolerance (m) of the segment before a corner is there.
pub(crate) fn blended<const D: usize>(
    segments: &[PathSegment<D>],
    tolerances: &[Option<f64>],
    shape: Blend,
) -> Result<Vec<PathSegment<D>>, ToolpathError> {
    let mut all: Vec<PathSegment<D>> = Vec::new();
    let mut taken: Option<Taken<D>> = None;
    for (i, segment) in segments.iter().enumerate() {
        let tolerance = tolerances.get(i).copied().flatten();
        let blend = match (segments.get(i + 1), tolerance) {
            (Some(next), Some(tolerance)) => blend([segment, next], tolerance, shape)?,
            _ => None,
        };
        let before = taken.take();
        match segment {
            PathSegment::Line(line) => {
                let from = before.map_or(line.from(), |taken| taken.to);
                let to = blend
                    .as_ref()
                    .map_or(line.to(), |(curve, _)| curve.at(0.0).position);
                // Both blends of a line may meet in its middle.
                let apart: f64 = (0..D)
                    .map(|k| (to[k] - from[k]) * line.direction()[k])
                    .sum();
                if apart >= SHORTEST {
                    all.push(Line::new(from, to)?.into());
                }
            }
            PathSegment::Arc(arc) if before.is_some() || blend.is_some() => {
                let from = before.map_or(0.0, |taken| taken.length);
                let to = arc.length() - blend.as_ref().map_or(0.0, |(_, length)| *length);
                if to - from >= SHORTEST {
                    all.push(arc.part([from, to]).into());
                }
            }
            other => all.push(other.clone()),
        }
        if let Some((curve, length)) = blend {
            let to = curve.at(f64::INFINITY).position;
            taken = Some(Taken { length, to });
            all.push(curve);
        }
    }
    Ok(all)
}

/// The blend between two segments, and what it takes of each, m; none if there is no corner, or one that stays.
fn blend<const D: usize>(
    [before, after]: [&PathSegment<D>; 2],
    tolerance: f64,
    shape: Blend,
) -> Result<Option<(PathSegment<D>, f64)>, ToolpathError> {
    let (end, begin) = (before.at(f64::INFINITY), after.at(0.0));
    let angle = turn(&end.tangent, &begin.tangent);
    let turns = (ANGLES.0..=ANGLES.1).contains(&angle);
    Ok(match (before, after) {
        (PathSegment::Line(a), PathSegment::Line(b)) if turns => {
            let (_, curve, _) = shape.between(a, b, tolerance)?;
            // The line's trimmed end is where the curve begins.
            Some((curve, 0.0))
        }
        (PathSegment::Line(_), PathSegment::Line(_)) => None,
        (PathSegment::Nurbs(_), _) | (_, PathSegment::Nurbs(_)) => None,
        // A curve whose curvature jumps itself is of no use where nothing but the curvature does.
        _ if turns
            || (angle < ANGLES.0 && shape == Blend::Quintic && corner::jumps(&end, &begin)) =>
        {
            Some(corner::between(shape, [before, after], tolerance)?)
        }
        _ => None,
    })
}

/// Angle between two directions, rad.
fn turn<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let [apart, together] = [-1.0, 1.0].map(|sign| norm(&add_scaled(b, sign, a)));
    2.0 * libm::atan2(apart, together)
}
