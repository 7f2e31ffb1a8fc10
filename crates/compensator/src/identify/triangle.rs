//! The triangle R of [Φ y] = Q R: solutions, residuals and ranks of least squares from it.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::MotionRecord;
use crate::transfer_function::Sections;

/// Rows that are folded into the triangle at a time; a multiple of 8.
const BLOCK: usize = 256;
/// A diagonal entry below this fraction of its column's norm is rounding:
/// the column depends on those before it.
const DEPENDENT: f64 = 1e-12;

/// R of the columns: acceleration (direct feed-through), one for each pole,
/// tracking error.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    r: DMatrix<f64>,
    rows: usize,
}

/// Least-squares coefficients of the leading columns.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    pub coefficients: Vec<f64>,
    pub standard_errors: Vec<f64>,
}

impl Triangle {
    /// Filters the accelerations of all motions, each from rest.
    pub fn of(motions: &[MotionRecord], poles: &[f64]) -> Self {
        let columns = poles.len() + 2;
        let gains: Vec<f64> = poles.iter().map(|p| (1.0 - p * p).sqrt()).collect();
        let mut r = DMatrix::zeros(columns, columns);
        let mut block = DMatrix::zeros(BLOCK, columns);
        let mut filled = 0;
        for motion in motions {
            let mut state = Sections::default();
            for (&acceleration, &error) in motion.acceleration.iter().zip(motion.error) {
                let row = filled;
                block[(row, 0)] = acceleration;
                state.advance(poles, acceleration, |i, section| {
                    block[(row, i + 1)] = gains[i] * section;
                });
                block[(row, columns - 1)] = error;
                filled += 1;
                if filled == BLOCK {
                    fold(&mut r, &mut block);
                    filled = 0;
                }
            }
        }
        block.rows_mut(filled, BLOCK - filled).fill(0.0);
        fold(&mut r, &mut block);
        let rows = motions.iter().map(|motion| motion.error.len()).sum();
        Self { r, rows }
    }

    /// The triangle with or without the column of the direct feed-through.
    pub fn with_direct(&self, direct: bool) -> Self {
        let r = if direct {
            self.r.clone()
        } else {
            self.r.clone().remove_column(0).qr().r()
        };
        Self { r, rows: self.rows }
    }

    /// Least squares on the leading columns; none if they do not determine
    /// their coefficients.
    pub fn solve(&self, columns: usize) -> Option<Solution> {
        let r = self.r.view((0, 0), (columns, columns));
        let independent = |i| {
            let norm = r.column(i).norm();
            r[(i, i)].abs() > DEPENDENT * norm
        };
        if self.rows <= columns || !(0..columns).all(independent) {
            return None;
        }
        let y = self.r.column(self.r.ncols() - 1);
        let coefficients = r.solve_upper_triangular(&y.rows(0, columns).into_owned())?;
        let inverse = r.solve_upper_triangular(&DMatrix::identity(columns, columns))?;
        let residual = y.rows(columns, y.len() - columns).norm_squared();
        let variance = residual / (self.rows - columns) as f64;
        let error = |i| (variance * inverse.row(i).norm_squared()).sqrt();
        Some(Solution {
            coefficients: coefficients.iter().copied().collect(),
            standard_errors: (0..columns).map(error).collect(),
        })
    }

    /// RMS of Φ c − y, where c holds the leading columns' coefficients:
    /// ‖R [c; 0; −1]‖, because Q keeps lengths. 0 for no rows.
    pub fn rms(&self, coefficients: &[f64]) -> f64 {
        let mut deviation: DVector<f64> = -self.r.column(self.r.ncols() - 1);
        for (i, &c) in coefficients.iter().enumerate() {
            deviation.axpy(c, &self.r.column(i), 1.0);
        }
        deviation.norm() / (self.rows.max(1) as f64).sqrt()
    }
}

/// R of R stacked upon the block, by Householder reflections that leave R's
/// zeros alone (Golub and Van Loan, Matrix Computations, 4th ed., chapter
/// 5). On plain slices: with nalgebra's dense QR in its
/// place, an identification took 2.4 times as long.
fn fold(r: &mut DMatrix<f64>, block: &mut DMatrix<f64>) {
    let columns = r.ncols();
    let mut rest = block.as_mut_slice();
    for k in 0..columns {
        let (column, after) = rest.split_at_mut(BLOCK);
        rest = after;
        let below = dot(column, column);
        if below == 0.0 {
            continue;
        }
        let diagonal = r[(k, k)];
        let reflected = -(diagonal * diagonal + below).sqrt().copysign(diagonal);
        let head = diagonal - reflected;
        let scale = 2.0 / (head * head + below);
        r[(k, k)] = reflected;
        for (j, other) in (k + 1..columns).zip(rest.chunks_exact_mut(BLOCK)) {
            let weight = scale * (head * r[(k, j)] + dot(column, other));
            r[(k, j)] -= weight * head;
            for (o, c) in other.iter_mut().zip(column.iter()) {
                *o -= weight * c;
            }
        }
    }
}

/// Scalar product in eight partial sums, which the compiler can vectorise.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    for (x, y) in a.chunks_exact(8).zip(b.chunks_exact(8)) {
        for i in 0..8 {
            sums[i] += x[i] * y[i];
        }
    }
    sums.iter().sum()
}
