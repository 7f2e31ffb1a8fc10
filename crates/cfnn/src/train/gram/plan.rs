//! Which products of deltas meet which products of activations.
//!
//! Rows are pairs of neurons, ordered by the earlier layer `l`, then by the
//! later `m`; columns are pairs of activations, ordered by the later group
//! `b`, then by the earlier `a`, where group `b` is what layer `b` sees and
//! the layer before it does not. The pair of layers `(l, m)` meets the pair
//! of groups `(a, b)` where `a <= l` and `b <= m`. With these orders the
//! staircase falls into rectangles whose rows and columns are contiguous:
//!
//! ```text
//! (b,b)                              x (b,b)
//! (b-1,b), (b-1,b+1), … and all after x (b-1,b-1), (0,b), …, (b-1,b)
//! (l,b), (l,b+1), …, l <= b-2        x (0,b), …, (l,b)
//! ```

use std::vec::Vec;

use super::super::block::Layout;

/// A run of neighbouring rows: the products of one neuron's delta with those
/// of consecutive neurons.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    pub row: usize,
    pub neuron: usize,
    pub first: usize,
    pub count: usize,
}

/// All entries of consecutive rows and columns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rectangle {
    pub first_row: usize,
    pub rows: usize,
    pub first_column: usize,
    pub columns: usize,
}

impl Rectangle {
    /// From the first row and column to those before which it ends.
    fn between(rows: (usize, usize), columns: (usize, usize)) -> Self {
        Self {
            first_row: rows.0,
            rows: rows.1 - rows.0,
            first_column: columns.0,
            columns: columns.1 - columns.0,
        }
    }

    pub fn len(&self) -> usize {
        self.rows * self.columns
    }

    pub fn holds_row(&self, row: usize) -> bool {
        (self.first_row..self.first_row + self.rows).contains(&row)
    }

    /// Place, in the column-major values, of an entry that lies within.
    pub fn place(&self, row: usize, column: usize) -> usize {
        row - self.first_row + (column - self.first_column) * self.rows
    }
}

/// The orders of rows and columns.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    pub runs: Vec<Run>,
    /// The pairs of activations, column by column.
    pub activation_pairs: Vec<(usize, usize)>,
    /// The activations in groups: first and number.
    groups: Vec<(usize, usize)>,
    /// First row of the pair of layers `(l, m)` at `[l][m - l]`.
    rows: Vec<Vec<usize>>,
    end_row: usize,
    /// First column of the pair of groups `(a, b)` at `[b][a]`.
    columns: Vec<Vec<usize>>,
}

impl Plan {
    pub fn new(layout: &Layout) -> Self {
        let groups = groups(layout);
        let (activation_pairs, columns) = activation_pairs(&groups);
        let mut plan = Self {
            runs: Vec::new(),
            activation_pairs,
            groups,
            rows: Vec::new(),
            end_row: 0,
            columns,
        };
        for l in 0..layout.layers.len() {
            let mut firsts = Vec::new();
            for m in l..layout.layers.len() {
                firsts.push(plan.end_row);
                plan.push_runs(layout, l, m);
            }
            plan.rows.push(firsts);
        }
        plan
    }

    /// The rows of two layers.
    fn push_runs(&mut self, layout: &Layout, l: usize, m: usize) {
        let (a, b) = (&layout.layers[l], &layout.layers[m]);
        let end = b.first_neuron + b.neurons;
        for neuron in a.first_neuron..a.first_neuron + a.neurons {
            let first = if l == m { neuron } else { b.first_neuron };
            self.runs.push(Run {
                row: self.end_row,
                neuron,
                first,
                count: end - first,
            });
            self.end_row += end - first;
        }
    }

    /// Pairs of layers `l <= m` in the order of the rows.
    pub fn layer_pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let layers = self.rows.len();
        (0..layers).flat_map(move |l| (l..layers).map(move |m| (l, m)))
    }

    /// First row of the pair of layers `l <= m`.
    pub fn first_row(&self, l: usize, m: usize) -> usize {
        self.rows[l][m - l]
    }

    /// Row after the last of the pairs whose earlier layer is `l`.
    fn row_after(&self, l: usize) -> usize {
        self.rows.get(l + 1).map_or(self.end_row, |rows| rows[0])
    }

    /// Column of the activations `i <= j`.
    pub fn column(&self, i: usize, j: usize) -> usize {
        let group = |x: usize| self.groups.partition_point(|&(first, n)| first + n <= x);
        let (a, b) = (group(i), group(j));
        let (i, j) = (i - self.groups[a].0, j - self.groups[b].0);
        let within = if a == b {
            triangle_index(i, j, self.groups[b].1)
        } else {
            i * self.groups[b].1 + j
        };
        self.columns[b][a] + within
    }

    /// The rectangles that cover all entries, each once.
    pub fn rectangles(&self) -> Vec<Rectangle> {
        let layers = self.rows.len();
        let columns = &self.columns;
        let mut all = Vec::new();
        for b in 0..layers {
            let own = self.first_row(b, b);
            let own_end = self.rows[b].get(1).map_or(self.row_after(b), |&row| row);
            let square = (columns[b][b], columns[b][b + 1]);
            all.push(Rectangle::between((own, own_end), square));
            if b > 0 {
                let rows = (self.first_row(b - 1, b), self.end_row);
                let before = (columns[b - 1][b - 1], columns[b][b]);
                all.push(Rectangle::between(rows, before));
            }
            for l in 0..b.saturating_sub(1) {
                let rows = (self.first_row(l, b), self.row_after(l));
                let seen = (columns[b][0], columns[b][l + 1]);
                all.push(Rectangle::between(rows, seen));
            }
        }
        all
    }
}

/// Index of `(p, q)`, `p <= q < n`, in the rows of an upper triangle.
pub(super) fn triangle_index(p: usize, q: usize, n: usize) -> usize {
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
/// and where each pair of groups `(a, b)`, `a <= b`, starts (`[b][a]`, with
/// the end of the row after its last).
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
