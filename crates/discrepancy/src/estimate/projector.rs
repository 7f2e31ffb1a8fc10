//! What a fit's own parameters cannot do.

use axis_sim::Axis;
use nalgebra::{DMatrix, DVector};

use crate::estimate::known::known_deviations;
use crate::estimate::thin::products;

/// Takes out what the fit's own parameters can do.
///
/// Known parameters have a price, (s/σ)². It is one more row of the problem for
/// each of them: columns of known parameters end in 1/σ there, what is
/// explained ends in 0, and a residual at shares s in −s/σ. So an effect that a
/// known parameter could do, were it allowed to move so far, shows in these rows.
pub struct Projector {
    columns: DMatrix<f64>,
    solved: DMatrix<f64>,
    deviations: Vec<f64>,
    known: usize,
}

impl Projector {
    /// Of whitened columns, the first of them those of known parameters, of which
    /// some are `pinned` to the edge of their tolerance.
    pub fn new(machine: &Axis, columns: &[DVector<f64>], pinned: &[bool]) -> Self {
        let deviations = known_deviations(machine);
        let known = pinned.len();
        let rows = columns.first().map_or(0, |c| c.len());
        let n = columns.len();
        let columns = DMatrix::from_fn(rows + known, n, |i, j| {
            if j < known && pinned[j] {
                0.0
            } else if i < rows {
                columns[j][i]
            } else if i - rows == j {
                1.0 / deviations[j]
            } else {
                0.0
            }
        });
        let mut normal = products(&columns);
        for i in 0..n {
            if i >= known {
                normal[(i, i)] += 1e-9 * normal[(i, i)] + 1e-300;
            } else if pinned[i] {
                normal[(i, i)] = 1.0;
            }
        }
        let inverse = normal.cholesky().map(|c| c.inverse());
        Self {
            solved: inverse.unwrap_or_else(|| DMatrix::zeros(n, n)),
            columns,
            deviations,
            known,
        }
    }

    /// What they leave of a whitened column.
    pub fn reject(&self, v: &DVector<f64>) -> DVector<f64> {
        self.reject_at(v, &vec![0.0; self.known])
    }

    /// What they leave of a whitened rest at these shares of the known parameters.
    pub fn reject_at(&self, v: &DVector<f64>, shares: &[f64]) -> DVector<f64> {
        let rows = v.len();
        let whole = DVector::from_fn(rows + self.known, |i, _| {
            if i < rows {
                v[i]
            } else {
                -shares[i - rows] / self.deviations[i - rows]
            }
        });
        &whole - &self.columns * (&self.solved * self.columns.tr_mul(&whole))
    }
}

/// Sine of the angle between what was found and the nearest thing that another
/// effect can do.
pub fn sine(found: &DVector<f64>, other: &DMatrix<f64>) -> f64 {
    let norm = found.norm();
    if norm == 0.0 {
        return 0.0;
    }
    let left = found - other * other.tr_mul(found);
    (left.norm() / norm).min(1.0)
}
