//! M(x), C(x) and K(x) of the whole drive: Section 3.1.3 of the paper, its
//! lost minus signs restored.

use beam_fem::element::torsion_rod;
use beam_fem::{Beam, Mesh, MovingNode, Tridiagonal};
use nalgebra::DMatrix;

use crate::{DriveError, DriveParameters, FeedDrive};

/// How the nut meets the screw's mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum NutCoupling {
    /// A fixed mesh; the nut acts between its nodes through the linear shape
    /// functions of the element that it is in. Continuous in x.
    #[default]
    ShapeFunctions,
    /// The paper's: one node of the mesh is moved onto the nut (Eqs. 1 and 2).
    MovingNode,
}

/// Matrices of `M q̈ + C q̇ + K q = F`, each (N+4) × (N+4).
///
/// Row order: motor, torque sensor, screw nodes 0 to N (rad), table (m).
#[derive(Clone, Debug)]
pub struct DriveMatrices {
    /// Mass, kg·m² and kg.
    pub mass: DMatrix<f64>,
    /// Damping, N·m·s/rad, N·s/rad and N·s/m.
    pub damping: DMatrix<f64>,
    /// Stiffness, N·m/rad, N/rad and N/m.
    pub stiffness: DMatrix<f64>,
}

/// Where the nut holds the screw: two neighbouring nodes and their weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NutSeat {
    /// Index of the screw node on the driven side, 0 to N − 1.
    pub node: usize,
    /// Weights of this node and the next; they add up to one.
    pub weights: [f64; 2],
}

/// The rotating part: motor, sensor and screw nodes, without the nut.
/// Both matrices are tridiagonal, (N+3) × (N+3).
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub mass: Tridiagonal,
    pub stiffness: Tridiagonal,
    pub seat: NutSeat,
}

impl FeedDrive {
    /// The chain's matrices and the nut's seat for the table at `x`.
    pub(crate) fn chain(&self, x: f64, coupling: NutCoupling) -> Result<Chain, DriveError> {
        let p = self.parameters();
        let (mesh, seat) = match coupling {
            NutCoupling::ShapeFunctions => {
                let mesh = Mesh::uniform(p.screw_length, p.elements)?;
                let (node, xi) = mesh.locate(x);
                let weights = [1.0 - xi, xi];
                (mesh, NutSeat { node, weights })
            }
            NutCoupling::MovingNode => {
                let moved =
                    MovingNode::at(p.screw_length, p.elements, x, MovingNode::MIN_FRACTION)?;
                // A node that is the nut's own: all weight on it.
                let node = moved.node() - 1;
                let weights = [0.0, 1.0];
                (moved.mesh().clone(), NutSeat { node, weights })
            }
        };
        let (screw_mass, screw_stiffness) = Beam {
            section: p.section.clone(),
            material: p.material.clone(),
            mesh,
        }
        .torsion();
        let (k1, k2) = (p.motor_coupling_stiffness, p.screw_coupling_stiffness);
        let mass = prepend(
            &[p.motor_inertia, p.sensor_inertia],
            &[0.0, 0.0],
            &screw_mass,
        );
        let mut stiffness = prepend(&[k1, k1 + k2], &[-k1, -k2], &screw_stiffness);
        stiffness.diagonal[2] += k2;
        Ok(Chain {
            mass,
            stiffness,
            seat,
        })
    }

    /// M(x), C(x) = βK(x) and K(x) with the table at `x` metres from the driven end.
    ///
    /// # Errors
    /// [`DriveError::OffScrew`] if `x` is not on the screw.
    pub fn matrices(&self, x: f64, coupling: NutCoupling) -> Result<DriveMatrices, DriveError> {
        self.check_position(x)?;
        let p = self.parameters();
        let chain = self.chain(x, coupling)?;
        let n = self.coordinates();
        let mut mass = dense(&chain.mass, n);
        mass[(n - 1, n - 1)] = p.table_mass;

        // K_scn = k(x) b bᵀ: rank one, so rigid motion costs no energy (Eq. 4).
        // The dyad first: its entries, and so K, are symmetric to the last bit.
        let mut b = nalgebra::DVector::zeros(n);
        let first = 2 + chain.seat.node;
        b[first] = self.travel_per_radian() * chain.seat.weights[0];
        b[first + 1] = self.travel_per_radian() * chain.seat.weights[1];
        b[n - 1] = -1.0;
        let stiffness =
            dense(&chain.stiffness, n) + (&b * b.transpose()) * self.contact_stiffness(x);
        let damping = &stiffness * p.stiffness_damping;
        Ok(DriveMatrices {
            mass,
            damping,
            stiffness,
        })
    }
}

impl Chain {
    /// Renews the entries of both elements at the screw's `node`, one that is not
    /// an end, as the nodes are now: as [`FeedDrive::chain`] has them, to the bit.
    pub(crate) fn renew_at(&mut self, node: usize, nodes: &[f64], p: &DriveParameters) {
        let elements = nodes.len() - 1;
        let rod = |e: usize| torsion_rod(&p.section, &p.material, nodes[e + 1] - nodes[e]);
        for e in [node - 1, node] {
            self.mass.off_diagonal[2 + e] = rod(e).mass / 6.0;
            self.stiffness.off_diagonal[2 + e] = -rod(e).stiffness;
        }
        for n in node - 1..=node + 1 {
            let before = n.checked_sub(1).map(rod);
            let after = (n < elements).then(|| rod(n));
            let rods = || before.iter().chain(&after);
            let coupled = if n == 0 {
                p.screw_coupling_stiffness
            } else {
                0.0
            };
            self.mass.diagonal[2 + n] = rods().map(|r| r.mass / 3.0).sum();
            self.stiffness.diagonal[2 + n] = rods().map(|r| r.stiffness).sum::<f64>() + coupled;
        }
    }
}

/// Puts lumped rows before the screw's tridiagonal matrix.
fn prepend(diagonal: &[f64], off_diagonal: &[f64], screw: &Tridiagonal) -> Tridiagonal {
    Tridiagonal {
        diagonal: [diagonal, &screw.diagonal].concat(),
        off_diagonal: [off_diagonal, &screw.off_diagonal].concat(),
    }
}

/// A tridiagonal matrix in the upper left corner of a dense n × n one.
pub(crate) fn dense(t: &Tridiagonal, n: usize) -> DMatrix<f64> {
    let mut m = DMatrix::zeros(n, n);
    for (i, &d) in t.diagonal.iter().enumerate() {
        m[(i, i)] = d;
    }
    for (i, &o) in t.off_diagonal.iter().enumerate() {
        m[(i, i + 1)] = o;
        m[(i + 1, i)] = o;
    }
    m
}
