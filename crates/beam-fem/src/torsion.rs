//! The RX (twist) part of the beam alone, and how far the nut can twist it.

use crate::element::torsion_rod;
use crate::{Beam, BeamError};

/// A symmetric tridiagonal matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Tridiagonal {
    /// Diagonal, n entries.
    pub diagonal: Vec<f64>,
    /// Either side of it, n − 1 entries.
    pub off_diagonal: Vec<f64>,
}

impl Beam {
    /// M_RX (kg·m²) and K_RX (N·m/rad), (N+1)² each: the θx rows and columns
    /// of the full matrices (paper, Section 3.1.3), found without them.
    pub fn torsion(&self) -> (Tridiagonal, Tridiagonal) {
        let nodes = self.mesh.nodes().len();
        let zeros = || Tridiagonal {
            diagonal: vec![0.0; nodes],
            off_diagonal: Vec::with_capacity(nodes - 1),
        };
        let (mut mass, mut stiffness) = (zeros(), zeros());
        for (i, length) in self.mesh.lengths().enumerate() {
            let rod = torsion_rod(&self.section, &self.material, length);
            for node in [i, i + 1] {
                mass.diagonal[node] += rod.mass / 3.0;
                stiffness.diagonal[node] += rod.stiffness;
            }
            mass.off_diagonal.push(rod.mass / 6.0);
            stiffness.off_diagonal.push(-rod.stiffness);
        }
        (mass, stiffness)
    }

    /// Static twist per torque at `node`, rad/(N·m), the driven end held:
    /// the nut's compliance with a node on it. Solved from K_RX; the exact
    /// value is x / (G J), and linear elements meet it at their nodes.
    ///
    /// # Errors
    /// [`BeamError::Index`] for a node that the mesh does not have.
    pub fn torsional_compliance_at_node(&self, node: usize) -> Result<f64, BeamError> {
        let bound = self.mesh.nodes().len();
        if node >= bound {
            return Err(BeamError::Index {
                field: "node",
                index: node,
                bound,
            });
        }
        Ok(self.torsion().1.held_compliance(node, [1.0, 0.0]))
    }

    /// Static twist per torque at `x`, rad/(N·m), the driven end held, where
    /// the nut acts on the two nodes around it through the shape functions
    /// 1 − ξ and ξ: nᵀ K⁻¹ n. Continuous in x. Between nodes it is stiffer
    /// than the rod by [`Beam::shape_function_deficit`].
    pub fn torsional_compliance_at(&self, x: f64) -> f64 {
        let (element, xi) = self.mesh.locate(x);
        let stiffness = self.torsion().1;
        stiffness.held_compliance(element, [1.0 - xi, xi])
    }

    /// What the shape functions leave out of the static compliance at `x`:
    /// ξ (1 − ξ) l / (G J), rad/(N·m), between 0 (at nodes) and l / (4 G J).
    /// A spring of this compliance between nut and mesh restores the exact
    /// x / (G J).
    pub fn shape_function_deficit(&self, x: f64) -> f64 {
        let (element, xi) = self.mesh.locate(x);
        let nodes = self.mesh.nodes();
        let length = nodes[element + 1] - nodes[element];
        let rod = torsion_rod(&self.section, &self.material, length);
        xi * (1.0 - xi) / rod.stiffness
    }
}

impl Tridiagonal {
    /// nᵀ K⁻¹ n with dof 0 held and n = `weights` on `node` and the next.
    /// Elimination runs from the free end to `node`, so that what is left is
    /// the stiffness seen there; K is positive definite once dof 0 is held.
    fn held_compliance(&self, node: usize, weights: [f64; 2]) -> f64 {
        let n = self.diagonal.len();
        let mut load = vec![0.0; n];
        load[node] += weights[0];
        if node + 1 < n {
            load[node + 1] += weights[1];
        }
        load[0] = 0.0;
        let mut pivot = self.diagonal.clone();
        let mut rhs = load.clone();
        for i in (1..n - 1).rev() {
            let factor = self.off_diagonal[i] / pivot[i + 1];
            pivot[i] -= factor * self.off_diagonal[i];
            rhs[i] -= factor * rhs[i + 1];
        }
        let mut twist = 0.0;
        let mut compliance = 0.0;
        for i in 1..n {
            twist = (rhs[i] - self.off_diagonal[i - 1] * twist) / pivot[i];
            compliance += load[i] * twist;
        }
        compliance
    }
}
