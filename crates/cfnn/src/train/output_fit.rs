//! The output layer by linear least squares, the hidden layers held.
//!
//! The outputs are linear in the output layer's parameters, so their best
//! values follow from a QR factorisation of the activations. It is built up
//! block by block: only triangles are kept.

use std::vec;
use std::vec::Vec;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::qr::no_pivoting::factor::{qr_in_place, qr_in_place_scratch};
use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::{Mat, MatMut, Par};

use super::dataset::SampleBlock;

/// Upper triangles of blocks of `[activations | targets]`, collected.
#[derive(Debug, Clone)]
pub(super) struct Triangles {
    columns: usize,
    /// Rows of the triangles, row-major.
    rows: Vec<f64>,
}

impl Triangles {
    pub fn new(columns: usize) -> Self {
        Self {
            columns,
            rows: Vec::new(),
        }
    }

    pub fn push(&mut self, triangle: &[f64]) {
        self.rows.extend_from_slice(triangle);
    }

    /// Replaces the triangles collected so far by their common one.
    pub fn reduce(&mut self) {
        let rows = self.rows.len() / self.columns;
        let stored = &self.rows;
        let columns = self.columns;
        let table = Mat::from_fn(rows, columns, |i, j| stored[i * columns + j]);
        self.rows = triangle(table);
    }

    /// The least-squares weights of the first `unknowns` columns for the
    /// remaining columns as right-hand sides: `unknowns x outputs`,
    /// row-major. The ridge is relative to the largest column norm: columns
    /// of tansig neurons can agree to rounding, and without it their weights
    /// would be arbitrarily large.
    pub fn solve(mut self, unknowns: usize, ridge: f64) -> Vec<f64> {
        let columns = self.columns;
        let scale = (0..unknowns)
            .map(|c| {
                self.rows
                    .iter()
                    .skip(c)
                    .step_by(columns)
                    .map(|v| v * v)
                    .sum()
            })
            .fold(0.0, f64::max);
        let ridge = ridge * f64::sqrt(scale);
        for i in 0..unknowns {
            let mut row = vec![0.0; columns];
            row[i] = ridge;
            self.rows.extend_from_slice(&row);
        }
        self.reduce();
        let outputs = columns - unknowns;
        let rows = &self.rows;
        let upper = Mat::from_fn(unknowns, unknowns, |i, j| rows[i * columns + j]);
        let mut x = Mat::from_fn(unknowns, outputs, |i, j| rows[i * columns + unknowns + j]);
        solve_upper_triangular_in_place(upper.as_ref(), x.as_mut(), Par::Seq);
        (0..unknowns * outputs)
            .map(|e| x[(e / outputs, e % outputs)])
            .collect()
    }
}

/// The triangle of the activations that `links` name beside the targets, each
/// row times the root of its sample's weight.
pub(super) fn block_triangle(
    activations: &[f64],
    links: &[usize],
    samples: &SampleBlock,
) -> Vec<f64> {
    let rows = samples.rows;
    let targets = samples.targets.len() / rows;
    let mut table = Mat::from_fn(rows, links.len() + targets, |i, j| match links.get(j) {
        Some(link) => activations[link * rows + i],
        None => samples.targets[(j - links.len()) * rows + i],
    });
    if let Some(roots) = &samples.roots {
        for mut column in table.col_iter_mut() {
            for (i, root) in roots.iter().enumerate() {
                column[i] *= root;
            }
        }
    }
    triangle(table)
}

/// Upper triangle of the QR factorisation, row-major.
fn triangle(mut table: Mat<f64>) -> Vec<f64> {
    let (rows, columns) = (table.nrows(), table.ncols());
    let kept = rows.min(columns);
    let panel = 16.min(kept);
    let mut coefficients = Mat::<f64>::zeros(panel, kept);
    factorise(table.as_mut(), coefficients.as_mut());
    let mut out = vec![0.0; kept * columns];
    for i in 0..kept {
        for j in i..columns {
            out[i * columns + j] = table[(i, j)];
        }
    }
    out
}

fn factorise(table: MatMut<'_, f64>, coefficients: MatMut<'_, f64>) {
    let request = qr_in_place_scratch::<f64>(
        table.nrows(),
        table.ncols(),
        coefficients.nrows(),
        Par::Seq,
        Default::default(),
    );
    let mut memory = MemBuffer::new(request);
    qr_in_place(
        table,
        coefficients,
        Par::Seq,
        MemStack::new(&mut memory),
        Default::default(),
    );
}
