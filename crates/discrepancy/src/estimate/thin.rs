//! Tall matrices of few columns.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Singular values and vectors of a matrix with far more rows than columns, from the products
/// of its columns. Values below [`Thin::LEAST`] of the largest are lost in these products'
/// rounding and count as none.
#[derive(Clone, Debug)]
pub struct Thin {
    /// Orthonormal columns, the strongest first; 0 if there is no strength.
    pub basis: DMatrix<f64>,
    /// Singular values.
    pub strengths: DVector<f64>,
    /// Of which parts of the matrix's columns each is made, a row each.
    pub parts: DMatrix<f64>,
}

impl Thin {
    /// Least singular value that is told from none, as a share of the largest.
    pub const LEAST: f64 = 1e-6;

    /// Of these columns.
    pub fn of(columns: &[DVector<f64>]) -> Self {
        let (rows, n) = (columns.first().map_or(0, |c| c.len()), columns.len());
        if n == 0 {
            return Self {
                basis: DMatrix::zeros(rows, 0),
                strengths: DVector::zeros(0),
                parts: DMatrix::zeros(0, 0),
            };
        }
        let products = DMatrix::from_fn(n, n, |i, j| columns[i].dot(&columns[j]));
        let eigen = products.symmetric_eigen();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let strength = |i: &usize| eigen.eigenvalues[*i].max(0.0).sqrt();
        let largest = order.first().map_or(0.0, strength);
        let counted = |s: f64| if s > Self::LEAST * largest { s } else { 0.0 };
        let strengths = DVector::from_iterator(n, order.iter().map(|i| counted(strength(i))));
        let parts = DMatrix::from_fn(n, n, |i, j| eigen.eigenvectors[(j, order[i])]);
        let mut basis = DMatrix::zeros(rows, n);
        for (i, mut direction) in basis.column_iter_mut().enumerate() {
            if strengths[i] > 0.0 {
                for (j, column) in columns.iter().enumerate() {
                    direction.axpy(parts[(i, j)] / strengths[i], column, 1.0);
                }
            }
        }
        Self {
            basis,
            strengths,
            parts,
        }
    }

    /// Factors of the columns with which they come nearest to this.
    pub fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        let nothing = DVector::zeros(self.strengths.len());
        let seen = (0..self.strengths.len()).filter(|&i| self.strengths[i] > 0.0);
        seen.fold(nothing, |sum, i| {
            let along = self.basis.column(i).dot(right) / self.strengths[i];
            sum + self.parts.row(i).transpose() * along
        })
    }
}

/// Products of a tall matrix's columns with each other. As products of two matrices, which is
/// far faster than `tr_mul`, and of parts of the rows, which are the same on any number of
/// threads.
pub fn products(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let (rows, n) = matrix.shape();
    let parts: Vec<usize> = (0..rows).step_by(ROWS).collect();
    let of_part = |&first: &usize| {
        let part = matrix.rows(first, ROWS.min(rows - first));
        part.transpose() * part
    };
    let all: Vec<DMatrix<f64>> = parts.par_iter().map(of_part).collect();
    let nothing = DMatrix::zeros(n, n);
    all.into_iter().fold(nothing, |sum, part| sum + part)
}

/// Rows that are multiplied at once: of a hundred columns they fill a cache of a few megabytes.
const ROWS: usize = 4096;

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::{Thin, products};

    fn columns() -> Vec<DVector<f64>> {
        let wave = |w: f64| DVector::from_fn(500, move |i, _| (w * i as f64).sin());
        let (a, b) = (wave(0.1), wave(0.37));
        vec![3.0 * &a + &b, a - 1e-3 * b]
    }

    #[test]
    fn it_has_the_singular_values_of_the_whole_matrix() {
        let matrix = DMatrix::from_columns(&columns());
        let thin = Thin::of(&columns());
        let whole = matrix.clone().svd(true, true);
        let off = (&thin.strengths - &whole.singular_values).norm();
        assert!(off < 1e-9 * thin.strengths[0], "{off}");
        let again = &thin.basis * DMatrix::from_diagonal(&thin.strengths) * &thin.parts;
        assert!((again - &matrix).norm() < 1e-9 * matrix.norm());
        let unit = products(&thin.basis) - DMatrix::identity(2, 2);
        assert!(unit.norm() < 1e-9, "{unit}");
    }

    /// More rows than are multiplied at once, and a number of them that is no multiple of it.
    #[test]
    fn products_are_those_of_whole_columns() {
        let tall = DMatrix::from_fn(2 * super::ROWS + 77, 3, |i, j| ((i * (j + 2)) as f64).sin());
        let off = (products(&tall) - tall.tr_mul(&tall)).norm();
        assert!(off < 1e-12 * tall.norm_squared(), "{off}");
        assert_eq!(products(&DMatrix::zeros(0, 2)), DMatrix::zeros(2, 2));
    }

    #[test]
    fn it_finds_the_factors_and_leaves_out_what_is_the_same_column() {
        let columns = columns();
        let made = 2.0 * &columns[0] - 5.0 * &columns[1];
        let factors = Thin::of(&columns).solve(&made);
        assert!((factors - DVector::from_vec(vec![2.0, -5.0])).norm() < 1e-8);
        let twice = [columns[0].clone(), columns[0].clone()];
        let factors = Thin::of(&twice).solve(&columns[0]);
        assert!((factors - DVector::from_element(2, 0.5)).norm() < 1e-9);
        assert_eq!(Thin::of(&twice).strengths[1], 0.0);
        assert_eq!(Thin::of(&[]).strengths.len(), 0);
    }
}
