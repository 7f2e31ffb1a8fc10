//! Blends in place of the corners of a path.

use crate::error::positive;
use crate::{Blend, Line, Path, PathSegment, ToolpathError};

/// How the corners of a path are blended.
///
/// As in LinuxCNC under `G64 P`, the path passes each programmed corner within the tolerance (LinuxCNC documentation, *G Codes*, section
/// "G64 Path Blending", <https://linuxcnc.org/docs/html/gcode/g-code.html#gcode:g64>). A blend takes at most half of each line, so that it
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

/// Angles between which a corner of two lines is blended, rad: below, it is none; above, the path turns back and stops.
const ANGLES: (f64, f64) = (1e-6, std::f64::consts::PI - 1e-3);

/// Lines shorter than this are left out, m.
const SHORTEST: f64 = 1e-9;

impl<const D: usize> Path<D> {
    /// The same path with blends in place of the corners between two lines. Corners at an arc or a NURBS stay corners, as do those at which
    /// the path turns back.
    ///
    /// # Errors
    /// [`ToolpathError::Invalid`] for a tolerance that is not from 1e-9 to 1e9 m.
    pub fn blended(&self, blending: &PathBlending) -> Result<Self, ToolpathError> {
        positive("tolerance of a blend", blending.tolerance, "m")?;
        let all = vec![Some(blending.tolerance); self.segments().len()];
        Self::new(blended(self.segments(), &all, blending.shape)?)
    }
}

/// Segments with blends where the tolerance (m) of the segment before a corner of two lines is there.
pub(crate) fn blended<const D: usize>(
    segments: &[PathSegment<D>],
    tolerances: &[Option<f64>],
    shape: Blend,
) -> Result<Vec<PathSegment<D>>, ToolpathError> {
    let mut all: Vec<PathSegment<D>> = Vec::new();
    // Where the segment begins that comes next, if a blend has moved that.
    let mut begin = None;
    for (i, segment) in segments.iter().enumerate() {
        let next = segments.get(i + 1);
        let tolerance = tolerances.get(i).copied().flatten();
        let blend = match (segment, next, tolerance) {
            (PathSegment::Line(a), Some(PathSegment::Line(b)), Some(tolerance)) if turns(a, b) => {
                let (_, curve, _) = shape.between(a, b, tolerance)?;
                Some(curve)
            }
            _ => None,
        };
        match segment {
            PathSegment::Line(line) => {
                let from = begin.take().unwrap_or(line.from());
                let to = blend
                    .as_ref()
                    .map_or(line.to(), |curve| curve.at(0.0).position);
                // Both blends of a line may meet in its middle.
                let apart: f64 = (0..D)
                    .map(|k| (to[k] - from[k]) * line.direction()[k])
                    .sum();
                if apart >= SHORTEST {
                    all.push(Line::new(from, to)?.into());
                }
            }
            other => all.push(other.clone()),
        }
        if let Some(curve) = blend {
            begin = Some(curve.at(f64::INFINITY).position);
            all.push(curve);
        }
    }
    Ok(all)
}

/// Whether the corner of two lines is one that is blended.
fn turns<const D: usize>(a: &Line<D>, b: &Line<D>) -> bool {
    let (t0, t1) = (a.direction(), b.direction());
    let [mut apart, mut together] = [0.0; 2];
    for k in 0..D {
        apart += (t1[k] - t0[k]) * (t1[k] - t0[k]);
        together += (t1[k] + t0[k]) * (t1[k] + t0[k]);
    }
    let angle = 2.0 * libm::atan2(libm::sqrt(apart), libm::sqrt(together));
    (ANGLES.0..=ANGLES.1).contains(&angle)
}
