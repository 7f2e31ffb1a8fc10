//! Linear elastic, isotropic material.

use crate::BeamError;
use crate::error::positive;

/// A linear elastic, isotropic material. Made by [`Material::new`], which
/// checks it, and immutable after that.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "crate::stored::StoredMaterial",
        into = "crate::stored::StoredMaterial"
    )
)]
pub struct Material {
    youngs_modulus: f64,
    poisson_ratio: f64,
    density: f64,
}

impl Material {
    /// Checks and makes a material from E (Pa), ν and ρ (kg/m³).
    ///
    /// # Errors
    /// [`BeamError::Parameter`] unless E and ρ are finite and above zero and
    /// −1 < ν ≤ 0.5 (the bounds of a stable isotropic solid).
    pub fn new(youngs_modulus: f64, poisson_ratio: f64, density: f64) -> Result<Self, BeamError> {
        positive("youngs_modulus", youngs_modulus)?;
        positive("density", density)?;
        if !(poisson_ratio > -1.0 && poisson_ratio <= 0.5) {
            return Err(BeamError::Parameter {
                field: "poisson_ratio",
                value: poisson_ratio,
                valid: "above -1 and at most 0.5",
            });
        }
        Ok(Self {
            youngs_modulus,
            poisson_ratio,
            density,
        })
    }

    /// Young's modulus E, Pa.
    pub fn youngs_modulus(&self) -> f64 {
        self.youngs_modulus
    }

    /// Poisson's ratio ν, dimensionless (the paper's u).
    pub fn poisson_ratio(&self) -> f64 {
        self.poisson_ratio
    }

    /// Density ρ, kg/m³.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// Shear modulus G = E / (2 (1 + ν)), Pa.
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }
}
