//! The product kernel of the centred discrepancy, laid out for vector units.
//!
//! With z = x − ½, a factor 1 + ½|zᵢ| + ½|zₖ| − ½|zᵢ − zₖ| is 1 plus the
//! smaller of |zᵢ| and |zₖ| when both lie on the same side of the centre, and
//! 1 otherwise: the number 1 ± zₖ, the sign that of zᵢ, held within
//! [1, 1 + |zᵢ|]. Both 1 + z and 1 − z are stored, so a factor costs one
//! minimum and one maximum.

use crate::Design;

/// Points handled together; columns are padded to a multiple of it.
pub(crate) const BLOCK: usize = 64;

/// Partial sums kept apart, so that additions need not wait for each other.
const LANES: usize = 8;

/// One value for each point of a block.
pub(crate) type Block = [f64; BLOCK];

/// The centred columns of a design.
#[derive(Clone)]
pub(crate) struct Kernel {
    n: usize,
    padded: usize,
    /// 1 + z, column after column.
    plus: Vec<f64>,
    /// 1 − z, column after column.
    minus: Vec<f64>,
}

impl Kernel {
    pub(crate) fn new(design: &Design) -> Self {
        let n = design.len();
        let padded = n.next_multiple_of(BLOCK);
        let mut plus = vec![1.0; padded * design.dims()];
        for (dim, column) in plus.chunks_exact_mut(padded).enumerate() {
            for (cell, x) in column.iter_mut().zip(design.column(dim)) {
                *cell = 1.0 + (x - 0.5);
            }
        }
        let minus = plus.iter().map(|w| 2.0 - w).collect();
        Self {
            n,
            padded,
            plus,
            minus,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.n
    }

    pub(crate) fn dims(&self) -> usize {
        self.plus.len() / self.padded
    }

    /// First points of the blocks that cover points 0 to `end` − 1.
    pub(crate) fn blocks(end: usize) -> impl Iterator<Item = usize> {
        (0..end).step_by(BLOCK)
    }

    /// |z| of point `i` in column `dim`.
    pub(crate) fn distance_from_centre(&self, i: usize, dim: usize) -> f64 {
        (self.plus[dim * self.padded + i] - 1.0).abs()
    }

    /// Factors of column `dim` between point `i` and the block from `start`.
    #[inline]
    pub(crate) fn factors(&self, i: usize, dim: usize, start: usize, out: &mut Block) {
        let column = dim * self.padded;
        let cap = self.plus[column + i].max(self.minus[column + i]);
        let same_side = if self.plus[column + i] >= 1.0 {
            &self.plus
        } else {
            &self.minus
        };
        let from = &same_side[column + start..column + start + BLOCK];
        for (factor, &w) in out.iter_mut().zip(from) {
            // Comparisons, not f64::min: no NaN here, and one instruction.
            let capped = if w < cap { w } else { cap };
            *factor = if capped > 1.0 { capped } else { 1.0 };
        }
    }

    /// Σ over k < i of the kernel between points i and k.
    pub(crate) fn row_sum(&self, i: usize) -> f64 {
        let mut sum = Sum::default();
        let mut factors = [0.0; BLOCK];
        for start in Self::blocks(i) {
            let mut product = [1.0; BLOCK];
            for dim in 0..self.dims() {
                self.factors(i, dim, start, &mut factors);
                for (p, f) in product.iter_mut().zip(&factors) {
                    *p *= f;
                }
            }
            // The last block may reach past i.
            product[BLOCK.min(i - start)..].fill(0.0);
            sum.add(&product);
        }
        sum.total()
    }

    /// The kernel of point `i` with itself, with column `dim` taken from `j`.
    pub(crate) fn own(&self, i: usize, j: usize, dim: usize) -> f64 {
        self.product(i, j, dim, |z| 1.0 + z)
    }

    /// The kernel of point `i` averaged over the cube, with column `dim`
    /// taken from `j`.
    pub(crate) fn mean(&self, i: usize, j: usize, dim: usize) -> f64 {
        self.product(i, j, dim, |z| 1.0 + 0.5 * (z - z * z))
    }

    fn product(&self, i: usize, j: usize, dim: usize, factor: impl Fn(f64) -> f64) -> f64 {
        let point = |d| if d == dim { j } else { i };
        (0..self.dims())
            .map(|d| factor(self.distance_from_centre(point(d), d)))
            .product()
    }

    /// Exchanges the coordinates `dim` of points `i` and `j`.
    pub(crate) fn swap(&mut self, i: usize, j: usize, dim: usize) {
        let column = dim * self.padded;
        self.plus.swap(column + i, column + j);
        self.minus.swap(column + i, column + j);
    }
}

/// A sum of blocks in a fixed order.
#[derive(Default, Clone, Copy)]
pub(crate) struct Sum([f64; LANES]);

impl Sum {
    #[inline]
    pub(crate) fn add(&mut self, block: &Block) {
        for chunk in block.chunks_exact(LANES) {
            for (lane, x) in self.0.iter_mut().zip(chunk) {
                *lane += x;
            }
        }
    }

    pub(crate) fn total(&self) -> f64 {
        self.0.iter().sum()
    }
}
