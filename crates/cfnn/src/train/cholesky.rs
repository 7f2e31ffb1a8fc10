//! Cholesky factorisation and solution of the damped normal equations.
//!
//! The lower triangle is kept in square tiles, each contiguous. In one large
//! column-major square the columns lie more than a page apart, and reading a
//! few rows of many columns costs an address translation for each of them.
//! Parallel over tiles whose cut depends on the size alone: the bits do not
//! depend on the threads.

use std::vec;
use std::vec::Vec;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

/// Rows and columns of a tile, but for the last.
const TILE: usize = 128;

/// The lower triangle of a symmetric matrix; what a tile on the diagonal holds
/// above it is never read.
#[derive(Debug, Clone)]
pub(super) struct Symmetric {
    n: usize,
    /// Column by column of tiles, from the diagonal down; each column-major.
    columns: Vec<Vec<Vec<f64>>>,
}

impl Symmetric {
    /// Zero, with `n` rows.
    pub fn new(n: usize) -> Self {
        let count = n.div_ceil(TILE);
        let column = |k: usize| {
            let tile = |i: usize| vec![0.0; size(n, i) * size(n, k)];
            (k..count).map(tile).collect()
        };
        Self {
            n,
            columns: (0..count).map(column).collect(),
        }
    }

    /// Sets the matrix: `write` gets the number of a column and the whole
    /// column, in which it sets the rows from the diagonal down.
    pub fn fill(&mut self, write: impl Fn(usize, &mut [f64]) + Sync) {
        let n = self.n;
        let fill_tiles = |column: &mut Vec<f64>, (k, tiles): (usize, &mut Vec<Vec<f64>>)| {
            for c in 0..size(n, k) {
                write(k * TILE + c, column);
                for (tile, rows) in tiles.iter_mut().zip(column[k * TILE..].chunks(TILE)) {
                    tile[c * rows.len()..][..rows.len()].copy_from_slice(rows);
                }
            }
        };
        self.columns
            .par_iter_mut()
            .enumerate()
            .with_max_len(1)
            .for_each_init(|| vec![0.0; n], fill_tiles);
    }

    /// Replaces `b` by the solution of `A x = b`; the matrix is overwritten.
    /// Returns false, with both spoilt, unless the matrix is positive definite
    /// to working precision.
    pub fn solve(&mut self, b: &mut [f64]) -> bool {
        if !self.factorise() {
            return false;
        }
        self.substitute_forward(b);
        self.substitute_backward(b);
        b.iter().all(|v| v.is_finite())
    }

    /// Trace of the inverse; the matrix is overwritten. None unless the matrix
    /// is positive definite to working precision.
    ///
    /// With `A = L Lᵀ` it is the sum of the squares of the entries of `L⁻¹`,
    /// in which nothing cancels.
    pub fn trace_of_inverse(&mut self) -> Option<f64> {
        if !self.factorise() {
            return None;
        }
        let columns: Vec<f64> = (0..self.columns.len())
            .into_par_iter()
            .with_max_len(1)
            .map(|k| self.squares_of_inverse(k))
            .collect();
        let trace = columns.iter().fold(0.0, |sum, s| sum + s);
        trace.is_finite().then_some(trace)
    }

    /// Sum of the squares of column `k` of tiles of `L⁻¹`: `L X = E_k` solved
    /// forward, tile by tile.
    fn squares_of_inverse(&self, k: usize) -> f64 {
        let (n, width) = (self.n, size(self.n, k));
        let mut x: Vec<Vec<f64>> = (k..self.columns.len())
            .map(|i| vec![0.0; size(n, i) * width])
            .collect();
        x[0].iter_mut()
            .step_by(width + 1)
            .for_each(|diagonal| *diagonal = 1.0);
        let mut sum = 0.0;
        for i in 0..x.len() {
            let rows = size(n, k + i);
            let tiles = &self.columns[k + i];
            let (own, below) = x[i..].split_at_mut(1);
            let l = tile_ref(&tiles[0], rows, rows);
            solve_lower_triangular_in_place(l, tile_mut(&mut own[0], rows, width), Par::Seq);
            sum = own[0].iter().fold(sum, |sum, v| sum + v * v);
            let own = tile_ref(&own[0], rows, width);
            for (tile, to) in tiles[1..].iter().zip(below) {
                let height = tile.len() / rows;
                let to = tile_mut(to, height, width);
                matmul(
                    to,
                    Accum::Add,
                    tile_ref(tile, height, rows),
                    own,
                    -1.0,
                    Par::Seq,
                );
            }
        }
        sum
    }

    fn factorise(&mut self) -> bool {
        let n = self.n;
        for k in 0..self.columns.len() {
            let width = size(n, k);
            let (done, later) = self.columns.split_at_mut(k + 1);
            let Some((corner, below)) = done[k].split_first_mut() else {
                return false;
            };
            if !factorise_corner(tile_mut(corner, width, width)) {
                return false;
            }
            let l = tile_ref(corner, width, width);
            below.par_iter_mut().with_max_len(1).for_each(|tile| {
                let rows = tile.len() / width;
                let tile = tile_mut(tile, rows, width);
                solve_lower_triangular_in_place(l, tile.transpose_mut(), Par::Seq);
            });
            // Tile (i, j) of what follows loses L_ik L_jkᵀ.
            let below: Vec<_> = below
                .iter()
                .map(|tile| tile_ref(tile, tile.len() / width, width))
                .collect();
            let mut tiles = Vec::new();
            for (j, column) in later.iter_mut().enumerate() {
                tiles.extend((j..).zip(column).map(|(i, tile)| (tile, i, j)));
            }
            tiles
                .into_par_iter()
                .with_max_len(1)
                .for_each(|(tile, i, j)| subtract(tile, below[i], below[j], i == j));
        }
        true
    }

    fn substitute_forward(&self, b: &mut [f64]) {
        for (k, tiles) in self.columns.iter().enumerate() {
            let width = size(self.n, k);
            let (own, below) = b[k * TILE..].split_at_mut(width);
            let l = tile_ref(&tiles[0], width, width);
            solve_lower_triangular_in_place(l, tile_mut(own, width, 1), Par::Seq);
            for (tile, rest) in tiles[1..].iter().zip(below.chunks_mut(TILE)) {
                let rows = rest.len();
                let (tile, own) = (tile_ref(tile, rows, width), tile_ref(own, width, 1));
                let rest = tile_mut(rest, rows, 1);
                matmul(rest, Accum::Add, tile, own, -1.0, Par::Seq);
            }
        }
    }

    fn substitute_backward(&self, b: &mut [f64]) {
        for (k, tiles) in self.columns.iter().enumerate().rev() {
            let width = size(self.n, k);
            let (own, below) = b[k * TILE..].split_at_mut(width);
            let mut own = tile_mut(own, width, 1);
            for (tile, rest) in tiles[1..].iter().zip(below.chunks(TILE)) {
                let rows = rest.len();
                let (tile, rest) = (tile_ref(tile, rows, width), tile_ref(rest, rows, 1));
                let tile = tile.transpose();
                matmul(own.as_mut(), Accum::Add, tile, rest, -1.0, Par::Seq);
            }
            let l = tile_ref(&tiles[0], width, width);
            solve_upper_triangular_in_place(l.transpose(), own, Par::Seq);
        }
    }

    /// One entry, by symmetry (for checks).
    #[cfg(test)]
    pub fn at(&self, r: usize, c: usize) -> f64 {
        let (r, c) = (r.max(c), r.min(c));
        let (i, k) = (r / TILE, c / TILE);
        self.columns[k][i - k][r % TILE + (c % TILE) * size(self.n, i)]
    }
}

/// Rows of the tiles in row `i` of tiles.
fn size(n: usize, i: usize) -> usize {
    TILE.min(n - i * TILE)
}

fn tile_ref(tile: &[f64], rows: usize, columns: usize) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(tile, rows, columns)
}

fn tile_mut(tile: &mut [f64], rows: usize, columns: usize) -> MatMut<'_, f64> {
    MatMut::from_column_major_slice_mut(tile, rows, columns)
}

fn subtract(tile: &mut [f64], left: MatRef<'_, f64>, right: MatRef<'_, f64>, diagonal: bool) {
    use BlockStructure::{Rectangular, TriangularLower};
    let tile = tile_mut(tile, left.nrows(), right.nrows());
    let right = right.transpose();
    if diagonal {
        triangular::matmul(
            tile,
            TriangularLower,
            Accum::Add,
            left,
            Rectangular,
            right,
            Rectangular,
            -1.0,
            Par::Seq,
        );
    } else {
        matmul(tile, Accum::Add, left, right, -1.0, Par::Seq);
    }
}

fn factorise_corner(corner: MatMut<'_, f64>) -> bool {
    let n = corner.nrows();
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<f64>(
        n,
        Par::Seq,
        Default::default(),
    ));
    let stack = MemStack::new(&mut memory);
    cholesky_in_place(
        corner,
        Default::default(),
        Par::Seq,
        stack,
        Default::default(),
    )
    .is_ok()
}
