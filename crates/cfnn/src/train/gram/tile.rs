//! A tile of entries, accumulated through the blocks of samples by one task.

use std::vec::Vec;

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

use super::super::block::{BlockWork, LANES, Layout};
use super::super::dataset::BLOCK;
use super::plan::{Plan, Rectangle, Run};
use crate::simd::{Kernel, Vectors};

/// Most rows of a tile: a multiple of the product kernel's 48, such that the
/// rows' products over one block of samples stay in the second cache.
const ROWS: usize = 288;
/// Most columns of a tile.
const COLUMNS: usize = 384;
/// Columns whose products are formed together.
const STRIP: usize = 96;

pub(super) struct Tile<'a> {
    first_row: usize,
    first_column: usize,
    values: MatMut<'a, f64>,
}

/// Working memory of one thread.
pub(super) struct Panels {
    /// `rows x samples` of the block, column-major, and room to overshoot.
    deltas: Vec<f64>,
    /// `samples x columns`, column-major.
    activations: Vec<f64>,
    /// The tile's entries, gathered: in place their columns would lie a page
    /// apart.
    sums: Vec<f64>,
    chunks: Vec<Chunk>,
}

/// Up to [`LANES`] neighbouring rows; what overshoots is overwritten by the
/// next.
struct Chunk {
    row: usize,
    neuron: usize,
    first: usize,
}

/// Cuts a rectangle into tiles; the cut depends on its size alone.
pub(super) fn cut<'a>(rectangle: &Rectangle, values: &'a mut [f64], tiles: &mut Vec<Tile<'a>>) {
    let (rows, columns) = (rectangle.rows, rectangle.columns);
    let height = part(rows, ROWS, 48);
    let width = part(columns, COLUMNS, 8);
    let mut rest = MatMut::from_column_major_slice_mut(values, rows, columns);
    for column in (0..columns).step_by(width) {
        let wide = width.min(columns - column);
        let (mut strip, right) = rest.split_at_col_mut(wide);
        rest = right;
        for row in (0..rows).step_by(height) {
            let (values, below) = strip.split_at_row_mut(height.min(rows - row));
            strip = below;
            tiles.push(Tile {
                first_row: rectangle.first_row + row,
                first_column: rectangle.first_column + column,
                values,
            });
        }
    }
}

/// Length of each of the fewest equal parts, rounded up to whole units.
fn part(whole: usize, most: usize, unit: usize) -> usize {
    whole
        .div_ceil(whole.div_ceil(most).max(1))
        .next_multiple_of(unit)
        .max(unit)
}

impl Panels {
    pub fn new() -> Self {
        Self {
            deltas: std::vec![0.0; ROWS * BLOCK + LANES],
            activations: std::vec![0.0; STRIP * BLOCK],
            sums: std::vec![0.0; ROWS * COLUMNS],
            chunks: Vec::new(),
        }
    }
}

/// Samples to add, and where a network's parameters are.
#[derive(Clone, Copy)]
pub struct Samples<'a> {
    pub layout: &'a Layout,
    pub blocks: &'a [BlockWork],
}

impl Tile<'_> {
    /// Number of entries.
    pub fn cost(&self) -> usize {
        self.values.nrows() * self.values.ncols()
    }

    /// Adds the products of all samples of the blocks.
    pub fn add(
        mut self,
        plan: &Plan,
        Samples { layout, blocks }: Samples<'_>,
        panels: &mut Panels,
        vectors: Vectors,
    ) {
        let (rows, columns) = (self.values.nrows(), self.values.ncols());
        let mut sums =
            MatMut::from_column_major_slice_mut(&mut panels.sums[..rows * columns], rows, columns);
        sums.fill(0.0);
        fill_chunks(plan, self.first_row, rows, &mut panels.chunks);
        for block in blocks {
            let samples = block.rows;
            vectors.run(DeltaProducts {
                out: &mut panels.deltas,
                rows,
                block,
                layout,
                chunks: &panels.chunks,
            });
            let deltas =
                MatRef::from_column_major_slice(&panels.deltas[..rows * samples], rows, samples);
            for start in (0..columns).step_by(STRIP) {
                let width = STRIP.min(columns - start);
                let own = &mut panels.activations[..width * samples];
                vectors.run(ActivationProducts {
                    out: own,
                    block,
                    pairs: &plan.activation_pairs[self.first_column + start..][..width],
                });
                matmul(
                    sums.as_mut().subcols_mut(start, width),
                    Accum::Add,
                    deltas,
                    MatRef::from_column_major_slice(own, samples, width),
                    1.0,
                    Par::Seq,
                );
            }
        }
        self.values += sums;
    }
}

fn fill_chunks(plan: &Plan, first_row: usize, rows: usize, chunks: &mut Vec<Chunk>) {
    chunks.clear();
    let end = first_row + rows;
    for &Run {
        row,
        neuron,
        first,
        count,
    } in &plan.runs
    {
        let (from, to) = (row.max(first_row), (row + count).min(end));
        chunks.extend((from..to).step_by(LANES).map(|r| Chunk {
            row: r - first_row,
            neuron,
            first: first + (r - row),
        }));
    }
}

/// Products of deltas, summed over the outputs, sample by sample.
struct DeltaProducts<'a> {
    out: &'a mut [f64],
    rows: usize,
    block: &'a BlockWork,
    layout: &'a Layout,
    chunks: &'a [Chunk],
}

impl Kernel for DeltaProducts<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let neurons = self.layout.neurons;
        let size = neurons * self.layout.outputs;
        for s in 0..self.block.rows {
            // A little of the next sample, for the overshoot.
            let deltas = &self.block.deltas_by_sample[s * size..][..size + LANES];
            let out = &mut self.out[s * self.rows..][..self.rows + LANES];
            for chunk in self.chunks {
                let mut sum = chunk.products(deltas);
                for k in 1..self.layout.outputs {
                    let more = chunk.products(&deltas[k * neurons..]);
                    for (s, m) in sum.iter_mut().zip(more) {
                        *s += m;
                    }
                }
                let out = &mut out[chunk.row..];
                if let Some(out) = out.first_chunk_mut() {
                    *out = sum;
                }
            }
        }
    }
}

impl Chunk {
    #[inline(always)]
    fn products(&self, deltas: &[f64]) -> [f64; LANES] {
        let factor = deltas[self.neuron];
        match deltas[self.first..].first_chunk::<LANES>() {
            Some(others) => others.map(|other| factor * other),
            // Not met: the deltas are followed by as many other numbers.
            None => [0.0; LANES],
        }
    }
}

/// Products of activations, column by column.
struct ActivationProducts<'a> {
    out: &'a mut [f64],
    block: &'a BlockWork,
    pairs: &'a [(usize, usize)],
}

impl Kernel for ActivationProducts<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let rows = self.block.rows;
        let column = |c: usize| &self.block.activations[c * rows..][..rows];
        for (out, &(i, j)) in self.out.chunks_exact_mut(rows).zip(self.pairs) {
            for ((o, x), y) in out.iter_mut().zip(column(i)).zip(column(j)) {
                *o = x * y;
            }
        }
    }
}
