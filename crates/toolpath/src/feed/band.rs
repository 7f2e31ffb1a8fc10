//! Symmetric matrices of five diagonals.

/// Diagonal, first and second subdiagonal: entry (i, i), (i, i − 1), (i, i − 2) of each row.
#[derive(Clone, Debug)]
pub(super) struct Pentadiagonal {
    pub(super) rows: Vec<[f64; 3]>,
}

impl Pentadiagonal {
    pub(super) fn zeros(n: usize) -> Self {
        Self {
            rows: vec![[0.0; 3]; n],
        }
    }

    pub(super) fn clear(&mut self) {
        self.rows.fill([0.0; 3]);
    }

    /// Adds `k r rᵀ`, with `r` in the places `at` to `at` + 2.
    pub(super) fn add(&mut self, at: usize, k: f64, r: &[f64; 3]) {
        self.rows[at][0] += k * r[0] * r[0];
        self.rows[at + 1][0] += k * r[1] * r[1];
        self.rows[at + 1][1] += k * r[1] * r[0];
        self.rows[at + 2][0] += k * r[2] * r[2];
        self.rows[at + 2][1] += k * r[2] * r[1];
        self.rows[at + 2][2] += k * r[2] * r[0];
    }

    /// Replaces `x` by the solution of `A x = x`, by L D Lᵀ; a pivot that rounding made too
    /// small is raised.
    pub(super) fn solve(&mut self, x: &mut [f64]) {
        let n = self.rows.len();
        for i in 0..n {
            // l2 = a2/d[i-2]; l1 = (a1 − l2 d[i-2] l1[i-1])/d[i-1].
            let original = self.rows[i][0];
            let (mut l1, mut l2, mut d) = (0.0, 0.0, original);
            if i > 1 {
                l2 = self.rows[i][2] / self.rows[i - 2][0];
                d -= l2 * self.rows[i][2];
            }
            if i > 0 {
                let coupled = if i > 1 {
                    self.rows[i][2] * self.rows[i - 1][1]
                } else {
                    0.0
                };
                let a1 = self.rows[i][1] - coupled;
                l1 = a1 / self.rows[i - 1][0];
                d -= l1 * a1;
            }
            self.rows[i] = [d.max(1e-14 * original).max(f64::MIN_POSITIVE), l1, l2];
            let below = if i > 0 { l1 * x[i - 1] } else { 0.0 };
            let further = if i > 1 { l2 * x[i - 2] } else { 0.0 };
            x[i] -= below + further;
        }
        for i in (0..n).rev() {
            x[i] /= self.rows[i][0];
        }
        for i in (0..n).rev() {
            if i + 1 < n {
                x[i] -= self.rows[i + 1][1] * x[i + 1];
            }
            if i + 2 < n {
                x[i] -= self.rows[i + 2][2] * x[i + 2];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Pentadiagonal;

    #[test]
    fn solves_what_it_multiplies() {
        let n = 12;
        let mut a = Pentadiagonal::zeros(n);
        for at in 0..n - 2 {
            let r = [1.0 + at as f64, -0.3 * at as f64, 0.7];
            a.add(at, 0.5 + at as f64 / 7.0, &r);
        }
        for row in &mut a.rows {
            row[0] += 0.1;
        }
        let wanted: Vec<f64> = (0..n).map(|i| (i as f64 * 1.3).sin()).collect();
        let entry = |i: usize, j: usize| {
            let (i, j) = (i.max(j), i.min(j));
            if i - j < 3 { a.rows[i][i - j] } else { 0.0 }
        };
        let mut x: Vec<f64> = (0..n)
            .map(|i| (0..n).map(|j| entry(i, j) * wanted[j]).sum())
            .collect();
        a.clone().solve(&mut x);
        for (x, w) in x.iter().zip(&wanted) {
            assert!((x - w).abs() < 1e-10, "{x} {w}");
        }
    }
}
