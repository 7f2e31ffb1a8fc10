//! Natural modes of dense matrices.

use nalgebra::{Cholesky, DMatrix, SymmetricEigen};

use crate::BeamError;

/// Undamped natural modes of `M q̈ + K q = 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Angular frequencies ω, rad/s, ascending; rigid-body modes are 0.
    pub frequencies_rad_s: Vec<f64>,
    /// Shapes φ, one a column in the same order, mass-normalised:
    /// φᵀ M φ = 1. Rows are the degrees of freedom of the matrices.
    pub shapes: DMatrix<f64>,
}

impl Modes {
    /// Frequencies ω / 2π, Hz.
    pub fn frequencies_hz(&self) -> Vec<f64> {
        let hz = |w: &f64| w / std::f64::consts::TAU;
        self.frequencies_rad_s.iter().map(hz).collect()
    }
}

/// All modes of a dense symmetric pencil, n × n: Cholesky M = L Lᵀ, then the
/// symmetric problem of L⁻¹ K L⁻ᵀ. Only lower triangles are read.
///
/// Eigenvalues ω² at or below n · 2⁻⁵² · ω²_max in size are rounding and are
/// reported as 0: rigid-body modes, or springs too soft to be told from them.
///
/// # Errors
/// [`BeamError::Shape`], [`BeamError::NotFinite`],
/// [`BeamError::MassNotPositiveDefinite`], [`BeamError::StiffnessNegative`]
/// for an eigenvalue below zero by more than 100 times that,
/// [`BeamError::NotConverged`].
pub fn natural_modes(mass: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Result<Modes, BeamError> {
    let order = mass.nrows();
    check_dense("mass", mass, order)?;
    check_dense("stiffness", stiffness, order)?;
    if order == 0 {
        return Err(BeamError::ModeCount { count: 0, order });
    }
    let cholesky = Cholesky::new(mass.clone()).ok_or(BeamError::MassNotPositiveDefinite)?;
    let factor = cholesky.l_dirty();
    let mut reduced = stiffness.clone();
    reduced.fill_upper_triangle_with_lower_triangle();
    // Two solves with L, on the columns and then, transposed, on the rows:
    // the diagonal of L is above zero, so neither can fail.
    factor.solve_lower_triangular_mut(&mut reduced);
    reduced.transpose_mut();
    factor.solve_lower_triangular_mut(&mut reduced);
    let symmetric = (&reduced + reduced.transpose()) * 0.5;
    if !symmetric.iter().all(|v| v.is_finite()) {
        return Err(BeamError::NotFinite { field: "reduced" });
    }
    let eigen = SymmetricEigen::try_new(symmetric, f64::EPSILON, 1000 * order)
        .ok_or(BeamError::NotConverged)?;
    let mut shapes = eigen.eigenvectors;
    factor.tr_solve_lower_triangular_mut(&mut shapes);
    let numbers = eigen.eigenvalues.iter().chain(&shapes);
    if !numbers.into_iter().all(|v| v.is_finite()) {
        return Err(BeamError::NotConverged);
    }
    sorted(eigen.eigenvalues.as_slice(), &shapes)
}

/// Sorts, clamps rigid modes, and takes the roots.
fn sorted(eigenvalues: &[f64], shapes: &DMatrix<f64>) -> Result<Modes, BeamError> {
    let order = eigenvalues.len();
    let largest = eigenvalues.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let rounding = order as f64 * f64::EPSILON * largest;
    let mut ranks: Vec<usize> = (0..order).collect();
    ranks.sort_by(|&i, &j| eigenvalues[i].total_cmp(&eigenvalues[j]));
    if eigenvalues[ranks[0]] < -100.0 * rounding {
        return Err(BeamError::StiffnessNegative);
    }
    let frequency = |&i: &usize| frequency(eigenvalues[i], rounding);
    Ok(Modes {
        frequencies_rad_s: ranks.iter().map(frequency).collect(),
        shapes: DMatrix::from_fn(order, order, |row, column| shapes[(row, ranks[column])]),
    })
}

/// √ω², or 0 where the eigenvalue cannot be told from rounding.
pub(crate) fn frequency(eigenvalue: f64, rounding: f64) -> f64 {
    if eigenvalue > rounding {
        eigenvalue.sqrt()
    } else {
        0.0
    }
}

/// Refuses what is not `order` × `order`.
pub(crate) fn check_square(
    field: &'static str,
    matrix: &DMatrix<f64>,
    order: usize,
) -> Result<(), BeamError> {
    let (rows, columns) = matrix.shape();
    if rows == order && columns == order {
        return Ok(());
    }
    Err(BeamError::Shape {
        field,
        rows,
        columns,
        order,
    })
}

fn check_dense(field: &'static str, matrix: &DMatrix<f64>, order: usize) -> Result<(), BeamError> {
    check_square(field, matrix, order)?;
    if !matrix.iter().all(|v| v.is_finite()) {
        return Err(BeamError::NotFinite { field });
    }
    Ok(())
}
