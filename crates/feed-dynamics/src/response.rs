//! Frequency response of the drive at one table position.

use nalgebra::{Complex, DMatrix, DVector};

use crate::{DriveError, FeedDrive, NutCoupling};

/// A coordinate where the drive is driven or observed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// Rotation of the motor (rad), driven by a torque (N·m).
    Motor,
    /// Rotation of the torque sensor (rad), driven by a torque (N·m).
    Sensor,
    /// Rotation of screw node 0 … N (rad), driven by a torque (N·m).
    Screw(usize),
    /// Displacement of the table (m), driven by a force (N).
    Table,
}

impl FeedDrive {
    /// Row of a coordinate in the matrices; `None` for a node that does not exist.
    pub fn row(&self, coordinate: Coordinate) -> Option<usize> {
        match coordinate {
            Coordinate::Motor => Some(0),
            Coordinate::Sensor => Some(1),
            Coordinate::Screw(node) => (node <= self.parameters().elements).then_some(2 + node),
            Coordinate::Table => Some(self.coordinates() - 1),
        }
    }

    /// Receptance `H(iω) = [K + iωC − ω²M]⁻¹` from a load at `input` to the
    /// displacement at `output`, one value for each angular frequency (rad/s).
    ///
    /// # Errors
    /// [`DriveError::OffScrew`] where `x` is not on the screw;
    /// [`DriveError::Parameter`] for a screw node that does not exist;
    /// [`DriveError::Singular`] at zero frequency, where the axis is free.
    pub fn receptance(
        &self,
        x: f64,
        coupling: NutCoupling,
        input: Coordinate,
        output: Coordinate,
        angular_frequencies: &[f64],
    ) -> Result<Vec<Complex<f64>>, DriveError> {
        let m = self.matrices(x, coupling)?;
        let (from, to) = (self.checked_row(input)?, self.checked_row(output)?);
        let mut load = DVector::from_element(self.coordinates(), Complex::new(0.0, 0.0));
        load[from] = Complex::new(1.0, 0.0);
        let solve = |&w: &f64| {
            let dynamic = DMatrix::from_fn(load.len(), load.len(), |i, j| {
                let real = m.stiffness[(i, j)] - w * w * m.mass[(i, j)];
                Complex::new(real, w * m.damping[(i, j)])
            });
            // At w = 0 rounding may leave a pivot that is tiny but not zero.
            let free = w == 0.0;
            let solution = (!free).then(|| dynamic.lu().solve(&load)).flatten();
            solution.map(|q| q[to]).ok_or(DriveError::Singular {
                angular_frequency: w,
            })
        };
        angular_frequencies.iter().map(solve).collect()
    }

    fn checked_row(&self, coordinate: Coordinate) -> Result<usize, DriveError> {
        let node = match coordinate {
            Coordinate::Screw(node) => node as f64,
            _ => 0.0,
        };
        self.row(coordinate).ok_or(DriveError::Parameter {
            name: "screw node",
            value: node,
            valid: "at most the number of elements",
        })
    }
}
