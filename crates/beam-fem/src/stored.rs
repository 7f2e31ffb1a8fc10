//! Values as serde reads and writes them (feature `serde`): what the constructors refuse does not get in.

use serde::{Deserialize, Serialize};

use crate::{BeamError, CrossSection, Material, Mesh, SectionProperties};

#[derive(Serialize, Deserialize)]
#[serde(rename = "Material", deny_unknown_fields)]
pub(crate) struct StoredMaterial {
    youngs_modulus: f64,
    poisson_ratio: f64,
    density: f64,
}

impl TryFrom<StoredMaterial> for Material {
    type Error = BeamError;

    fn try_from(stored: StoredMaterial) -> Result<Self, BeamError> {
        Self::new(stored.youngs_modulus, stored.poisson_ratio, stored.density)
    }
}

impl From<Material> for StoredMaterial {
    fn from(material: Material) -> Self {
        Self {
            youngs_modulus: material.youngs_modulus(),
            poisson_ratio: material.poisson_ratio(),
            density: material.density(),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "Mesh", deny_unknown_fields)]
pub(crate) struct StoredMesh {
    nodes: Vec<f64>,
}

impl TryFrom<StoredMesh> for Mesh {
    type Error = BeamError;

    fn try_from(stored: StoredMesh) -> Result<Self, BeamError> {
        Self::from_nodes(stored.nodes)
    }
}

impl From<Mesh> for StoredMesh {
    fn from(mesh: Mesh) -> Self {
        Self {
            nodes: mesh.nodes().to_vec(),
        }
    }
}

impl TryFrom<SectionProperties> for CrossSection {
    type Error = BeamError;

    fn try_from(properties: SectionProperties) -> Result<Self, BeamError> {
        Self::general(properties)
    }
}

impl From<CrossSection> for SectionProperties {
    fn from(section: CrossSection) -> Self {
        Self {
            area: section.area(),
            second_moment_y: section.second_moment_y(),
            second_moment_z: section.second_moment_z(),
            torsion_constant: section.torsion_constant(),
            shear_coefficient_y: section.shear_coefficient(),
            shear_coefficient_z: section.shear_coefficient_z(),
        }
    }
}
