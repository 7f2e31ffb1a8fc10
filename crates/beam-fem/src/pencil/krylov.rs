//! Block Lanczos with full orthogonalisation on (K + s M)⁻¹ M.

use nalgebra::{DMatrix, SymmetricEigen};

use crate::BeamError;
use crate::error::check_size;
use crate::pencil::block::{dot, inner, multiply, subtract};
use crate::pencil::components::Component;
use crate::pencil::ldlt::Ldlt;

/// Residual of a Ritz pair, relative to its own value θ, at which it counts
/// as found. Eigenvalues err by its square, shapes by itself.
const TOLERANCE: f64 = 1e-10;

/// The M-orthonormal basis V, M V, and the projected operator Vᵀ M A V.
struct Basis<'a> {
    mass: &'a crate::SymmetricBanded,
    factor: &'a Ldlt,
    blocks: Vec<Vec<[f64; 2]>>,
    mass_blocks: Vec<Vec<[f64; 2]>>,
    projected: DMatrix<f64>,
    seed: u64,
}

/// Ritz pairs: values θ descending, the vectors' coordinates in the basis.
struct Ritz {
    values: Vec<f64>,
    coordinates: DMatrix<f64>,
}

/// The `wanted` lowest modes of a component: shapes, n × wanted,
/// M-orthonormal, the lowest first. `factor` holds K + `s` M; all wanted
/// eigenvalues are known to lie below `limit`.
pub(crate) fn lowest(
    component: &Component,
    factor: &Ldlt,
    s: f64,
    limit: f64,
    wanted: usize,
) -> Result<DMatrix<f64>, BeamError> {
    let order = component.dofs.len();
    // A wanted eigenvalue below `limit` has θ above this. A vector of an
    // eigenspace that the start has missed shows itself as one too few.
    let least = (1.0 - 1e-9) / (limit + s);
    let largest = (8 * wanted + 60).min(order);
    check_size("the projected matrix", largest + 4, largest + 4)?;
    let mut basis = Basis::new(&component.mass, factor, largest + 4);
    basis.start();
    while basis.columns() <= largest {
        let remainder = basis.expand();
        if basis.columns() < wanted + 4 && basis.columns() < order {
            continue;
        }
        let known = basis.columns() - 2;
        let ritz = basis.ritz(known)?;
        if wanted <= known && ritz.converged(wanted, least, &remainder) {
            return Ok(basis.combine(&ritz, wanted));
        }
    }
    Err(BeamError::NotConverged)
}

impl Ritz {
    /// The residual of a pair is the remainder times the last two
    /// coordinates of its vector.
    fn converged(&self, wanted: usize, least: f64, remainder: &[[f64; 2]; 2]) -> bool {
        let last = self.coordinates.nrows() - 2;
        (0..wanted).all(|i| {
            let (a, b) = (self.coordinates[(last, i)], self.coordinates[(last + 1, i)]);
            let residual = (remainder[0][0] * a + remainder[0][1] * b)
                .hypot(remainder[1][0] * a + remainder[1][1] * b);
            self.values[i] >= least && residual <= TOLERANCE * self.values[i]
        })
    }
}

impl<'a> Basis<'a> {
    fn new(mass: &'a crate::SymmetricBanded, factor: &'a Ldlt, columns: usize) -> Self {
        Self {
            mass,
            factor,
            blocks: Vec::new(),
            mass_blocks: Vec::new(),
            projected: DMatrix::zeros(columns, columns),
            seed: 0x9E37_79B9_7F4A_7C15,
        }
    }

    fn columns(&self) -> usize {
        2 * self.blocks.len()
    }

    /// Two vectors of fixed pseudo-random numbers: the same on every run.
    fn start(&mut self) {
        let mut block = vec![[0.0; 2]; self.mass.order()];
        self.scramble(&mut block, 0);
        self.scramble(&mut block, 1);
        self.factor.solve(&mut block);
        self.append(block);
    }

    /// Adds A V_last, orthonormalised, to the basis. Returns the remainder:
    /// the triangular factor of what the basis did not span.
    fn expand(&mut self) -> [[f64; 2]; 2] {
        let last = self.blocks.len() - 1;
        let mut block = self.mass_blocks[last].clone();
        self.factor.solve(&mut block);
        // A is symmetric, so only the last two blocks hold a large part of
        // A V_last: they go first, and then rounding's part of all blocks.
        for first in [last.saturating_sub(1), 0] {
            for i in first..=last {
                let c = inner(&self.mass_blocks[i], &block);
                subtract(&mut block, &self.blocks[i], &c);
                for (row, values) in c.iter().enumerate() {
                    for (column, value) in values.iter().enumerate() {
                        self.projected[(2 * i + row, 2 * last + column)] += value;
                    }
                }
            }
        }
        self.append(block)
    }

    /// Orthonormalises the two columns of a block that is already orthogonal
    /// to the basis, and appends it.
    fn append(&mut self, mut block: Vec<[f64; 2]>) -> [[f64; 2]; 2] {
        let mut product = vec![[0.0; 2]; block.len()];
        let mut triangle = [[0.0; 2]; 2];
        let scale = self.projected.amax().max(f64::MIN_POSITIVE);
        multiply(self.mass, &block, &mut product);
        triangle[0][0] = dot(&block, 0, &product, 0).max(0.0).sqrt();
        if triangle[0][0] <= 1e-14 * scale && !self.blocks.is_empty() {
            // The basis already holds this direction: go on with a new one.
            triangle[0][0] = 0.0;
            self.renew(&mut block, 0);
            multiply(self.mass, &block, &mut product);
        }
        normalise(&mut block, &mut product, 0);
        for _ in 0..2 {
            triangle[0][1] += orthogonalise(&mut block, &mut product);
        }
        triangle[1][1] = dot(&block, 1, &product, 1).max(0.0).sqrt();
        if triangle[1][1] <= 1e-14 * scale && !self.blocks.is_empty() {
            triangle[1][1] = 0.0;
            self.renew(&mut block, 1);
            multiply(self.mass, &block, &mut product);
            for _ in 0..2 {
                orthogonalise(&mut block, &mut product);
            }
        }
        normalise(&mut block, &mut product, 1);
        self.blocks.push(block);
        self.mass_blocks.push(product);
        triangle
    }

    /// A fresh column, orthogonal to the basis.
    fn renew(&mut self, block: &mut [[f64; 2]], column: usize) {
        self.scramble(block, column);
        for _ in 0..2 {
            for (own, product) in self.blocks.iter().zip(&self.mass_blocks) {
                let c = [
                    dot(product, 0, block, column),
                    dot(product, 1, block, column),
                ];
                for (target, a) in block.iter_mut().zip(own) {
                    target[column] -= a[0] * c[0] + a[1] * c[1];
                }
            }
        }
    }

    /// Numbers in (−1, 1) from a linear congruential generator (Knuth's
    /// MMIX constants).
    fn scramble(&mut self, block: &mut [[f64; 2]], column: usize) {
        for row in block {
            self.seed = self
                .seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            row[column] = (self.seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        }
    }

    /// Eigenpairs of the projected operator on the first `known` columns.
    fn ritz(&self, known: usize) -> Result<Ritz, BeamError> {
        let upper = |i: usize, j: usize| self.projected[(i.min(j), i.max(j))];
        let matrix = DMatrix::from_fn(known, known, upper);
        if !matrix.iter().all(|v| v.is_finite()) {
            return Err(BeamError::NotConverged);
        }
        let eigen = SymmetricEigen::try_new(matrix, f64::EPSILON, 1000 * known)
            .ok_or(BeamError::NotConverged)?;
        let mut ranks: Vec<usize> = (0..known).collect();
        ranks.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
        Ok(Ritz {
            values: ranks.iter().map(|&i| eigen.eigenvalues[i]).collect(),
            coordinates: DMatrix::from_fn(known, known, |i, j| eigen.eigenvectors[(i, ranks[j])]),
        })
    }

    /// The first `wanted` Ritz vectors.
    fn combine(&self, ritz: &Ritz, wanted: usize) -> DMatrix<f64> {
        let mut shapes = DMatrix::zeros(self.mass.order(), wanted);
        for (column, mut shape) in shapes.column_iter_mut().enumerate() {
            for (i, block) in self.blocks.iter().enumerate().take(ritz.values.len() / 2) {
                let a = ritz.coordinates[(2 * i, column)];
                let b = ritz.coordinates[(2 * i + 1, column)];
                for (target, row) in shape.iter_mut().zip(block) {
                    *target += a * row[0] + b * row[1];
                }
            }
        }
        shapes
    }
}

/// Scales a column, and its product with M, to unit M-norm.
fn normalise(block: &mut [[f64; 2]], product: &mut [[f64; 2]], column: usize) {
    let norm = dot(block, column, product, column).max(f64::MIN_POSITIVE);
    let inverse = 1.0 / norm.sqrt();
    for row in block.iter_mut().chain(product) {
        row[column] *= inverse;
    }
}

/// Takes the first column's part out of the second; returns its size.
fn orthogonalise(block: &mut [[f64; 2]], product: &mut [[f64; 2]]) -> f64 {
    let c = dot(product, 0, block, 1);
    for row in block.iter_mut().chain(product) {
        row[1] -= c * row[0];
    }
    c
}
