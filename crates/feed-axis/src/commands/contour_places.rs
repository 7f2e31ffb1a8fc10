//! Corners and tight curves of a path, with the contour error there.

use serde::{Deserialize, Serialize};
use toolpath::{FeedProfile, Foot, JunctionKind};

/// A corner or a curve.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Place {
    /// Part of the path.
    pub part: String,
    /// Arc length from the part's begin.
    pub s_mm: f64,
    /// Angle of a corner.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<f64>,
    /// Radius of a curve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_mm: Option<f64>,
    /// Greatest contour error near it.
    pub error_um: f64,
}

impl Place {
    /// Angle or radius, in words.
    pub fn shape(&self) -> String {
        match (self.angle_deg, self.radius_mm) {
            (Some(angle), _) => format!("{angle:.1}°"),
            (_, Some(radius)) => format!("radius {radius:.4} mm"),
            _ => String::new(),
        }
    }
}

/// How far from a corner or a curve its error is looked for, m.
const NEAR: f64 = 0.5e-3;

/// Points in which curves are looked for.
const POINTS: u32 = 20_000;

/// Curves above this radius are none, m; a circular test is one arc.
const WIDEST: f64 = 0.01;

/// Curves that are listed of a part, the tightest ones.
const MOST: usize = 10;

/// Corners and curves of a part of a path.
pub fn places<const D: usize>(
    profile: &FeedProfile<D>,
    feet: &[Foot<D>],
    part: &str,
) -> [Vec<Place>; 2] {
    let path = profile.path();
    let near = |s: f64| {
        let there = feet.iter().filter(|foot| (foot.s - s).abs() <= NEAR);
        1e6 * there.map(|foot| foot.length()).fold(0.0, f64::max)
    };
    let place = |s: f64, angle_deg, radius_mm| Place {
        part: part.to_owned(),
        s_mm: 1e3 * s,
        angle_deg,
        radius_mm,
        error_um: near(s),
    };
    let corners = path
        .junctions()
        .iter()
        .filter(|j| j.kind == JunctionKind::Corner);
    let corners = corners
        .map(|j| place(j.s, Some(j.angle().to_degrees()), None))
        .collect();
    let step = path.length() / f64::from(POINTS);
    let bends: Vec<f64> = (0..=POINTS)
        .map(|k| path.at(step * f64::from(k)).curvature_size())
        .collect();
    // Along an arc the middle of what is equal.
    let mut tight = Vec::new();
    let mut k = 1;
    while k + 1 < bends.len() {
        let same = bends[k..]
            .iter()
            .take_while(|b| (*b - bends[k]).abs() <= 1e-9 * bends[k])
            .count();
        let after = bends.get(k + same).copied().unwrap_or(0.0);
        if bends[k] > 1.0 / WIDEST && bends[k - 1] < bends[k] && after < bends[k] {
            tight.push((bends[k], step * (k as f64 + 0.5 * (same - 1) as f64)));
        }
        k += same.max(1);
    }
    tight.sort_by(|a, b| b.0.total_cmp(&a.0));
    tight.truncate(MOST);
    tight.sort_by(|a, b| a.1.total_cmp(&b.1));
    let curves = tight
        .iter()
        .map(|&(bend, s)| place(s, None, Some(1e3 / bend)));
    [corners, curves.collect()]
}
