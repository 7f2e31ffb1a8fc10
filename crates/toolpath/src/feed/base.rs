//! A first motion along a stretch, which the rate then speeds up or slows down.

/// Values of the three quadratic B-splines of an interval at `x` from 0 to 1, and their first and
/// second derivatives by x.
pub(super) fn basis(x: f64) -> [[f64; 3]; 3] {
    let y = 1.0 - x;
    [
        [0.5 * y * y, 0.5 + x * y, 0.5 * x * x],
        [-y, 1.0 - 2.0 * x, x],
        [1.0, -2.0, 1.0],
    ]
}

/// Their integrals from 0 to `x`.
fn integrals(x: f64) -> [f64; 3] {
    let y = 1.0 - x;
    [
        (1.0 - y * y * y) / 6.0,
        x * (0.5 + x * (0.5 - x / 3.0)),
        x * x * x / 6.0,
    ]
}

/// Sum of three coefficients times three basis values.
pub(super) fn sum(c: &[f64], b: &[f64; 3]) -> f64 {
    c[0] * b[0] + c[1] * b[1] + c[2] * b[2]
}

/// s(τ) from standstill to standstill: its derivative is a quadratic spline on n intervals of
/// width 1 in τ, positive inside, and zero with zero slope at both ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Base {
    /// n + 2 coefficients of ds/dτ; the first and the last two are zero.
    slopes: Vec<f64>,
    /// s at each knot, m.
    knots: Vec<f64>,
}

/// s and its derivatives by τ.
#[derive(Clone, Copy, Debug)]
pub(super) struct BasePoint {
    pub(super) s: f64,
    pub(super) d: [f64; 3],
}

impl Base {
    /// From a table of arc lengths, from `table[0]` to the end, and the number of intervals
    /// wanted up to each, which rises.
    pub(super) fn new(table: &[(f64, f64)], n: usize) -> Self {
        let (first, last) = (table[0].0, table[table.len() - 1].0);
        let count: Vec<f64> = table.iter().map(|row| row.1).collect();
        let total = count[count.len() - 1];
        let mut i = 0;
        let mut edges: Vec<f64> = (0..=n)
            .map(|k| {
                let wanted = total * k as f64 / n as f64;
                while i + 2 < count.len() && count[i + 1] < wanted {
                    i += 1;
                }
                let share = (wanted - count[i]) / (count[i + 1] - count[i]);
                table[i].0 + share.clamp(0.0, 1.0) * (table[i + 1].0 - table[i].0)
            })
            .collect();
        edges[n] = last;
        // Mean slope of interval k − 1 for the spline in its middle, smoothed.
        let mut slopes = vec![0.0; n + 2];
        for k in 1..=n {
            slopes[k] = (edges[k] - edges[k - 1]).max(1e-12 * (last - first));
        }
        for _ in 0..4 {
            let before = slopes.clone();
            for k in 2..n {
                slopes[k] = 0.25 * (before[k - 1] + 2.0 * before[k] + before[k + 1]);
            }
        }
        // At both ends s ~ τ³, a constant jerk: coefficients of τ² are (k − 1) k.
        let last_slope = n + 1;
        let edge = (n / 8).min(8);
        for k in 0..edge {
            let share = (k as f64 - 1.0) * k as f64 / ((edge - 1) * edge) as f64;
            slopes[k] = share * slopes[edge];
            slopes[last_slope - k] = share * slopes[last_slope - edge];
        }
        let length: f64 = slopes.iter().sum();
        for slope in &mut slopes {
            *slope *= (last - first) / length;
        }
        let mut knots = vec![first];
        for k in 0..n {
            knots.push(knots[k] + sum(&slopes[k..], &integrals(1.0)));
        }
        knots[n] = last;
        Self { slopes, knots }
    }

    pub(super) fn intervals(&self) -> usize {
        self.knots.len() - 1
    }

    pub(super) fn at(&self, k: usize, x: f64) -> BasePoint {
        let b = basis(x);
        let c = &self.slopes[k..];
        let s = self.knots[k] + sum(c, &integrals(x));
        BasePoint {
            s,
            d: [sum(c, &b[0]), sum(c, &b[1]), sum(c, &b[2])],
        }
    }

    /// Interval and place in it of arc length `s`.
    pub(super) fn place(&self, s: f64) -> (usize, f64) {
        let k = self
            .knots
            .partition_point(|&knot| knot <= s)
            .clamp(1, self.intervals())
            - 1;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let x = 0.5 * (low + high);
            if self.at(k, x).s > s {
                high = x
            } else {
                low = x
            }
        }
        (k, 0.5 * (low + high))
    }
}
