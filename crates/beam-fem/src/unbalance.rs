//! Response of a spinning shaft to unbalance.

use nalgebra::{Complex, DVector};

use crate::error::finite;
use crate::orbit::Orbit;
use crate::parts::Unbalance;
use crate::system::SystemMatrices;
use crate::{BeamError, Dof};

/// Synchronous motion at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct UnbalanceResponse {
    /// Spin speed, rad/s.
    pub spin: f64,
    /// Complex amplitudes over the free rows: q(t) = Re(q e^{iΩt}).
    pub amplitudes: DVector<Complex<f64>>,
    free: Vec<usize>,
}

impl UnbalanceResponse {
    /// Complex amplitude of a degree of freedom of a node, m or rad; 0 if it is held.
    pub fn at(&self, node: usize, dof: Dof) -> Complex<f64> {
        let row = self.free.binary_search(&dof.at(node)).ok();
        row.map_or(Complex::new(0.0, 0.0), |row| self.amplitudes[row])
    }

    /// Orbit of a node.
    pub fn orbit(&self, node: usize) -> Orbit {
        Orbit::new(self.at(node, Dof::V), self.at(node, Dof::W))
    }
}

impl SystemMatrices {
    /// Steady response to `unbalances` at each of `spins` (rad/s): the force m e Ω²
    /// turns with the shaft, F_v = m e Ω² e^{iφ}, F_w = −i F_v.
    ///
    /// # Errors
    /// [`BeamError::Held`] for a node whose v and w are both held or do not exist,
    /// [`BeamError::Parameter`] for what is not finite, [`BeamError::Resonance`] at an
    /// undamped critical speed.
    pub fn unbalance_response(
        &self,
        unbalances: &[Unbalance],
        spins: &[f64],
    ) -> Result<Vec<UnbalanceResponse>, BeamError> {
        let mut unit = DVector::zeros(self.order());
        for unbalance in unbalances {
            finite("unbalance moment", unbalance.moment)?;
            finite("unbalance phase", unbalance.phase)?;
            let rows = [Dof::V, Dof::W].map(|dof| self.row(dof.at(unbalance.node)));
            if rows == [None, None] {
                let row = Dof::V.at(unbalance.node);
                let field = "unbalance";
                return Err(BeamError::Held { field, row });
            }
            let force = Complex::from_polar(unbalance.moment, unbalance.phase);
            let parts = [force, force * Complex::new(0.0, -1.0)];
            for (row, part) in rows.into_iter().zip(parts) {
                if let Some(row) = row {
                    unit[row] += part;
                }
            }
        }
        let at = |spin: &f64| -> Result<UnbalanceResponse, BeamError> {
            let force = unit.map(|f: Complex<f64>| f * (spin * spin));
            Ok(UnbalanceResponse {
                spin: *spin,
                amplitudes: self.steady_response(*spin, *spin, &force)?,
                free: self.free().to_vec(),
            })
        };
        spins.iter().map(at).collect()
    }
}
