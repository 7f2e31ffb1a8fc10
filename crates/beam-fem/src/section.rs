//! Cross-section of a beam.

use std::f64::consts::PI;

use crate::error::positive;
use crate::{BeamError, Material};

/// A cross-section whose y and z axes are principal and pass through both the
/// centroid and the shear centre. Made by [`CrossSection::new`] or
/// [`CrossSection::solid_circle`], which check it, and immutable after that.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(try_from = "SectionProperties", into = "SectionProperties")
)]
pub struct CrossSection {
    area: f64,
    second_moment_y: f64,
    second_moment_z: f64,
    torsion_constant: f64,
    shear_coefficient: f64,
    shear_coefficient_z: f64,
}

/// The numbers of any section, for [`CrossSection::general`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SectionProperties {
    /// Area A, m².
    pub area: f64,
    /// Second moment of area about the y axis (bending in x–z), m⁴.
    pub second_moment_y: f64,
    /// Second moment of area about the z axis (bending in x–y), m⁴.
    pub second_moment_z: f64,
    /// Torsion constant J, m⁴.
    pub torsion_constant: f64,
    /// Shear coefficient κ of a force along y (bending in x–y).
    pub shear_coefficient_y: f64,
    /// Shear coefficient κ of a force along z (bending in x–z).
    pub shear_coefficient_z: f64,
}

impl CrossSection {
    /// Checks and makes a section from A (m²), I_y, I_z, J (m⁴) and κ, the
    /// same in both planes. [`CrossSection::general`] has one for each.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for whatever is not finite and above zero.
    pub fn new(
        area: f64,
        second_moment_y: f64,
        second_moment_z: f64,
        torsion_constant: f64,
        shear_coefficient: f64,
    ) -> Result<Self, BeamError> {
        Ok(Self {
            area: positive("area", area)?,
            second_moment_y: positive("second_moment_y", second_moment_y)?,
            second_moment_z: positive("second_moment_z", second_moment_z)?,
            torsion_constant: positive("torsion_constant", torsion_constant)?,
            shear_coefficient: positive("shear_coefficient", shear_coefficient)?,
            shear_coefficient_z: shear_coefficient,
        })
    }

    /// Checks and makes a section from all of its numbers, with a shear
    /// coefficient for each plane.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for whatever is not finite and above zero.
    pub fn general(properties: SectionProperties) -> Result<Self, BeamError> {
        let p = properties;
        Ok(Self {
            area: positive("area", p.area)?,
            second_moment_y: positive("second_moment_y", p.second_moment_y)?,
            second_moment_z: positive("second_moment_z", p.second_moment_z)?,
            torsion_constant: positive("torsion_constant", p.torsion_constant)?,
            shear_coefficient: positive("shear_coefficient_y", p.shear_coefficient_y)?,
            shear_coefficient_z: positive("shear_coefficient_z", p.shear_coefficient_z)?,
        })
    }

    /// Solid circle of `diameter` metres (paper, Appendix A): A = π (D/2)²,
    /// I_y = I_z = π D⁴ / 64, J = I_y + I_z and Cowper's
    /// κ = 6 (1 + ν) / (7 + 6 ν) (doi 10.1115/1.3625046).
    ///
    /// # Errors
    /// [`BeamError::Parameter`] unless the diameter is finite and above zero.
    pub fn solid_circle(diameter: f64, material: &Material) -> Result<Self, BeamError> {
        let d = positive("diameter", diameter)?;
        let i = PI * d.powi(4) / 64.0;
        let nu = material.poisson_ratio();
        let kappa = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu);
        Self::new(0.25 * PI * d * d, i, i, 2.0 * i, kappa)
    }

    /// Area A, m².
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Second moment of area I_y about the y axis (bending in x–z), m⁴.
    pub fn second_moment_y(&self) -> f64 {
        self.second_moment_y
    }

    /// Second moment of area I_z about the z axis (bending in x–y), m⁴.
    pub fn second_moment_z(&self) -> f64 {
        self.second_moment_z
    }

    /// Torsion constant J, m⁴: torque = G J × twist per length.
    pub fn torsion_constant(&self) -> f64 {
        self.torsion_constant
    }

    /// Shear coefficient κ (the paper's v), dimensionless: shear force =
    /// κ G A × shear angle. It is that of a force along y (bending in x–y);
    /// [`CrossSection::shear_coefficient_z`] has the other plane's.
    pub fn shear_coefficient(&self) -> f64 {
        self.shear_coefficient
    }

    /// Shear coefficient κ of a force along z (bending in x–z), dimensionless.
    pub fn shear_coefficient_z(&self) -> f64 {
        self.shear_coefficient_z
    }

    /// Polar second moment of area I_y + I_z, m⁴: what carries the rotary
    /// inertia about x. It equals J only where a section does not warp.
    pub fn polar_moment(&self) -> f64 {
        self.second_moment_y + self.second_moment_z
    }
}
