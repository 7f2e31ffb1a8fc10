//! Passes over all samples: loss, normal equations, output layer.

use std::vec;
use std::vec::Vec;

use rayon::prelude::*;

use super::block::{BlockWork, Layout};
use super::cholesky::Symmetric;
use super::dataset::{BLOCK, SampleBlock};
use super::gram::Gram;
use super::output_fit::{Triangles, block_triangle};
use crate::{Architecture, Error};

/// Most bytes that a training may take beside its samples. The largest tables
/// are the triangle and the distinct entries of `JᵀJ`, about `4 n²` bytes each
/// for `n` parameters: some 16 000 parameters are trained within the limit,
/// and a trial step of that size takes minutes.
pub const MAX_TRAINING_BYTES: u64 = 4 << 30;

/// Blocks worked on at a time: bounds the memory whatever the sample count.
const GROUP: usize = 32;

/// Working memory of the passes. Sums run over the blocks in their order, so
/// no result depends on the number of threads.
#[derive(Debug, Clone)]
pub(super) struct Engine {
    pub layout: Layout,
    works: Vec<BlockWork>,
    gram: Gram,
    /// `Jᵀ r`.
    pub gradient: Vec<f64>,
    matrix: Symmetric,
}

/// What a step of [`Engine::step`] adds to the normal equations.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step<'a> {
    /// On `JᵀJ` and `Jᵀr`.
    pub factor: f64,
    pub damping: f64,
    /// Factor `α` of the squares of the weights, with the weights.
    pub decay: Option<(f64, &'a [f64])>,
}

impl Engine {
    /// Refuses a shape, itself valid, whose tables would pass
    /// [`MAX_TRAINING_BYTES`].
    pub fn check_memory(architecture: &Architecture, blocks: usize) -> Result<(), Error> {
        let bytes = bytes(&Layout::new(architecture), blocks);
        if bytes <= MAX_TRAINING_BYTES {
            return Ok(());
        }
        Err(Error::TrainingMemory {
            bytes,
            limit: MAX_TRAINING_BYTES,
        })
    }

    /// For a shape that [`Engine::check_memory`] accepts.
    pub fn new(architecture: &Architecture, blocks: usize) -> Self {
        let layout = Layout::new(architecture);
        Self {
            works: vec![BlockWork::new(&layout); blocks.clamp(1, GROUP)],
            gram: Gram::new(&layout),
            gradient: vec![0.0; layout.parameters],
            matrix: Symmetric::new(layout.trained()),
            layout,
        }
    }

    /// Sum of squared residuals.
    pub fn sum_of_squares(&mut self, blocks: &[SampleBlock], weights: &[f64]) -> f64 {
        let layout = &self.layout;
        let mut total = 0.0;
        for group in blocks.chunks(self.works.len()) {
            let sums: Vec<f64> = (self.works.par_iter_mut().zip(group))
                .map(|(work, samples)| {
                    work.forward_hidden(layout, weights, samples);
                    work.residuals(layout, weights, samples)
                })
                .collect();
            total = sums.iter().fold(total, |sum, s| sum + s);
        }
        total
    }

    /// `JᵀJ` (kept inside) and `Jᵀ r`.
    pub fn normal_equations(&mut self, blocks: &[SampleBlock], weights: &[f64]) {
        let layout = &self.layout;
        self.gram.clear();
        self.gradient.fill(0.0);
        for group in blocks.chunks(self.works.len()) {
            (self.works.par_iter_mut().zip(group)).for_each(|(work, samples)| {
                work.forward_hidden(layout, weights, samples);
                work.residuals(layout, weights, samples);
                work.backward(layout, weights, samples);
            });
            let works = &self.works[..group.len()];
            self.gram.add(layout, works);
            for work in works {
                for (sum, g) in self.gradient.iter_mut().zip(&work.gradient) {
                    *sum += g;
                }
            }
        }
    }

    /// Solves `(factor JᵀJ + (damping + α) I) step = -(factor Jᵀr + α w)`, of
    /// the parameters that are trained; none if the matrix is not positive
    /// definite to working precision.
    pub fn step(&mut self, step: Step<'_>) -> Option<Vec<f64>> {
        let Step {
            factor,
            damping,
            decay,
        } = step;
        let damping = decay.map_or(damping, |(alpha, _)| damping + alpha);
        self.write(factor, damping);
        let mut whole: Vec<f64> = self.gradient.iter().map(|g| -factor * g).collect();
        if let Some((alpha, weights)) = decay {
            for (s, w) in whole.iter_mut().zip(weights) {
                *s -= alpha * w;
            }
        }
        let Some(free) = &self.layout.free else {
            return self.matrix.solve(&mut whole).then_some(whole);
        };
        let mut own: Vec<f64> = free.iter().map(|&c| whole[c]).collect();
        if !self.matrix.solve(&mut own) {
            return None;
        }
        whole.fill(0.0);
        for (&c, s) in free.iter().zip(own) {
            whole[c] = s;
        }
        Some(whole)
    }

    /// Trace of `(factor JᵀJ + α I)⁻¹`; none if the matrix is not positive
    /// definite to working precision.
    pub fn trace_of_inverse(&mut self, factor: f64, alpha: f64) -> Option<f64> {
        self.write(factor, alpha);
        self.matrix.trace_of_inverse()
    }

    /// The lower triangle of `factor JᵀJ + diagonal I`.
    fn write(&mut self, factor: f64, diagonal: f64) {
        let Self {
            layout,
            gram,
            matrix,
            ..
        } = self;
        gram.write_lower(layout, factor, diagonal, matrix);
    }

    /// Euclidean norm of `factor Jᵀr + α w` over the parameters that are trained.
    pub fn gradient_norm(&self, factor: f64, decay: Option<(f64, &[f64])>) -> f64 {
        let entry = |c: usize| match decay {
            Some((alpha, weights)) => self.gradient[c] + alpha / factor * weights[c],
            None => self.gradient[c],
        };
        let square = |c: usize| {
            let g = entry(c);
            g * g
        };
        let sum: f64 = match &self.layout.free {
            None => (0..self.layout.parameters).map(square).sum(),
            Some(free) => free.iter().map(|&c| square(c)).sum(),
        };
        factor * libm::sqrt(sum)
    }

    /// Sets the output layer's weights from its links to the first `unknowns`
    /// activations by least squares, its other weights to zero.
    pub fn fit_output(
        &mut self,
        blocks: &[SampleBlock],
        weights: &mut [f64],
        unknowns: usize,
        ridge: f64,
    ) {
        let layout = &self.layout;
        let links = &layout.output_links;
        let links = &links[..links.partition_point(|&link| link < unknowns)];
        let mut triangles = Triangles::new(links.len() + layout.outputs);
        for group in blocks.chunks(self.works.len()) {
            let parts: Vec<Vec<f64>> = (self.works.par_iter_mut().zip(group))
                .map(|(work, samples)| {
                    work.forward_hidden(layout, weights, samples);
                    block_triangle(&work.activations, links, samples)
                })
                .collect();
            parts.iter().for_each(|part| triangles.push(part));
            triangles.reduce();
        }
        let fitted = triangles.solve(links.len(), ridge);
        let own = &mut weights[layout.output.first_parameter..];
        own.fill(0.0);
        for (&link, fitted) in links.iter().zip(fitted.chunks_exact(layout.outputs)) {
            own[link * layout.outputs..][..layout.outputs].copy_from_slice(fitted);
        }
    }

    /// `JᵀJ` as a full symmetric matrix, column-major (for checks).
    #[cfg(test)]
    pub fn dense(&mut self) -> Vec<f64> {
        let n = self.layout.parameters;
        self.gram
            .write_lower(&self.layout, 1.0, 0.0, &mut self.matrix);
        (0..n * n)
            .map(|e| (e % n, e / n))
            .map(|(r, c)| self.matrix.at(r, c))
            .collect()
    }
}

/// Bytes of the tables for a shape, from above. A valid shape has at most 2^19
/// parameters, so no product of two sizes overflows; sums of three saturate.
fn bytes(layout: &Layout, blocks: usize) -> u64 {
    let size = |n: usize| n as u64;
    let [n, a] = [layout.parameters, layout.activations].map(size);
    let [neurons, outputs] = [layout.neurons, layout.outputs].map(size);
    // Triangle, distinct entries, and the places of the latter.
    let square = n * (n + 256) / 2 * 8 + n * (n + 1) / 2 * 8 + n * n * 8;
    let pairs = (a * (a + 1) + neurons * outputs) * 16;
    let deltas = 2 * neurons * outputs;
    let row = a + deltas + neurons + outputs;
    let triangle = size(BLOCK) * (a + outputs);
    let block = (size(BLOCK).saturating_mul(row) + n + triangle).saturating_mul(8);
    let blocks = block.saturating_mul(size(blocks.clamp(1, GROUP)));
    square.saturating_add(pairs).saturating_add(blocks)
}
