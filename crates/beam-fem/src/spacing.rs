//! The least distance of nodes, which the mesh keeps and errors name.

/// [`Mesh::MIN_SPACING`](crate::Mesh::MIN_SPACING).
pub(crate) const MIN_SPACING: f64 = 1e-10;
