//! Vector fitting: poles that move to where the response has them.

use axis_fourier::Complex;
use nalgebra::{DMatrix, DVector};

use super::refine::Parameters;
use super::{Plane, Target};

/// Rounds in which the poles move.
const ROUNDS: usize = 12;
/// Damping of the poles at the start.
const DAMPING: f64 = 0.02;
/// Imaginary part, as a share of the size, below which a pole is real.
const REAL: f64 = 1e-9;

/// Poles in the scaled plane: real ones, and those of pairs with the positive imaginary part.
#[derive(Clone, Debug, Default)]
pub(crate) struct Poles {
    pub real: Vec<f64>,
    pub pairs: Vec<Complex<f64>>,
}

impl Poles {
    fn count(&self) -> usize {
        self.real.len() + 2 * self.pairs.len()
    }

    /// Spread evenly over the logarithm of the frequency, one real where the order is odd.
    fn spread(target: &Target, order: usize) -> Self {
        let last = target.places.len() - 1;
        let [low, high] = [0, last].map(|i| target.places[i].s.im);
        let pairs = order / 2;
        let at = |i: usize| {
            let part = (i as f64 + 0.5) / pairs as f64;
            let size = low * (high / low).powf(part);
            target.plane.of(Complex::new(-DAMPING * size, size))
        };
        Self {
            real: (0..order % 2)
                .map(|_| target.plane.of(Complex::new(-low, 0.0)).re)
                .collect(),
            pairs: (0..pairs).map(at).collect(),
        }
    }

    /// Partial fractions at x, with real coefficients: 1/(x − p), and for a pair the ones of the real
    /// and of the imaginary part of its residue.
    fn basis(&self, x: Complex<f64>) -> Vec<Complex<f64>> {
        let j = Complex::new(0.0, 1.0);
        let mut all: Vec<Complex<f64>> = self.real.iter().map(|p| (x - p).inv()).collect();
        for p in &self.pairs {
            let [a, b] = [(x - p).inv(), (x - p.conj()).inv()];
            all.extend([a + b, j * (a - b)]);
        }
        all
    }

    /// Zeros of 1 + Σ c_i φ_i: the eigenvalues of A − b cᵀ. Those that are not stable are mirrored.
    fn zeros(&self, plane: &Plane, c: &[f64]) -> Option<Self> {
        let n = self.count();
        let mut a = DMatrix::zeros(n, n);
        let mut b = DVector::zeros(n);
        for (i, p) in self.real.iter().enumerate() {
            a[(i, i)] = *p;
            b[i] = 1.0;
        }
        for (k, p) in self.pairs.iter().enumerate() {
            let i = self.real.len() + 2 * k;
            (a[(i, i)], a[(i + 1, i + 1)]) = (p.re, p.re);
            (a[(i, i + 1)], a[(i + 1, i)]) = (p.im, -p.im);
            b[i] = 2.0;
        }
        let c = DVector::from_column_slice(c);
        let moved = a - b * c.transpose();
        if moved.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let schur = nalgebra::linalg::Schur::try_new(moved, f64::EPSILON, 10_000)?;
        let mut found = Self::default();
        for z in schur.complex_eigenvalues().iter() {
            if z.im.abs() <= REAL * z.norm() {
                found.real.push(plane.stable(Complex::new(z.re, 0.0)).re);
            } else if z.im > 0.0 {
                found.pairs.push(plane.stable(*z));
            }
        }
        (found.count() == n).then_some(found)
    }
}

/// Poles of a response that is late by `delay` (scaled).
pub(crate) fn poles(target: &Target, order: usize, delay: f64) -> Option<Poles> {
    let mut poles = Poles::spread(target, order);
    for _ in 0..ROUNDS {
        let n = poles.count();
        let solution = solve(target, 2 * n, delay, |x, value| {
            let basis = poles.basis(x);
            let mut row = basis.clone();
            row.extend(basis.iter().map(|phi| -value * phi));
            row
        })?;
        poles = poles.zeros(&target.plane, &solution.as_slice()[n..])?;
    }
    Some(poles)
}

/// Residues of these poles: where the refinement starts.
pub(crate) fn start(target: &Target, poles: &Poles, delay: f64) -> Option<Parameters> {
    let solution = solve(target, poles.count(), delay, |x, _| poles.basis(x))?;
    let mut values = Vec::new();
    for (p, r) in poles.real.iter().zip(solution.iter()) {
        values.extend([-p, *r]);
    }
    for (k, p) in poles.pairs.iter().enumerate() {
        let at = poles.real.len() + 2 * k;
        values.extend([-p.re, p.im, solution[at], solution[at + 1]]);
    }
    values.push(delay);
    Some(Parameters {
        real: poles.real.len(),
        pairs: poles.pairs.len(),
        values,
    })
}

/// Weighted least squares of Σ x_i row_i(x) = value, real and imaginary parts, columns scaled to 1.
fn solve(
    target: &Target,
    columns: usize,
    delay: f64,
    row: impl Fn(Complex<f64>, Complex<f64>) -> Vec<Complex<f64>>,
) -> Option<DVector<f64>> {
    let lines = target.places.len();
    let mut a = DMatrix::zeros(2 * lines, columns);
    let mut b = DVector::zeros(2 * lines);
    for (k, at) in target.places.iter().enumerate() {
        let value = target.value[k] * (at.s * delay).exp();
        let weight = target.weight[k];
        for (j, x) in row(at.x, value).into_iter().enumerate() {
            a[(2 * k, j)] = weight * x.re;
            a[(2 * k + 1, j)] = weight * x.im;
        }
        b[2 * k] = weight * value.re;
        b[2 * k + 1] = weight * value.im;
    }
    let sizes: Vec<f64> = a.column_iter().map(|column| column.norm()).collect();
    for (mut column, size) in a.column_iter_mut().zip(&sizes) {
        column /= *size;
    }
    let qr = a.qr();
    let mut right = b;
    qr.q_tr_mul(&mut right);
    let top = right.rows(0, columns).into_owned();
    let mut x = qr.unpack_r().solve_upper_triangular(&top)?;
    for (x, size) in x.iter_mut().zip(&sizes) {
        *x /= *size;
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
}
