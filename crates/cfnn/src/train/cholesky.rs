//! Cholesky factorisation and solution in place, parallel over tiles whose
//! cut depends on the size alone: the bits do not depend on the threads.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::reborrow::ReborrowMut;
use faer::{Accum, MatMut, Par};
use rayon::prelude::*;

/// Columns eliminated together.
const PANEL: usize = 128;
/// Columns (trailing part) or rows (panel) of one task.
const TILE: usize = 96;

/// Replaces `b` by the solution of `A x = b`, where `a` holds the lower
/// triangle of the symmetric `A` (column-major, `n x n`) and is overwritten.
/// Returns false, with both arguments spoilt, unless `A` is positive definite
/// to working precision.
pub(super) fn solve(a: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    let mut a = MatMut::from_column_major_slice_mut(a, n, n);
    if !factorise(a.rb_mut()) {
        return false;
    }
    let l = a.as_ref();
    let mut x = MatMut::from_column_major_slice_mut(b, n, 1);
    solve_lower_triangular_in_place(l, x.rb_mut(), Par::Seq);
    solve_upper_triangular_in_place(l.transpose(), x, Par::Seq);
    b.iter().all(|v| v.is_finite())
}

fn factorise(mut rest: MatMut<'_, f64>) -> bool {
    loop {
        let n = rest.nrows();
        let width = PANEL.min(n);
        let (mut corner, _, mut below, trailing) = rest.split_at_mut(width, width);
        if !factorise_corner(corner.rb_mut()) {
            return false;
        }
        if n == width {
            return true;
        }
        let l = corner.as_ref();
        below.rb_mut().par_row_chunks_mut(TILE).for_each(|rows| {
            solve_lower_triangular_in_place(l, rows.transpose_mut(), Par::Seq);
        });
        rest = trailing;
        let below = below.as_ref();
        // Whole columns below and a little above the diagonal: what lies
        // above it is never read.
        rest.rb_mut()
            .par_col_chunks_mut(TILE)
            .enumerate()
            .for_each(|(t, columns)| {
                let first = t * TILE;
                let count = columns.ncols();
                let left = below.subrows(first, below.nrows() - first);
                matmul(
                    columns.subrows_mut(first, left.nrows()),
                    Accum::Add,
                    left,
                    below.subrows(first, count).transpose(),
                    -1.0,
                    Par::Seq,
                );
            });
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
