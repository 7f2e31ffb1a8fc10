//! Integral of a positive function, and its inverse.

/// Nodes and weights of the Gauss–Legendre rule of 10 points on [−1, 1], upper half: Abramowitz
/// and Stegun, table 25.4.
const RULE: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_4),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// The integral of `f` from `a` to `b`, exact for polynomials of degree 19.
pub(crate) fn gauss(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (half, middle) = (0.5 * (b - a), 0.5 * (a + b));
    let sum: f64 = RULE
        .iter()
        .map(|&(x, w)| w * (f(middle - half * x) + f(middle + half * x)))
        .sum();
    half * sum
}

/// Panels on which one Gauss rule is exact enough, and the integral up to each edge.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Panels {
    edges: Vec<f64>,
    sums: Vec<f64>,
    /// The function at the edges.
    values: Vec<f64>,
}

impl Panels {
    /// Halves the panels between `edges` until a panel and its halves agree within `tolerance`
    /// times the panel's share of the range.
    ///
    /// Fails with the place at which that needs more than 40 halvings, or `f` is at most `least`
    /// in the middle of a panel.
    pub(crate) fn adaptive(
        edges: &[f64],
        tolerance: f64,
        least: f64,
        f: impl Fn(f64) -> f64,
    ) -> Result<Self, f64> {
        let mut panels = Self::default();
        panels.push(edges[0], 0.0, f(edges[0]));
        let range = edges[edges.len() - 1] - edges[0];
        for pair in edges.windows(2) {
            let mut waiting = vec![(pair[0], pair[1], gauss(pair[0], pair[1], &f), 0)];
            while let Some((a, b, whole, depth)) = waiting.pop() {
                let middle = 0.5 * (a + b);
                let (left, right) = (gauss(a, middle, &f), gauss(middle, b, &f));
                // Rounding of a sum of ten terms is the floor below which no halving helps.
                let floor = 1e-15 * whole;
                let share = tolerance * ((b - a) / range);
                // False for a NaN too.
                let holds = f(middle) > least;
                if !holds {
                    return Err(middle);
                } else if (left + right - whole).abs() <= share.max(floor) {
                    panels.push(middle, left, f(middle));
                    panels.push(b, right, f(b));
                } else if depth == 40 {
                    return Err(middle);
                } else {
                    waiting.push((middle, b, right, depth + 1));
                    waiting.push((a, middle, left, depth + 1));
                }
            }
        }
        Ok(panels)
    }

    /// One panel between each two of `edges`, as they are.
    pub(crate) fn fixed(edges: impl Iterator<Item = f64>, f: impl Fn(f64) -> f64) -> Self {
        let mut panels = Self::default();
        for edge in edges {
            let before = panels.edges.last().copied().unwrap_or(edge);
            panels.push(edge, gauss(before, edge, &f), f(edge));
        }
        panels
    }

    fn push(&mut self, edge: f64, part: f64, value: f64) {
        self.sums.push(self.total() + part);
        self.edges.push(edge);
        self.values.push(value);
    }

    /// The integral over the whole range.
    pub(crate) fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// The integral from the first edge to `u`.
    pub(crate) fn value(&self, u: f64, integral: impl Fn(f64, f64) -> f64) -> f64 {
        let i = self
            .edges
            .partition_point(|&edge| edge <= u)
            .clamp(1, self.edges.len() - 1)
            - 1;
        self.sums[i] + integral(self.edges[i], u)
    }

    /// Where the integral is `s`, by Newton's method within the panel that holds it; the nearer
    /// end for an `s` outside.
    pub(crate) fn invert(
        &self,
        s: f64,
        integral: impl Fn(f64, f64) -> f64,
        f: impl Fn(f64) -> f64,
    ) -> f64 {
        let last = self.edges.len() - 1;
        // False for a NaN too.
        let holds = s > 0.0;
        if !holds {
            return self.edges[0];
        }
        if s >= self.sums[last] {
            return self.edges[last];
        }
        let i = self.sums.partition_point(|&sum| sum <= s).clamp(1, last) - 1;
        let (mut low, mut high) = (self.edges[i], self.edges[i + 1]);
        let wanted = s - self.sums[i];
        let width = high - low;
        let mut u = low + self.inverse_cubic(i, wanted) * width;
        for _ in 0..60 {
            let excess = integral(self.edges[i], u) - wanted;
            if excess > 0.0 {
                high = u;
            } else {
                low = u;
            }
            let next = u - excess / f(u);
            // Outside of the bracket Newton has failed: the middle is nearer.
            let next = if next >= low && next <= high {
                next
            } else {
                0.5 * (low + high)
            };
            let step = (next - u).abs();
            u = next;
            // The error after a step is about (step/width)² of the width.
            if step <= 1e-9 * width {
                break;
            }
        }
        u
    }

    /// Share of panel `i` at which the integral from its begin is `wanted`: a cubic with the
    /// slopes 1/f at both ends.
    fn inverse_cubic(&self, i: usize, wanted: f64) -> f64 {
        let part = self.sums[i + 1] - self.sums[i];
        let per_width = part / (self.edges[i + 1] - self.edges[i]);
        let (m0, m1) = (per_width / self.values[i], per_width / self.values[i + 1]);
        let x = wanted / part;
        let y = 1.0 - x;
        (x * x * (3.0 - 2.0 * x) + x * y * (m0 * y - m1 * x)).clamp(0.0, 1.0)
    }
}
