//! Degrees of freedom of a node.

/// The six degrees of freedom of a node, in the paper's order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Dof {
    /// Axial displacement u, m.
    U = 0,
    /// Deflection v along y, m.
    V = 1,
    /// Deflection w along z, m.
    W = 2,
    /// Twist θx, rad: the paper's RX direction.
    ThetaX = 3,
    /// Rotation θy, rad.
    ThetaY = 4,
    /// Rotation θz, rad.
    ThetaZ = 5,
}

impl Dof {
    /// All six, in order.
    pub const ALL: [Dof; 6] = [
        Dof::U,
        Dof::V,
        Dof::W,
        Dof::ThetaX,
        Dof::ThetaY,
        Dof::ThetaZ,
    ];

    /// Row of this degree of freedom of `node` in the assembled matrices; a
    /// row that no matrix has for a node that no mesh has.
    pub fn at(self, node: usize) -> usize {
        node.saturating_mul(6).saturating_add(self as usize)
    }
}
