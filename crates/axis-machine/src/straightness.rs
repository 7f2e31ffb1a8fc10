//! A deviation from a straight line over the position of an axis.

use crate::error::MachineError;

/// Deviation over position: a cubic spline through points, with zero second derivative at both ends, and straight on
/// beyond them.
///
/// Its first two derivatives are continuous, so that a reference that takes it away has no jump of speed or acceleration.
/// Natural spline (de Boor, A Practical Guide to Splines, 1978); its tridiagonal system is written down from the continuity of
/// the first derivative.
#[derive(Clone, Debug, PartialEq)]
pub struct Straightness {
    /// Position and deviation, m.
    points: Vec<[f64; 2]>,
    /// Second derivatives at the points, 1/m.
    second: Vec<f64>,
}

/// Most points of a table.
const MOST_POINTS: usize = 10_000;

impl Straightness {
    /// Through points of position and deviation, m, of axis `axis` (from 0, for messages).
    ///
    /// # Errors
    /// [`MachineError::Invalid`] for fewer than two points or more than 10 000, positions that do not rise by at least
    /// 1 µm, and deviations above 10 mm.
    pub fn new(axis: usize, points: Vec<[f64; 2]>) -> Result<Self, MachineError> {
        let refuse = |what, value, unit, valid: &str| {
            Err(MachineError::Invalid {
                what,
                axis: axis + 1,
                value,
                unit,
                valid: valid.to_owned(),
            })
        };
        if !(2..=MOST_POINTS).contains(&points.len()) {
            let (count, what) = (
                points.len() as f64,
                "the number of points of the straightness",
            );
            return refuse(what, count, "", "from 2 to 10 000");
        }
        for (i, [at, deviation]) in points.iter().enumerate() {
            let rises = i == 0 || at - points[i - 1][0] >= 1e-6;
            // False for a NaN too.
            if !(at.abs() <= 1e3 && rises) {
                let valid = "from -1000 to 1000 m, each at least 1e-6 m above the one before";
                return refuse("a position of the straightness", *at, "m", valid);
            }
            let small = deviation.abs() <= 0.01;
            if !small {
                let valid = "from -0.01 to 0.01 m";
                return refuse("a deviation of the straightness", *deviation, "m", valid);
            }
        }
        let second = second_derivatives(&points);
        Ok(Self { points, second })
    }

    /// Deviation (m) at a position (m), and its first three derivatives by the position.
    pub fn at(&self, position: f64) -> [f64; 4] {
        let last = self.points.len() - 1;
        let (begin, end) = (self.points[0], self.points[last]);
        if position < begin[0] || position > end[0] {
            // Straight on.
            let edge = if position < begin[0] { begin } else { end };
            let [value, slope, ..] = self.at(edge[0]);
            return [value + slope * (position - edge[0]), slope, 0.0, 0.0];
        }
        let after = self
            .points
            .partition_point(|p| p[0] <= position)
            .clamp(1, last);
        let ([x0, y0], [x1, y1]) = (self.points[after - 1], self.points[after]);
        let (m0, m1) = (self.second[after - 1], self.second[after]);
        let h = x1 - x0;
        let (a, b) = ((x1 - position) / h, (position - x0) / h);
        [
            a * y0 + b * y1 + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h * h / 6.0,
            (y1 - y0) / h + ((1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1) * h / 6.0,
            a * m0 + b * m1,
            (m1 - m0) / h,
        ]
    }
}

/// Of the spline at each point: h₀ m₀ + 2 (h₀ + h₁) m₁ + h₁ m₂ = 6 (Δ₁ − Δ₀) inside, 0 at the ends.
fn second_derivatives(points: &[[f64; 2]]) -> Vec<f64> {
    let n = points.len();
    let step = |i: usize| points[i + 1][0] - points[i][0];
    let slope = |i: usize| (points[i + 1][1] - points[i][1]) / step(i);
    let (mut upper, mut value) = (vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        let diagonal = 2.0 * (step(i - 1) + step(i)) - step(i - 1) * upper[i - 1];
        upper[i] = step(i) / diagonal;
        value[i] = (6.0 * (slope(i) - slope(i - 1)) - step(i - 1) * value[i - 1]) / diagonal;
    }
    for i in (1..n - 1).rev() {
        value[i] -= upper[i] * value[i + 1];
    }
    value
}
