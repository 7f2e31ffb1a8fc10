//! The frequency response of a linear system at many frequencies: its matrix is brought to
//! Hessenberg form once, so that each takes n² operations.

use nalgebra::{Complex, DMatrix, Hessenberg};
use std::vec::Vec;

type Number = Complex<f64>;

/// Frequency response of x(k+1) = A x + B v, w = C x + D v.
#[derive(Clone, Debug)]
pub struct SampledResponse {
    /// Qᵀ A Q, nought below its first subdiagonal, Qᵀ B and C Q.
    h: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

impl SampledResponse {
    /// Of the system with these matrices.
    pub fn new(a: DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>, d: DMatrix<f64>) -> Self {
        if a.nrows() < 2 {
            return Self {
                h: a,
                b: b.clone(),
                c: c.clone(),
                d,
            };
        }
        let (q, h) = Hessenberg::new(a).unpack();
        Self {
            h,
            b: q.transpose() * b,
            c: c * q,
            d,
        }
    }

    /// D + C (z − A)⁻¹ B; none at an eigenvalue.
    pub fn at(&self, z: Number) -> Option<DMatrix<Number>> {
        let n = self.h.nrows();
        let complex = |v: f64| Complex::new(v, 0.0);
        let mut m: Vec<Vec<Number>> = (0..n)
            .map(|i| {
                let row = |j: usize| match i == j {
                    true => z - self.h[(i, j)],
                    false => complex(-self.h[(i, j)]),
                };
                (0..n).map(row).collect()
            })
            .collect();
        let mut x: Vec<Vec<Number>> = self
            .b
            .row_iter()
            .map(|row| row.iter().copied().map(complex).collect())
            .collect();
        // One number below each pivot; the larger of the two is taken for it.
        for i in 0..n.saturating_sub(1) {
            if m[i + 1][i].norm_sqr() > m[i][i].norm_sqr() {
                m.swap(i, i + 1);
                x.swap(i, i + 1);
            }
            if m[i][i].norm_sqr() == 0.0 {
                return None;
            }
            let factor = m[i + 1][i] / m[i][i];
            let (upper, lower) = m.split_at_mut(i + 1);
            for (low, up) in lower[0][i..].iter_mut().zip(&upper[i][i..]) {
                *low -= factor * up;
            }
            let (upper, lower) = x.split_at_mut(i + 1);
            for (low, up) in lower[0].iter_mut().zip(&upper[i]) {
                *low -= factor * up;
            }
        }
        for i in (0..n).rev() {
            if m[i][i].norm_sqr() == 0.0 {
                return None;
            }
            let (known, below) = x.split_at_mut(i + 1);
            for (column, value) in known[i].iter_mut().enumerate() {
                for (j, row) in below.iter().enumerate() {
                    *value -= m[i][i + 1 + j] * row[column];
                }
                *value /= m[i][i];
            }
        }
        Some(DMatrix::from_fn(self.c.nrows(), self.b.ncols(), |i, j| {
            let terms = (0..n).map(|k| x[k][j] * self.c[(i, k)]);
            terms.fold(complex(self.d[(i, j)]), |sum, term| sum + term)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against (z − A) x = B by nalgebra's own decomposition.
    #[test]
    fn as_by_a_dense_solve() {
        let mut seed = 1u64;
        let mut next = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for n in [1, 2, 7, 20] {
            let a = DMatrix::from_fn(n, n, |_, _| next());
            let b = DMatrix::from_fn(n, 2, |_, _| next());
            let c = DMatrix::from_fn(3, n, |_, _| next());
            let d = DMatrix::from_fn(3, 2, |_, _| next());
            let z = Complex::new(0.6, 0.8);
            let complex = |m: &DMatrix<f64>| m.map(|v| Complex::new(v, 0.0));
            let left = DMatrix::identity(n, n) * z - complex(&a);
            let expected = complex(&d) + complex(&c) * left.lu().solve(&complex(&b)).unwrap();
            let found = SampledResponse::new(a, &b, &c, d).at(z).unwrap();
            let off = (found - expected).map(|v| v.norm_sqr()).sum().sqrt();
            assert!(off < 1e-11, "{n}: {off:e}");
        }
    }
}
