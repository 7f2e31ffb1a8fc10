//! Natural modes of the drive against the table's position.

use nalgebra::DMatrix;

use crate::{DriveError, FeedDrive, NutCoupling};

/// Undamped natural modes at one table position.
#[derive(Clone, Debug)]
pub struct DriveModes {
    /// Angular frequencies, rad/s, ascending; the first is the rigid motion, 0.
    pub frequencies_rad_s: Vec<f64>,
    /// Damping ratios ζ = βω/2 of the same modes; 0 for the rigid motion.
    pub damping_ratios: Vec<f64>,
    /// Mass-normalised shapes, one a column, rows as in [`crate::DriveMatrices`].
    pub shapes: DMatrix<f64>,
}

impl FeedDrive {
    /// Natural modes with the table at `x` metres from the driven end.
    ///
    /// # Errors
    /// [`DriveError::OffScrew`] if `x` is not on the screw.
    pub fn modes(&self, x: f64, coupling: NutCoupling) -> Result<DriveModes, DriveError> {
        let m = self.matrices(x, coupling)?;
        let modes = beam_fem::natural_modes(&m.mass, &m.stiffness)?;
        let beta = self.parameters().stiffness_damping;
        let damping_ratios = modes.frequencies_rad_s.iter().map(|w| 0.5 * beta * w);
        Ok(DriveModes {
            damping_ratios: damping_ratios.collect(),
            frequencies_rad_s: modes.frequencies_rad_s,
            shapes: modes.shapes,
        })
    }
}
