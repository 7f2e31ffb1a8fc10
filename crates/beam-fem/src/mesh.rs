//! Node positions along the beam.

use crate::BeamError;
use crate::error::positive;
use crate::spacing::MIN_SPACING;

/// Nodes along the beam axis, ascending from 0 at the driven end.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "crate::stored::StoredMesh",
        into = "crate::stored::StoredMesh"
    )
)]
pub struct Mesh {
    nodes: Vec<f64>,
}

impl Mesh {
    /// The most elements a mesh may have: a bound on memory, not on theory.
    pub const MAX_ELEMENTS: usize = 1_000_000;

    /// The least distance of neighbouring nodes, as a share of the beam's length.
    ///
    /// A coordinate has 16 digits, so such a distance has six left; and the element
    /// between is 10¹⁰ times as stiff as the beam, of whose stiffness a sum with it
    /// keeps six digits. No screw has elements as short; nodes that are closer are
    /// one node, computed twice.
    pub const MIN_SPACING: f64 = MIN_SPACING;

    /// `elements` equal elements over `length` metres.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for a length that is not finite and above
    /// zero, [`BeamError::Elements`] for none or over
    /// [`Mesh::MAX_ELEMENTS`].
    pub fn uniform(length: f64, elements: usize) -> Result<Self, BeamError> {
        positive("length", length)?;
        check_elements(elements, 1)?;
        let node = |index| uniform_node(length, elements, index);
        Self::from_nodes((0..=elements).map(node).collect())
    }

    /// A mesh of any lengths from its node coordinates in metres.
    ///
    /// # Errors
    /// [`BeamError::Node`] unless they start at 0 and ascend strictly,
    /// [`BeamError::Spacing`] for two that are closer than [`Mesh::MIN_SPACING`]
    /// times the length, [`BeamError::Elements`] for fewer than two nodes.
    pub fn from_nodes(nodes: Vec<f64>) -> Result<Self, BeamError> {
        check_elements(nodes.len().saturating_sub(1), 1)?;
        let mut previous = 0.0;
        for (index, &value) in nodes.iter().enumerate() {
            let valid = if index == 0 {
                value == 0.0
            } else {
                value.is_finite() && value > previous
            };
            if !valid {
                return Err(BeamError::Node { index, value });
            }
            previous = value;
        }
        let mesh = Self { nodes };
        mesh.check_spacing()?;
        Ok(mesh)
    }

    fn check_spacing(&self) -> Result<(), BeamError> {
        let least = Self::MIN_SPACING * self.length();
        match self.lengths().position(|length| length < least) {
            None => Ok(()),
            Some(before) => Err(BeamError::Spacing {
                index: before + 1,
                before: self.nodes[before],
                value: self.nodes[before + 1],
                least,
            }),
        }
    }

    /// Node coordinates, m; one more than elements.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Number N of elements.
    pub fn elements(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Length of the whole beam, m.
    pub fn length(&self) -> f64 {
        self.nodes[self.nodes.len() - 1]
    }

    /// Element lengths, m, from the driven end.
    pub fn lengths(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.nodes.windows(2).map(|pair| pair[1] - pair[0])
    }

    /// The element that holds `x` (metres) and the local coordinate
    /// ξ ∈ [0, 1] in it. Positions off the beam give the nearest end; a node
    /// belongs to the element on its far side (ξ = 0), the last to the last
    /// element. The position is a continuous function of (element + ξ).
    pub fn locate(&self, x: f64) -> (usize, f64) {
        let beyond = self.nodes.partition_point(|&node| node <= x);
        let element = beyond.saturating_sub(1).min(self.elements() - 1);
        let (a, b) = (self.nodes[element], self.nodes[element + 1]);
        (element, ((x - a) / (b - a)).clamp(0.0, 1.0))
    }
}

/// Where a node of a uniform mesh is, m.
pub(crate) fn uniform_node(length: f64, elements: usize, index: usize) -> f64 {
    if index == elements {
        return length;
    }
    length * (index as f64 / elements as f64)
}

/// Refuses meshes with fewer than `minimum` or too many elements.
pub(crate) fn check_elements(elements: usize, minimum: usize) -> Result<(), BeamError> {
    if (minimum..=Mesh::MAX_ELEMENTS).contains(&elements) {
        Ok(())
    } else {
        Err(BeamError::Elements {
            elements,
            minimum,
            maximum: Mesh::MAX_ELEMENTS,
        })
    }
}
