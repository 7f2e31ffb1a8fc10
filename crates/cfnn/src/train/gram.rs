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
//! entries come from plain matrix products, and no entry is computed twice.

use std::vec;
use std::vec::Vec;

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

use super::block::{BlockWork, Layout};
use super::dataset::BLOCK;
use crate::simd::{Kernel, Vectors};

/// Least number of multiplications per sample worth a task of its own.
const TASK: usize = 32 * 1024;

/// Distinct entries of the blocks of `JᵀJ` that belong to one pair of layers.
#[derive(Debug, Clone)]
struct LayerPair {
    /// Columns of the delta products: first and number.
    deltas: (usize, usize),
    /// Columns of the activation products: first and number, in runs.
    runs: Vec<(usize, usize)>,
    /// `deltas.1` rows, one column per activation product, column-major.
    values: Vec<f64>,
    /// For (i, j), i seen by the first layer and j by the second: the start
    /// of the column in `values`.
    column: Vec<usize>,
}

/// Accumulates `JᵀJ` over blocks of samples.
#[derive(Debug, Clone)]
pub(super) struct Gram {
    /// Products of one neuron's delta with those of a run of neurons: the
    /// neuron, first of the run, length.
    delta_runs: Vec<(usize, usize, usize)>,
    delta_columns: usize,
    activation_pairs: Vec<(usize, usize)>,
    /// `delta_columns x samples`, column-major: the left factor as the
    /// product wants it.
    delta_products: Vec<f64>,
    /// `samples x pairs`, column-major.
    activation_products: Vec<f64>,
    /// One for each pair of layers `l <= m`, in order.
    pairs: Vec<LayerPair>,
}

impl Gram {
    pub fn new(layout: &Layout) -> Self {
        let groups = groups(layout);
        let (activation_pairs, starts) = activation_pairs(&groups);
        let mut delta_runs = Vec::new();
        let mut delta_columns = 0;
        let mut pairs = Vec::new();
        for l in 0..layout.layers.len() {
            for m in l..layout.layers.len() {
                let count = push_delta_runs(layout, l, m, &mut delta_runs);
                let deltas = (delta_columns, count);
                delta_columns += count;
                pairs.push(layer_pair(layout, &groups, &starts, (l, m), deltas));
            }
        }
        Self {
            delta_products: vec![0.0; BLOCK * delta_columns],
            activation_products: vec![0.0; BLOCK * activation_pairs.len()],
            delta_runs,
            delta_columns,
            activation_pairs,
            pairs,
        }
    }

    pub fn clear(&mut self) {
        for pair in &mut self.pairs {
            pair.values.fill(0.0);
        }
    }

    /// Adds the samples of one block. Parallel over entries, never over
    /// samples: the order of each sum does not depend on the threads.
    pub fn add(&mut self, layout: &Layout, block: &BlockWork) {
        let rows = block.rows;
        self.fill_products(layout, block);
        let columns = self.delta_columns;
        let deltas = &self.delta_products[..columns * rows];
        let deltas = MatRef::from_column_major_slice(deltas, columns, rows);
        let activations = &self.activation_products;
        let mut tasks = Vec::new();
        for pair in &mut self.pairs {
            push_tasks(pair, &mut tasks);
        }
        tasks.into_par_iter().for_each(|task| {
            let (d0, dn) = task.deltas;
            let (a0, an) = task.run;
            matmul(
                MatMut::from_column_major_slice_mut(task.values, dn, an),
                Accum::Add,
                deltas.subrows(d0, dn),
                MatRef::from_column_major_slice(&activations[a0 * rows..][..an * rows], rows, an),
                1.0,
                Par::Seq,
            );
        });
    }

    fn fill_products(&mut self, layout: &Layout, block: &BlockWork) {
        let rows = block.rows;
        let vectors = Vectors::detect();
        let (runs, pairs) = (&self.delta_runs, &self.activation_pairs);
        let column = |c: usize| &block.activations[c * rows..][..rows];
        let by_sample = layout.outputs * layout.neurons;
        let deltas = block.deltas_by_sample.par_chunks_exact(by_sample);
        rayon::join(
            || {
                let into = self.activation_products.par_chunks_exact_mut(rows);
                into.zip(pairs)
                    .with_min_len(128)
                    .for_each(|(out, &(i, j))| {
                        vectors.run(Product(out, column(i), column(j)));
                    });
            },
            || {
                let into = self.delta_products.par_chunks_exact_mut(self.delta_columns);
                let into = into.zip(deltas).take(rows).with_min_len(32);
                into.for_each(|(out, deltas)| {
                    vectors.run(DeltaProducts {
                        out,
                        deltas,
                        neurons: layout.neurons,
                        runs,
                    });
                });
            },
        );
    }

    /// Writes the lower triangle of `factor JᵀJ + damping I` into a
    /// column-major square; the part above the diagonal is left as it is.
    pub fn write_lower(&self, layout: &Layout, factor: f64, damping: f64, into: &mut [f64]) {
        into.par_chunks_mut(layout.parameters)
            .enumerate()
            .with_min_len(32)
            .for_each(|(c, column)| {
                self.write_column(layout, factor, c, column);
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
        let own = &self.pairs[diagonal];
        for j in i..layer.seen {
            let row = layer.first_parameter + j * layer.neurons;
            let start = own.column[i * layer.seen + j];
            let first = if j == i { p } else { 0 };
            for q in first..layer.neurons {
                let pair = triangle_index(p.min(q), p.max(q), layer.neurons);
                out[row + q] = factor * own.values[start + pair];
            }
        }
        for (other, pair) in layout.layers[l + 1..]
            .iter()
            .zip(&self.pairs[diagonal + 1..])
        {
            let starts = &pair.column[i * other.seen..][..other.seen];
            let rows = out[other.first_parameter..].chunks_exact_mut(other.neurons);
            for (&start, rows) in starts.iter().zip(rows) {
                let values = &pair.values[start + p * other.neurons..];
                for (to, from) in rows.iter_mut().zip(values) {
                    *to = factor * from;
                }
            }
        }
    }
}

/// Index of `(p, q)`, `p <= q < n`, in the rows of an upper triangle.
fn triangle_index(p: usize, q: usize, n: usize) -> usize {
    p * (2 * n - p + 1) / 2 + (q - p)
}

/// The activations in groups that layers see together: first and number.
/// Layer `l` sees the groups `0..=l`.
fn groups(layout: &Layout) -> Vec<(usize, usize)> {
    let mut first = 0;
    layout
        .layers
        .iter()
        .map(|layer| {
            let group = (first, layer.seen - first);
            first = layer.seen;
            group
        })
        .collect()
}

/// All pairs of activations, ordered by the later group, then by the earlier;
/// and where each pair of groups `(a, b)`, `a <= b`, starts (`[b][a]`).
type PairsAndStarts = (Vec<(usize, usize)>, Vec<Vec<usize>>);
fn activation_pairs(groups: &[(usize, usize)]) -> PairsAndStarts {
    let mut pairs = Vec::new();
    let mut starts = Vec::new();
    for (b, &(b0, bn)) in groups.iter().enumerate() {
        let mut row = Vec::new();
        for &(a0, an) in &groups[..=b] {
            row.push(pairs.len());
            for i in a0..a0 + an {
                let from = if a0 == b0 { i } else { b0 };
                pairs.extend((from..b0 + bn).map(|j| (i, j)));
            }
        }
        row.push(pairs.len());
        starts.push(row);
    }
    (pairs, starts)
}

/// The pairs of neurons of two layers; returns their number.
fn push_delta_runs(
    layout: &Layout,
    l: usize,
    m: usize,
    runs: &mut Vec<(usize, usize, usize)>,
) -> usize {
    let (a, b) = (&layout.layers[l], &layout.layers[m]);
    let end = b.first_neuron + b.neurons;
    let mut count = 0;
    for p in a.first_neuron..a.first_neuron + a.neurons {
        let from = if l == m { p } else { b.first_neuron };
        runs.push((p, from, end - from));
        count += end - from;
    }
    count
}

/// Element by element into the first.
struct Product<'a>(&'a mut [f64], &'a [f64], &'a [f64]);

impl Kernel for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for ((o, x), y) in self.0.iter_mut().zip(self.1).zip(self.2) {
            *o = x * y;
        }
    }
}

/// All products of deltas of one sample, summed over the outputs.
struct DeltaProducts<'a> {
    out: &'a mut [f64],
    /// `neurons` numbers for each output.
    deltas: &'a [f64],
    neurons: usize,
    runs: &'a [(usize, usize, usize)],
}

impl Kernel for DeltaProducts<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (k, deltas) in self.deltas.chunks_exact(self.neurons).enumerate() {
            let mut out = &mut *self.out;
            for &(p, first, count) in self.runs {
                let (own, rest) = out.split_at_mut(count);
                out = rest;
                let factor = deltas[p];
                for (o, d) in own.iter_mut().zip(&deltas[first..first + count]) {
                    *o = if k == 0 { factor * d } else { *o + factor * d };
                }
            }
        }
    }
}

fn layer_pair(
    layout: &Layout,
    groups: &[(usize, usize)],
    starts: &[Vec<usize>],
    (l, m): (usize, usize),
    deltas: (usize, usize),
) -> LayerPair {
    // Of the pairs whose later group is b, the layer l takes part in those
    // whose earlier group it sees: a run, since they are ordered by a.
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for (b, starts) in starts.iter().enumerate().take(m + 1) {
        let (start, end) = (starts[0], starts[l.min(b) + 1]);
        match runs.last_mut() {
            Some(last) if last.0 + last.1 == start => last.1 += end - start,
            _ => runs.push((start, end - start)),
        }
    }
    let (seen_l, seen_m) = (layout.layers[l].seen, layout.layers[m].seen);
    let mut column = vec![0; seen_l * seen_m];
    for i in 0..seen_l {
        for j in 0..seen_m {
            let global = activation_index(groups, starts, i.min(j), i.max(j));
            column[i * seen_m + j] = local_index(&runs, global) * deltas.1;
        }
    }
    let columns = runs.iter().map(|run| run.1).sum::<usize>();
    LayerPair {
        deltas,
        runs,
        values: vec![0.0; deltas.1 * columns],
        column,
    }
}

fn activation_index(groups: &[(usize, usize)], starts: &[Vec<usize>], i: usize, j: usize) -> usize {
    let group = |x: usize| groups.partition_point(|&(first, n)| first + n <= x);
    let (a, b) = (group(i), group(j));
    let (i, j) = (i - groups[a].0, j - groups[b].0);
    let within = if a == b {
        triangle_index(i, j, groups[b].1)
    } else {
        i * groups[b].1 + j
    };
    starts[b][a] + within
}

fn local_index(runs: &[(usize, usize)], global: usize) -> usize {
    let mut before = 0;
    for &(first, count) in runs {
        if global < first + count {
            return before + (global - first);
        }
        before += count;
    }
    unreachable!("every pair that a layer sees lies in its runs")
}

struct Task<'a> {
    deltas: (usize, usize),
    run: (usize, usize),
    values: &'a mut [f64],
}

/// Cuts one layer pair into products of comparable cost; the cut depends on
/// the shape alone.
fn push_tasks<'a>(pair: &'a mut LayerPair, tasks: &mut Vec<Task<'a>>) {
    let deltas = pair.deltas;
    let step = TASK.div_ceil(deltas.1).next_multiple_of(8);
    let mut rest = pair.values.as_mut_slice();
    for &(first, count) in &pair.runs {
        let mut done = 0;
        while done < count {
            let take = if count - done < step + step / 2 {
                count - done
            } else {
                step
            };
            let (values, later) = rest.split_at_mut(take * deltas.1);
            rest = later;
            tasks.push(Task {
                deltas,
                run: (first + done, take),
                values,
            });
            done += take;
        }
    }
}
