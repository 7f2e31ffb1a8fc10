//! Frequency response of the drive at one table position.

use nalgebra::{Complex, DMatrix, DVector};

use crate::error::frequency;
use crate::{DriveError, FeedDrive, NutCoupling};

/// A coordinate where the drive is driven or observed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
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
    /// The axis is free, `K φ = 0` for its rigid motion φ (a radian of everything that
    /// rotates, r of the table), so that but for −ω²M the matrix is singular, and at low
    /// frequencies rounding of K hides that. The rigid motion is therefore split off, as
    /// that in which the output takes part: q = φ α + e with e = 0 at the output, and the
    /// output's equation gives way to the sum of all, each times its part of φ. With K φ
    /// and φᵀK left out where they stand,
    ///
    /// ```text
    /// −ω² φᵀM (φ α + e) = φᵀF                       in place of the output's
    /// −ω² M φ α + (K + iωC − ω²M) e = F             all others
    /// ```
    ///
    /// # Errors
    /// [`DriveError::OffScrew`] if `x` is not on the screw;
    /// [`DriveError::Parameter`] for a screw node that does not exist and a frequency
    /// that is not finite; [`DriveError::Singular`] at zero frequency, where the axis is
    /// free, and at a resonance without damping.
    pub fn receptance(
        &self,
        x: f64,
        coupling: NutCoupling,
        [input, output]: [Coordinate; 2],
        angular_frequencies: &[f64],
    ) -> Result<Vec<Complex<f64>>, DriveError> {
        let m = self.matrices(x, coupling)?;
        let (from, to) = (self.checked_row(input)?, self.checked_row(output)?);
        let rigid = self.rigid_motion();
        let momentum = &m.mass * &rigid;
        let inertia = momentum.dot(&rigid);
        let (n, beta) = (self.coordinates(), self.parameters().stiffness_damping);
        let solve = |&w: &f64| {
            let square = frequency(w)? * w;
            let dynamic = DMatrix::from_fn(n, n, |i, j| match (i == to, j == to) {
                (true, true) => Complex::from(-square * inertia),
                (true, false) => Complex::from(-square * momentum[j]),
                (false, true) => Complex::from(-square * momentum[i]),
                (false, false) => {
                    let spring = m.stiffness[(i, j)];
                    Complex::new(spring - square * m.mass[(i, j)], w * beta * spring)
                }
            });
            let mut load = DVector::zeros(n);
            load[from] = Complex::from(1.0);
            load[to] = Complex::from(rigid[from]);
            let response = dynamic.lu().solve(&load).map(|q| q[to] * rigid[to]);
            let finite = response.filter(|h| h.re.is_finite() && h.im.is_finite());
            finite.ok_or(DriveError::Singular {
                angular_frequency: w,
            })
        };
        angular_frequencies.iter().map(solve).collect()
    }

    /// The motion that no spring resists: one radian of all that rotates.
    fn rigid_motion(&self) -> DVector<f64> {
        let mut motion = DVector::from_element(self.coordinates(), 1.0);
        motion[self.coordinates() - 1] = self.travel_per_radian();
        motion
    }

    pub(crate) fn checked_row(&self, coordinate: Coordinate) -> Result<usize, DriveError> {
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
