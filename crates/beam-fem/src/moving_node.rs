//! The paper's mesh with one node on the nut (its Eqs. 1 and 2).

use crate::error::positive;
use crate::mesh::{check_elements, uniform_node};
use crate::{BeamError, Mesh};

/// A uniform mesh of which one node was moved to the position x.
///
/// The paper: n_S = ⌈N x / L⌉, element n_S gets the length x_R (from its
/// start to x) and the next one 2 L/N − x_R, so node n_S sits at x.
///
/// Three readings, where the paper is silent:
/// - In the last element there is no next one, and the end of the screw must
///   stay: node N − 1 is moved there, between elements of length L/N + x_R
///   and L/N − x_R. Total length is kept everywhere.
/// - Just past an element boundary x_R, and with it an element, would vanish
///   (infinite stiffness, no mass). So the hand-over to the next node waits
///   until x_R reaches `min_fraction` × L/N; until then the old node goes on
///   with x. No element is shorter than that, and the node still sits exactly
///   at x, so that the static compliance at the nut stays continuous.
/// - Within `min_fraction` × L/N of either end of the screw the node stops.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingNode {
    mesh: Mesh,
    node: usize,
}

impl MovingNode {
    /// Usual shortest element, as a fraction of L/N.
    pub const MIN_FRACTION: f64 = 1e-3;

    /// Moves a node of the uniform mesh of `elements` over `length` metres
    /// to `x` metres from the driven end.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for a length that is not above zero, x off
    /// the beam, `min_fraction` above 0.5 or such that the shortest element may be
    /// under twice [`Mesh::MIN_SPACING`] of the beam;
    /// [`BeamError::Elements`] for fewer than two elements.
    pub fn at(length: f64, elements: usize, x: f64, min_fraction: f64) -> Result<Self, BeamError> {
        let (node, position) = Self::place(length, elements, x, min_fraction)?;
        let mut nodes = Mesh::uniform(length, elements)?.nodes().to_vec();
        nodes[node] = position;
        let mesh = Mesh::from_nodes(nodes)?;
        Ok(Self { mesh, node })
    }

    /// Which node [`MovingNode::at`] moves and where to, m; all others stay
    /// where they are in the uniform mesh. Allocates nothing.
    ///
    /// # Errors
    /// As [`MovingNode::at`].
    pub fn place(
        length: f64,
        elements: usize,
        x: f64,
        min_fraction: f64,
    ) -> Result<(usize, f64), BeamError> {
        positive("length", length)?;
        check_elements(elements, 2)?;
        if !(0.0..=length).contains(&x) {
            return Err(BeamError::Parameter {
                field: "x",
                value: x,
                valid: "between 0 and the length of the beam",
            });
        }
        // Twice, as the rounding of the coordinates may take from it.
        let least = 2.0 * Mesh::MIN_SPACING * elements as f64;
        if !(least..=0.5).contains(&min_fraction) {
            return Err(BeamError::Parameter {
                field: "min_fraction",
                value: min_fraction,
                valid: "at least 2e-10 times the number of elements, and at most 0.5",
            });
        }
        let node = segment(length, elements, x, min_fraction).min(elements - 1);
        let shortest = min_fraction * length / elements as f64;
        let neighbour = |index| uniform_node(length, elements, index);
        // Not `clamp`: on a beam of a few of the smallest numbers of f64 rounding
        // may put the two bounds in the wrong order.
        let position = x
            .max(neighbour(node - 1) + shortest)
            .min(neighbour(node + 1) - shortest);
        Ok((node, position))
    }

    /// The mesh with the moved node.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Index of the moved node, 1 to N − 1; node 0 is the driven end.
    pub fn node(&self) -> usize {
        self.node
    }

    /// Where the moved node is, m: x, but for the two ends of the screw.
    pub fn position(&self) -> f64 {
        self.mesh.nodes()[self.node]
    }
}

/// n_S = ⌈N x / L⌉ (Eq. 1), at least 1, its boundaries shifted by the
/// shortest element.
fn segment(length: f64, elements: usize, x: f64, min_fraction: f64) -> usize {
    let segments = x / length * elements as f64 - min_fraction;
    (segments.ceil() as usize).max(1)
}
