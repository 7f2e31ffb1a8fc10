//! What sequences of points have in common: any run of rows, made alone.

use crate::design::zeros;
use crate::{Design, LhsError};
use rayon::prelude::*;
use std::ops::Range;

/// Numbers of f64 in [0, 1) that are evenly apart, and most points of a sequence.
pub(crate) const MOST: u64 = 1 << 53;

/// 2⁻⁵³.
pub(crate) const GRID: f64 = 1.0 / MOST as f64;

/// Rows made by one task: tens of microseconds, which outweigh its scheduling.
const ROWS_PER_TASK: usize = 1024;

/// A sequence of points, each of which can be computed alone.
pub(crate) trait Sequence: Sync {
    fn dims(&self) -> usize;

    /// Coordinate `dim` of point `i` < 2⁵³.
    fn coordinate(&self, i: u64, dim: usize) -> f64;

    /// Coordinate `dim` of points `first`, `first` + 1 and so on.
    fn run<'a>(&self, first: u64, dim: usize, out: impl Iterator<Item = &'a mut f64>) {
        for (i, value) in out.enumerate() {
            *value = self.coordinate(first + i as u64, dim);
        }
    }

    fn fill(&self, first: u64, out: &mut [f64]) {
        let dims = self.dims();
        for dim in 0..dims {
            self.run(first, dim, out[dim..].iter_mut().step_by(dims));
        }
    }

    fn point(&self, i: u64, out: &mut [f64]) -> Result<(), LhsError> {
        if i >= MOST {
            return Err(LhsError::SequenceRow { row: i });
        }
        if out.len() != self.dims() {
            return Err(LhsError::Index {
                what: "length of out",
                found: out.len(),
                valid: "the number of variables,",
                limit: self.dims(),
            });
        }
        self.fill(i, out);
        Ok(())
    }

    fn points(&self, rows: Range<u64>) -> Result<Design, LhsError> {
        let Range { start, end } = rows;
        if start >= end || end > MOST {
            return Err(LhsError::SequenceRows { start, end });
        }
        let dims = self.dims();
        let rows = usize::try_from(end - start).unwrap_or(usize::MAX);
        let mut values = zeros(rows, dims)?;
        values
            .par_chunks_mut(ROWS_PER_TASK * dims)
            .enumerate()
            .for_each(|(task, chunk)| self.fill(start + (task * ROWS_PER_TASK) as u64, chunk));
        Ok(Design::from_valid(dims, values))
    }
}
