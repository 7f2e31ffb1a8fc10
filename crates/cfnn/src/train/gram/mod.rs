//! `JᵀJ` from products, without the Jacobian.
//!
//! The derivative of output `k` by the weight from activation `i` to neuron
//! `p` is `δ_kp a_i`, so
//!
//! ```text
//! (JᵀJ)[(p,i),(q,j)] = Σ_samples (Σ_k δ_kp δ_kq) (a_i a_j)
//! ```
//!
//! depends on the unordered pairs `{p,q}` and `{i,j}` alone. With one table of
//! the products of deltas and one of the products of activations, all distinct
//! entries come from a few plain matrix products ([`plan`]), and no entry is
//! computed twice. Neither table is ever whole: a tile of entries forms the
//! part that it needs, a block of samples at a time, while it is in the cache.

mod plan;
mod tile;

use std::vec;
use std::vec::Vec;

use rayon::prelude::*;

use self::plan::{Plan, Rectangle, triangle_index};
use self::tile::{Panels, Samples, Tile, cut};
use super::block::{BlockWork, Layout};
use super::cholesky::Symmetric;
use crate::simd::Vectors;

/// Accumulates `JᵀJ` over blocks of samples.
#[derive(Debug, Clone)]
pub(super) struct Gram {
    plan: Plan,
    rectangles: Vec<Rectangle>,
    /// The entries of one rectangle after the other, column-major.
    values: Vec<f64>,
    /// For each pair of layers `l <= m`, in order, and for (i, j), i seen by
    /// the first layer and j by the second: the place of the entry of the
    /// first pair of neurons; the others follow it.
    places: Vec<Vec<usize>>,
}

impl Gram {
    pub fn new(layout: &Layout) -> Self {
        let plan = Plan::new(layout);
        let rectangles = plan.rectangles();
        let size = rectangles.iter().map(Rectangle::len).sum();
        let places = plan
            .layer_pairs()
            .map(|(l, m)| places(layout, &plan, &rectangles, l, m))
            .collect();
        Self {
            values: vec![0.0; size],
            plan,
            rectangles,
            places,
        }
    }

    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds the samples of some blocks. Parallel over entries, never over
    /// samples: the order of each sum does not depend on the threads.
    pub fn add(&mut self, layout: &Layout, blocks: &[BlockWork]) {
        let vectors = Vectors::detect();
        let samples = Samples { layout, blocks };
        let plan = &self.plan;
        let mut tiles = Vec::new();
        let mut rest = self.values.as_mut_slice();
        for rectangle in &self.rectangles {
            let (values, later) = rest.split_at_mut(rectangle.len());
            rest = later;
            cut(rectangle, values, &mut tiles);
        }
        // The longest first, so that the threads end together.
        tiles.sort_by_key(|tile: &Tile| std::cmp::Reverse(tile.cost()));
        tiles
            .into_par_iter()
            .with_max_len(1)
            .for_each_init(Panels::new, |panels, tile| {
                tile.add(plan, samples, panels, vectors);
            });
    }

    /// Writes the lower triangle of `factor JᵀJ + damping I`, for the parameters that are trained.
    pub fn write_lower(&self, layout: &Layout, factor: f64, damping: f64, into: &mut Symmetric) {
        into.fill(|c, column| {
            match &layout.free {
                None => self.write_column(layout, factor, c, column),
                Some(free) => {
                    // Beside the square of the parameters an allocation is nothing.
                    let mut whole = vec![0.0; layout.parameters];
                    self.write_column(layout, factor, free[c], &mut whole);
                    for (to, &row) in column.iter_mut().zip(free).skip(c) {
                        *to = whole[row];
                    }
                }
            }
            column[c] += damping;
        });
    }

    fn write_column(&self, layout: &Layout, factor: f64, c: usize, out: &mut [f64]) {
        let l = layout
            .layers
            .partition_point(|layer| layer.first_parameter + layer.parameters() <= c);
        let layer = &layout.layers[l];
        let (i, p) = (
            (c - layer.first_parameter) / layer.neurons,
            (c - layer.first_parameter) % layer.neurons,
        );
        let count = layout.layers.len();
        // Index of the pair (l, l) in the list of pairs l <= m.
        let diagonal = (0..l).map(|k| count - k).sum::<usize>();
        let own = &self.places[diagonal];
        for j in i..layer.seen {
            let row = layer.first_parameter + j * layer.neurons;
            let start = own[i * layer.seen + j];
            let first = if j == i { p } else { 0 };
            for q in first..layer.neurons {
                let pair = triangle_index(p.min(q), p.max(q), layer.neurons);
                out[row + q] = factor * self.values[start + pair];
            }
        }
        for (other, places) in layout.layers[l + 1..]
            .iter()
            .zip(&self.places[diagonal + 1..])
        {
            let starts = &places[i * other.seen..][..other.seen];
            let rows = out[other.first_parameter..].chunks_exact_mut(other.neurons);
            for (&start, rows) in starts.iter().zip(rows) {
                let values = &self.values[start + p * other.neurons..];
                for (to, from) in rows.iter_mut().zip(values) {
                    *to = factor * from;
                }
            }
        }
    }
}

/// Places of the entries of one pair of layers: see [`Gram`].
fn places(
    layout: &Layout,
    plan: &Plan,
    rectangles: &[Rectangle],
    l: usize,
    m: usize,
) -> Vec<usize> {
    let (seen_l, seen_m) = (layout.layers[l].seen, layout.layers[m].seen);
    let row = plan.first_row(l, m);
    let across = across(rectangles, row);
    let place = |i: usize, j: usize| {
        let column = plan.column(i.min(j), i.max(j));
        // Together the rectangles cover the row: the last that has begun.
        let begun = across.partition_point(|(r, _)| r.first_column <= column);
        let (rectangle, before) = across[begun - 1];
        before + rectangle.place(row, column)
    };
    (0..seen_l * seen_m)
        .map(|e| place(e / seen_m, e % seen_m))
        .collect()
}

/// The rectangles that hold a row, from left to right, with the number of
/// values before each.
fn across(rectangles: &[Rectangle], row: usize) -> Vec<(&Rectangle, usize)> {
    let mut before = 0;
    let mut across = Vec::new();
    for rectangle in rectangles {
        if rectangle.holds_row(row) {
            across.push((rectangle, before));
        }
        before += rectangle.len();
    }
    across.sort_by_key(|(rectangle, _)| rectangle.first_column);
    across
}
