//! Linear elastic, isotropic material.

use crate::BeamError;
use crate::error::positive;

/// A linear elastic, isotropic material. Made by [`Material::new`], which
/// checks it; fields are public to be read.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// Young's modulus E, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio ν, dimensionless (the paper's u).
    pub poisson_ratio: f64,
    /// Density ρ, kg/m³.
    pub density: f64,
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

    /// Shear modulus G = E / (2 (1 + ν)), Pa.
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }
}
