//! Paths in space that lie in a plane of constant Z.

use crate::{Arc, Line, Nurbs, NurbsData, Path, PathSegment};

impl Path<3> {
    /// The same path in the plane of X and Y; none if Z moves.
    pub fn flattened(&self) -> Option<Path<2>> {
        let level = self.at(0.0).position[2];
        let mut flat = Vec::new();
        for segment in self.segments() {
            let [x, y, _] = segment.at(0.0).position;
            match segment {
                PathSegment::Line(line) => {
                    let [a, b, z] = line.to();
                    (z == level).then_some(())?;
                    flat.push(Line::new([x, y], [a, b]).ok()?.into());
                }
                PathSegment::Arc(arc) => {
                    let [cx, cy, cz] = arc.centre();
                    let [tx, ty, tz] = arc.at(0.0).tangent;
                    (cz == level && tz == 0.0).then_some(())?;
                    let arc = Arc::new([cx, cy], [x, y], [tx, ty], arc.sweep());
                    flat.push(arc.ok()?.into());
                }
                PathSegment::Nurbs(curve) => {
                    for (points, weights) in curve.bezier_pieces() {
                        flat.push(piece(&points, weights, level)?);
                    }
                }
            }
        }
        Path::new(flat).ok()
    }
}

/// A rational Bézier curve in the plane; none if a control point lies elsewhere.
fn piece(points: &[[f64; 3]], weights: Vec<f64>, level: f64) -> Option<PathSegment<2>> {
    // A quotient of products: off by some last bits.
    let near = 1e-12 + 1e-15 * level.abs();
    let is_flat = points.iter().all(|p| (p[2] - level).abs() <= near);
    is_flat.then_some(())?;
    let n = points.len();
    let curve = Nurbs::new(&NurbsData {
        degree: n - 1,
        points: points.iter().map(|[x, y, _]| [*x, *y]).collect(),
        weights,
        knots: (0..2 * n).map(|i| if i < n { 0.0 } else { 1.0 }).collect(),
    });
    curve.ok().map(PathSegment::from)
}
