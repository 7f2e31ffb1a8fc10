//! L D Lᵀ of K − μ M in its band, for solving and for counting.

use crate::banded::SymmetricBanded;
use crate::pencil::Block;

/// A factorisation without pivoting; its memory serves again and again.
///
/// For μ below the spectrum the matrix is positive definite, and no pivoting
/// is needed. Above, the signs of D count the eigenvalues below μ (Sylvester's
/// law of inertia), and only they are used.
///
/// What is counted is a matrix that differs from A = K − μM by E with
/// |E| ≤ γ |L| |D| |Lᵀ|, γ ≈ (p + 2) 2⁻⁵³ for the half bandwidth p (Higham,
/// *Accuracy and Stability of Numerical Algorithms*, 2002, Theorem 9.3). With
/// p = 1 that E never matters, however small a pivot is: the count is that of a
/// matrix whose entries are changed by a few units in their last places (Kahan
/// 1966; Demmel, *Applied Numerical Linear Algebra*, 1997, Lemma 5.4). With
/// p > 1 a small pivot, where μ meets an eigenvalue of a leading part of the
/// matrix, makes E as large as it likes. So a count stands only if every
/// g_i = Σ_k l_ik² |d_k| stays within [`GROWTH`] times |K_ii| + |μ| M_ii: then
/// |E_ij| ≤ γ √(g_i g_j), the rounding of the entries themselves times that.
pub(crate) struct Ldlt {
    order: usize,
    half_bandwidth: usize,
    /// Columns of L below its unit diagonal; the diagonal's place holds D.
    data: Vec<f64>,
    /// g_i, while they are summed.
    growth: Vec<f64>,
}

/// Most that the terms of a row of L D Lᵀ may outgrow the row's own entries.
/// Of the counts that beams of 1 to 1000 elements ask for, one in twenty does not
/// stand.
const GROWTH: f64 = 1024.0;

impl Ldlt {
    pub fn new(mass: &SymmetricBanded, stiffness: &SymmetricBanded) -> Self {
        let half_bandwidth = mass.half_bandwidth().max(stiffness.half_bandwidth());
        let order = mass.order();
        Self {
            order,
            half_bandwidth,
            data: vec![0.0; order * (half_bandwidth + 1)],
            growth: vec![0.0; if half_bandwidth > 1 { order } else { 0 }],
        }
    }

    /// Factorises K − μ M; returns the number of negative pivots, which is
    /// that of eigenvalues below μ. None if small pivots have made it
    /// unreliable: another μ beside this one will do.
    pub fn factorise(
        &mut self,
        mass: &SymmetricBanded,
        stiffness: &SymmetricBanded,
        mu: f64,
    ) -> Option<usize> {
        self.factorise_within(GROWTH, mass, stiffness, mu)
    }

    /// The same with another bound on the growth than [`GROWTH`].
    pub fn factorise_within(
        &mut self,
        growth: f64,
        mass: &SymmetricBanded,
        stiffness: &SymmetricBanded,
        mu: f64,
    ) -> Option<usize> {
        self.load(mass, stiffness, mu);
        let negative = match self.half_bandwidth {
            0 => self.data.iter().filter(|d| **d < 0.0).count(),
            1 => self.eliminate::<2>(),
            3 => self.eliminate::<4>(),
            _ => self.eliminate_any(),
        };
        let own = |i: usize| growth * (stiffness.column(i)[0].abs() + mu.abs() * mass.column(i)[0]);
        let reliable = match self.half_bandwidth {
            0 | 1 => true,
            3 => self.grew_little::<4>(own),
            _ => self.any_grew_little(own),
        };
        reliable.then_some(negative)
    }

    /// Whether every g_i is within `most(i)`; not, if it is no number.
    fn grew_little<const WIDTH: usize>(&mut self, most: impl Fn(usize) -> f64) -> bool {
        self.growth.fill(0.0);
        let (columns, _) = self.data.as_chunks::<WIDTH>();
        let columns = columns.iter().enumerate();
        columns.fold(true, |all, (j, l)| {
            all & add_growth(l, &mut self.growth[j..], most(j))
        })
    }

    /// The same for any band.
    fn any_grew_little(&mut self, most: impl Fn(usize) -> f64) -> bool {
        self.growth.fill(0.0);
        let columns = self.data.chunks_exact(self.half_bandwidth + 1).enumerate();
        columns.fold(true, |all, (j, l)| {
            all & add_growth(l, &mut self.growth[j..], most(j))
        })
    }

    /// Writes K − μ M into the band.
    fn load(&mut self, mass: &SymmetricBanded, stiffness: &SymmetricBanded, mu: f64) {
        let widths = [mass.half_bandwidth(), stiffness.half_bandwidth()];
        if widths == [self.half_bandwidth; 2] {
            let entries = stiffness.data().iter().zip(mass.data());
            for (target, (k, m)) in self.data.iter_mut().zip(entries) {
                *target = k - mu * m;
            }
            return;
        }
        self.data.fill(0.0);
        let width = self.half_bandwidth + 1;
        for (matrix, factor) in [(stiffness, 1.0), (mass, -mu)] {
            let columns = self.data.chunks_exact_mut(width);
            let sources = matrix.data().chunks_exact(matrix.half_bandwidth() + 1);
            for (column, source) in columns.zip(sources) {
                for (c, s) in column.iter_mut().zip(source) {
                    *c += factor * s;
                }
            }
        }
    }

    /// For the bands of rods (2) and of bending (4), with the loops unrolled.
    fn eliminate<const WIDTH: usize>(&mut self) -> usize {
        let mut negative = 0;
        let (columns, _) = self.data.as_chunks_mut::<WIDTH>();
        for j in 0..self.order {
            let (done, rest) = columns.split_at_mut(j + 1);
            let column = &mut done[j];
            negative += pivot(&mut column[0]);
            let inverse = 1.0 / column[0];
            for p in 1..WIDTH.min(rest.len() + 1) {
                let l = column[p] * inverse;
                for q in p..WIDTH {
                    rest[p - 1][q - p] -= l * column[q];
                }
            }
            for entry in &mut column[1..] {
                *entry *= inverse;
            }
        }
        negative
    }

    /// The same for any band. Entries that are exactly zero stay out of the
    /// work: a band of twelve rows is mostly empty.
    fn eliminate_any(&mut self) -> usize {
        let width = self.half_bandwidth + 1;
        let mut negative = 0;
        for j in 0..self.order {
            let (done, rest) = self.data.split_at_mut((j + 1) * width);
            let column = &mut done[j * width..];
            negative += pivot(&mut column[0]);
            let inverse = 1.0 / column[0];
            for (p, target) in (1..width).zip(rest.chunks_exact_mut(width)) {
                let l = column[p] * inverse;
                if l != 0.0 {
                    for (t, c) in target.iter_mut().zip(&column[p..]) {
                        *t -= l * c;
                    }
                }
            }
            for entry in &mut column[1..] {
                *entry *= inverse;
            }
        }
        negative
    }

    /// Replaces `x` by (K − μ M)⁻¹ x, for all columns of the block at once.
    pub fn solve(&self, x: &mut Block) {
        match self.half_bandwidth {
            1 => self.substitute::<2>(x),
            3 => self.substitute::<4>(x),
            _ => self.substitute_any(x),
        }
    }

    fn substitute<const WIDTH: usize>(&self, x: &mut Block) {
        let (columns, _) = self.data.as_chunks::<WIDTH>();
        for (j, l) in columns.iter().enumerate() {
            forward(l, j, x);
        }
        for (j, l) in columns.iter().enumerate().rev() {
            backward(l, j, x);
        }
    }

    fn substitute_any(&self, x: &mut Block) {
        let width = self.half_bandwidth + 1;
        for (j, l) in self.data.chunks_exact(width).enumerate() {
            forward(l, j, x);
        }
        for (j, l) in self.data.chunks_exact(width).enumerate().rev() {
            backward(l, j, x);
        }
    }
}

/// A pivot that cancelled to nothing is given a tiny positive size (as in
/// LAPACK's tridiagonal bisection): the count is then that of a pencil
/// changed by rounding. Returns 1 for a negative one.
#[inline(always)]
fn pivot(d: &mut f64) -> usize {
    if d.abs() < f64::MIN_POSITIVE * 1e16 {
        *d = f64::MIN_POSITIVE * 1e16;
    }
    usize::from(*d < 0.0)
}

/// Adds a column's part to the g_i from its own row on, and tells whether that
/// row's, now whole, is within `most`.
#[inline(always)]
fn add_growth(l: &[f64], growth: &mut [f64], most: f64) -> bool {
    let size = l[0].abs();
    growth[0] += size;
    for (factor, g) in l[1..].iter().zip(&mut growth[1..]) {
        *g += factor * factor * size;
    }
    growth[0] <= most
}

#[inline(always)]
fn forward(l: &[f64], j: usize, x: &mut Block) {
    let (done, rest) = x.split_at_mut(j + 1);
    let own = done[j];
    for (factor, row) in l[1..].iter().zip(rest) {
        row[0] -= factor * own[0];
        row[1] -= factor * own[1];
    }
}

#[inline(always)]
fn backward(l: &[f64], j: usize, x: &mut Block) {
    let (head, rest) = x.split_at_mut(j + 1);
    let inverse = 1.0 / l[0];
    let mut own = [head[j][0] * inverse, head[j][1] * inverse];
    for (factor, row) in l[1..].iter().zip(rest.iter()) {
        own[0] -= factor * row[0];
        own[1] -= factor * row[1];
    }
    head[j] = own;
}

#[cfg(test)]
mod tests;
