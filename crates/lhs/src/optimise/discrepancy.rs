//! What exchanges change in the centred discrepancy.

use super::Objective;
use crate::Design;
use crate::kernel::{BLOCK, Block, Kernel, Sum};
use crate::permutation::below;
use rand_chacha::ChaCha8Rng;

/// CD² of [`centred_discrepancy`](crate::criteria::centred_discrepancy),
/// updated.
pub(super) struct Discrepancy {
    kernel: Kernel,
    value: f64,
    sums: Vec<Sum>,
    first: Side,
    second: Side,
}

/// Work space for one of the two points: per column, its factors with a block
/// of others, and the product of the factors of the columns before.
struct Side {
    factors: Vec<Block>,
    before: Vec<Block>,
}

impl Side {
    fn new(dims: usize) -> Self {
        Self {
            factors: vec![[0.0; BLOCK]; dims],
            before: vec![[1.0; BLOCK]; dims],
        }
    }

    fn load(&mut self, kernel: &Kernel, i: usize, start: usize) {
        let mut product = [1.0; BLOCK];
        for (dim, factors) in self.factors.iter_mut().enumerate() {
            kernel.factors(i, dim, start, factors);
            self.before[dim] = product;
            multiply(&mut product, factors);
        }
    }
}

fn multiply(product: &mut Block, factors: &Block) {
    for (p, f) in product.iter_mut().zip(factors) {
        *p *= f;
    }
}

impl Discrepancy {
    pub(super) fn new(design: &Design, initial: f64) -> Self {
        let dims = design.dims();
        Self {
            kernel: Kernel::new(design),
            value: initial,
            sums: vec![Sum::default(); dims],
            first: Side::new(dims),
            second: Side::new(dims),
        }
    }

    /// Adds, for each column c, Σₖ (Lᵢₖ − Lⱼₖ)(κⱼₖ − κᵢₖ) over the block: κ
    /// the factors of column c, L the product of those of all other columns.
    fn add_block(&mut self, skip: [usize; 2], start: usize) {
        let (mut after_i, mut after_j) = ([1.0; BLOCK], [1.0; BLOCK]);
        for dim in (0..self.sums.len()).rev() {
            let (ki, kj) = (&self.first.factors[dim], &self.second.factors[dim]);
            let (bi, bj) = (&self.first.before[dim], &self.second.before[dim]);
            let mut terms = [0.0; BLOCK];
            for k in 0..BLOCK {
                terms[k] = (bi[k] * after_i[k] - bj[k] * after_j[k]) * (kj[k] - ki[k]);
            }
            // The kernel between i and j themselves does not change.
            for point in skip {
                if let Some(term) = terms.get_mut(point.wrapping_sub(start)) {
                    *term = 0.0;
                }
            }
            self.sums[dim].add(&terms);
            multiply(&mut after_i, ki);
            multiply(&mut after_j, kj);
        }
    }

    /// Change of the terms that involve a single point.
    fn own_change(&self, i: usize, j: usize, dim: usize) -> f64 {
        let n = self.kernel.len() as f64;
        let single = |a, b| self.kernel.own(a, b, dim) / n - 2.0 * self.kernel.mean(a, b, dim);
        (single(i, j) + single(j, i) - single(i, i) - single(j, j)) / n
    }
}

impl Objective for Discrepancy {
    fn changes(&mut self, i: usize, j: usize, out: &mut [f64]) {
        self.sums.fill(Sum::default());
        // Padding has κ = 1 for both points, which adds exactly zero.
        for start in Kernel::blocks(self.kernel.len()) {
            self.first.load(&self.kernel, i, start);
            self.second.load(&self.kernel, j, start);
            self.add_block([i, j], start);
        }
        let n = self.kernel.len() as f64;
        for (dim, change) in out.iter_mut().enumerate() {
            let pairs = 2.0 * self.sums[dim].total() / (n * n);
            *change = pairs + self.own_change(i, j, dim);
        }
    }

    fn exchange(&mut self, i: usize, j: usize, dim: usize, change: f64) {
        self.kernel.swap(i, j, dim);
        self.value += change;
    }

    fn sum(&self) -> f64 {
        self.value
    }

    fn criterion(&self, sum: f64) -> f64 {
        sum
    }

    fn pick(&self, rng: &mut ChaCha8Rng) -> usize {
        below(rng, self.kernel.len() as u64) as usize
    }
}
