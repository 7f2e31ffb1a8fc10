//! Buckling under axial load.

use nalgebra::{Cholesky, DMatrix, SymmetricEigen};

use crate::BeamError;
use crate::system::SystemMatrices;

/// Buckling loads and shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Buckling {
    /// Factors by which the model's axial forces are to be multiplied, ascending: with
    /// an axial force of −1 N they are loads in N.
    pub factors: Vec<f64>,
    /// Shapes over the free rows, one a column, greatest entry ±1.
    pub shapes: DMatrix<f64>,
}

impl SystemMatrices {
    /// The lowest `count` factors λ > 0 with (K + λ K_g) q = 0: buckling under λ times
    /// the axial forces of the model. There are fewer if fewer can buckle; none in
    /// tension. K_g goes with the slope v′, so a column weak in shear has Engesser's
    /// load P_E/(1 + P_E/κGA).
    ///
    /// # Errors
    /// [`BeamError::NotSymmetric`] with cross stiffness that is not symmetric,
    /// [`BeamError::Unsupported`] if a rigid motion is free,
    /// [`BeamError::NotConverged`].
    pub fn buckling(&self, count: usize) -> Result<Buckling, BeamError> {
        self.check_symmetric("buckling needs conservative bearings")?;
        let unsupported = BeamError::Unsupported { task: "buckling" };
        let cholesky = Cholesky::new(self.stiffness.clone()).ok_or(unsupported)?;
        let factor = cholesky.l_dirty();
        // −L⁻¹ K_g L⁻ᵀ y = y/λ.
        let mut reduced = -&self.geometric;
        factor.solve_lower_triangular_mut(&mut reduced);
        reduced.transpose_mut();
        factor.solve_lower_triangular_mut(&mut reduced);
        let symmetric = (&reduced + reduced.transpose()) * 0.5;
        if !symmetric.iter().all(|v| v.is_finite()) {
            return Err(BeamError::NotFinite { field: "geometric" });
        }
        let order = self.order();
        let eigen = SymmetricEigen::try_new(symmetric, f64::EPSILON, 1000 * order)
            .ok_or(BeamError::NotConverged)?;
        let largest = eigen.eigenvalues.amax();
        // Motions without slope have 1/λ = 0, to the rounding of the largest.
        let least = largest * f64::EPSILON * order as f64;
        let mut ranks: Vec<usize> = (0..order)
            .filter(|&k| eigen.eigenvalues[k] > least)
            .collect();
        ranks.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        ranks.truncate(count);
        let mut shapes =
            DMatrix::from_fn(order, ranks.len(), |i, k| eigen.eigenvectors[(i, ranks[k])]);
        factor.tr_solve_lower_triangular_mut(&mut shapes);
        for mut shape in shapes.column_iter_mut() {
            let size = shape.amax();
            if size > 0.0 {
                shape /= size;
            }
        }
        Ok(Buckling {
            factors: ranks
                .iter()
                .map(|&k| eigen.eigenvalues[k].recip())
                .collect(),
            shapes,
        })
    }
}
