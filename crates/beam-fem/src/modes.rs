//! Natural modes of dense matrices.

use nalgebra::{Cholesky, DMatrix};

use crate::BeamError;
use crate::dense::{self, reduced};

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

/// All modes of a dense symmetric pencil, n × n. Only lower triangles are read.
///
/// The rigid modes, of frequency 0, are as many as motions whose spring energy is
/// rounding: at most τ Σ K_ii x_i², τ = 4n · 2⁻⁵² (the theory page derives it). The others are those
/// of L⁻¹ K L⁻ᵀ with M = L Lᵀ, and, where they lie more than 2²⁶ below the highest
/// ω², of L⁻¹ M L⁻ᵀ with K + sM = L Lᵀ, whose rounding counts in low modes less.
///
/// # Errors
/// [`BeamError::Shape`], [`BeamError::NotFinite`],
/// [`BeamError::MassNotPositiveDefinite`]; [`BeamError::StiffnessNegative`] if a
/// motion has an energy below −τ Σ K_ii x_i², [`BeamError::Unresolved`] if one has
/// one between τ and 10 τ times that sum, so that a tenth of its ω² may be rounding, or
/// where rounding could hide, as a rigid mode, an ω² of a thousandth of the lowest one;
/// [`BeamError::NotConverged`].
pub fn natural_modes(mass: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Result<Modes, BeamError> {
    let order = mass.nrows();
    check_dense("mass", mass, order)?;
    check_dense("stiffness", stiffness, order)?;
    if order == 0 {
        return Err(BeamError::ModeCount { count: 0, order });
    }
    let mut stiffness = stiffness.clone();
    stiffness.fill_upper_triangle_with_lower_triangle();
    let mut mass = mass.clone();
    mass.fill_upper_triangle_with_lower_triangle();
    let cholesky = Cholesky::new(mass.clone()).ok_or(BeamError::MassNotPositiveDefinite)?;
    let mut pairs = reduced(&cholesky, &stiffness)?;
    let rigid = dense::rigid_motions(&mass, &stiffness)?;
    dense::refine_low(&mut pairs, rigid.count, &mass, &stiffness)?;
    dense::check_rigid(&pairs, &rigid, &mass, &stiffness)?;
    let frequency = |(mode, &value): (usize, &f64)| {
        // The rigid ones come first; no other is below zero.
        if mode < rigid.count {
            0.0
        } else {
            value.max(0.0).sqrt()
        }
    };
    Ok(Modes {
        frequencies_rad_s: pairs.values.iter().enumerate().map(frequency).collect(),
        shapes: pairs.shapes,
    })
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
