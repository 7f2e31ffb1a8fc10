//! The least distance of nodes, which the mesh keeps and errors name.

/// [`Mesh::LEAST_SPACING`](crate::Mesh::LEAST_SPACING).
pub(crate) const LEAST_SPACING: f64 = 1e-10;
