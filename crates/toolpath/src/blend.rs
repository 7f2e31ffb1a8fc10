//! A curve in place of the corner between two lines.

use crate::error::{ToolpathError, positive};
use crate::vector::{add_scaled, dot, norm, sub};
use crate::{Arc, Line, Nurbs, NurbsData, PathSegment};

/// Shape of a blend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum Blend {
    /// A circular arc: its curvature jumps at both ends, so that a feed of limited jerk must
    /// stop there, unless [`FeedLimits::acceleration_step`](crate::FeedLimits::acceleration_step) allows a step.
    Arc,
    /// A parabola: what becomes of a corner if one line ends at a constant deceleration while the next one begins at the same
    /// acceleration. Its curvature jumps at both ends, too.
    Parabola,
    /// A Bézier curve of degree 5 whose curvature is zero at both ends.
    Quintic,
}

impl Blend {
    /// The blend of two lines that meet, and the shortened lines before and after it; a line
    /// that the blend takes up is `None`.
    ///
    /// The curve's least distance from the corner is `tolerance` (m), or less if the blend would
    /// take more than half of a line.
    ///
    /// With half of the angle between the directions, θ/2, and a blend that begins and ends at a
    /// distance d of the corner: arc of radius r, d = r tan(θ/2), distance from the corner
    /// r (1/cos(θ/2) − 1). The quintic has control points at distances d, d/2 and 0 from the
    /// corner on each line; its middle is (d + 5 d/2)/32 · 2 sin(θ/2) = (7/32) d sin(θ/2) from
    /// the corner. The parabola has them at d, 0 and d; its middle is d/4 · 2 sin(θ/2) = (1/2) d sin(θ/2) from it.
    ///
    /// # Errors
    /// [`ToolpathError::Blend`] if the lines turn by less than 1e-6 rad, or by more than
    /// π − 1e-3; [`ToolpathError::Gap`] if they do not meet; [`ToolpathError::Invalid`] for the
    /// tolerance.
    pub fn between<const D: usize>(
        self,
        before: &Line<D>,
        after: &Line<D>,
        tolerance: f64,
    ) -> Result<(Option<Line<D>>, PathSegment<D>, Option<Line<D>>), ToolpathError> {
        positive("tolerance of a blend", tolerance, "m")?;
        let corner = before.to();
        let gap = norm(&sub(&corner, &after.from()));
        // False for a NaN too.
        let holds = gap <= 1e-9;
        if !holds {
            return Err(ToolpathError::Gap {
                number: 2,
                gap,
                tolerance: 1e-9,
            });
        }
        let (t0, t1) = (before.direction(), after.direction());
        let chord = norm(&sub(&t1, &t0)); // 2 sin(θ/2)
        let half = libm::atan2(chord, norm(&add_scaled(&t1, 1.0, &t0)));
        if !(5e-7..=std::f64::consts::FRAC_PI_2 - 5e-4).contains(&half) {
            let valid = "from 1e-6 to 3.1406";
            return Err(ToolpathError::Blend {
                angle: 2.0 * half,
                valid,
            });
        }
        let (sin, cos) = libm::sincos(half);
        let per_distance = match self {
            Self::Arc => (1.0 - cos) / sin, // (1/cos − 1)/tan
            Self::Parabola => 0.5 * sin,
            Self::Quintic => 7.0 / 32.0 * sin,
        };
        let most = 0.5 * before.length().min(after.length());
        let d = (tolerance / per_distance).min(most);
        let begin = add_scaled(&corner, -d, &t0);
        let end = add_scaled(&corner, d, &t1);
        let shortened = |from, to| Line::new(from, to).ok();
        let curve = match self {
            Self::Arc => {
                let radius = d * cos / sin;
                let out = add_scaled(&t1, -dot(&t1, &t0), &t0);
                let centre = add_scaled(&begin, radius / norm(&out), &out);
                PathSegment::Arc(Arc::new(centre, begin, t0, 2.0 * half)?)
            }
            Self::Parabola => PathSegment::bezier(vec![begin, corner, end])?,
            Self::Quintic => {
                let points = vec![
                    begin,
                    add_scaled(&corner, -0.5 * d, &t0),
                    corner,
                    corner,
                    add_scaled(&corner, 0.5 * d, &t1),
                    end,
                ];
                PathSegment::bezier(points)?
            }
        };
        Ok((
            shortened(before.from(), begin),
            curve,
            shortened(end, after.to()),
        ))
    }
}

impl<const D: usize> PathSegment<D> {
    /// The Bézier curve of the given control points, m.
    ///
    /// # Errors
    /// As [`Nurbs::new`].
    pub fn bezier(points: Vec<[f64; D]>) -> Result<Self, ToolpathError> {
        let n = points.len();
        let knots = (0..2 * n).map(|i| if i < n { 0.0 } else { 1.0 }).collect();
        let (degree, weights) = (n.saturating_sub(1), Vec::new());
        Ok(Self::from(Nurbs::new(&NurbsData {
            degree,
            points,
            weights,
            knots,
        })?))
    }
}
