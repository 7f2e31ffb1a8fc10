//! Shapes of sections by their dimensions, which a taper interpolates.

use std::f64::consts::PI;

use crate::error::{not_negative, positive};
use crate::{BeamError, CrossSection, Material, SectionProperties};

/// The outline of a section by its dimensions in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum SectionShape {
    /// A circle, with a concentric hole unless `inner` is 0.
    Circle {
        /// Outer diameter, m.
        outer: f64,
        /// Diameter of the hole, m; 0 for a solid shaft.
        inner: f64,
    },
    /// A solid rectangle.
    Rectangle {
        /// Side along y, m.
        height: f64,
        /// Side along z, m.
        width: f64,
    },
}

impl SectionShape {
    /// A solid circle of `diameter` metres.
    pub fn solid(diameter: f64) -> Self {
        Self::Circle {
            outer: diameter,
            inner: 0.0,
        }
    }

    /// The section of this shape: area, second moments, torsion constant, and
    /// Cowper's shear coefficients with the material's Poisson's ratio.
    ///
    /// # Errors
    /// As [`CrossSection::hollow_circle`] and [`CrossSection::rectangle`].
    pub fn section(&self, material: &Material) -> Result<CrossSection, BeamError> {
        match *self {
            Self::Circle { outer, inner } => CrossSection::hollow_circle(outer, inner, material),
            Self::Rectangle { height, width } => CrossSection::rectangle(height, width, material),
        }
    }

    /// The shape at `share` (0 to 1) of the distance to `end`, every dimension
    /// linear between the two.
    ///
    /// # Errors
    /// [`BeamError::Taper`] for shapes of different kinds.
    pub fn between(&self, end: &Self, share: f64) -> Result<Self, BeamError> {
        let mix = |a: f64, b: f64| a + (b - a) * share;
        match (*self, *end) {
            (
                Self::Circle { outer, inner },
                Self::Circle {
                    outer: end_outer,
                    inner: end_inner,
                },
            ) => Ok(Self::Circle {
                outer: mix(outer, end_outer),
                inner: mix(inner, end_inner),
            }),
            (
                Self::Rectangle { height, width },
                Self::Rectangle {
                    height: end_height,
                    width: end_width,
                },
            ) => Ok(Self::Rectangle {
                height: mix(height, end_height),
                width: mix(width, end_width),
            }),
            (from, to) => Err(BeamError::Taper {
                from: from.kind(),
                to: to.kind(),
            }),
        }
    }

    fn kind(&self) -> &'static str {
        match self {
            Self::Circle { .. } => "circle",
            Self::Rectangle { .. } => "rectangle",
        }
    }
}

/// Outer and inner diameter of a circle with a concentric hole.
pub(crate) fn ring(outer: f64, inner: f64) -> Result<[f64; 2], BeamError> {
    let d = positive("outer", outer)?;
    let hole = not_negative("inner", inner)?;
    match hole < d {
        true => Ok([d, hole]),
        false => Err(BeamError::Parameter {
            field: "inner",
            value: inner,
            valid: "at least zero and below the outer diameter",
        }),
    }
}

impl CrossSection {
    /// Circle of diameter `outer` with a concentric hole of diameter `inner`
    /// (m; 0 for none). With m = inner/outer, Cowper 1966 (doi 10.1115/1.3625046):
    /// κ = 6(1+ν)(1+m²)² / ((7+6ν)(1+m²)² + (20+12ν)m²).
    ///
    /// # Errors
    /// [`BeamError::Parameter`] unless 0 ≤ inner < outer, both finite.
    pub fn hollow_circle(outer: f64, inner: f64, material: &Material) -> Result<Self, BeamError> {
        let [d, hole] = ring(outer, inner)?;
        let (d2, h2) = (d * d, hole * hole);
        // Differences of squares as products: a thin wall keeps its digits.
        let area = 0.25 * PI * (d - hole) * (d + hole);
        let i = area * (d2 + h2) / 16.0;
        let nu = material.poisson_ratio();
        let m2 = h2 / d2;
        let square = (1.0 + m2) * (1.0 + m2);
        let below = (7.0 + 6.0 * nu) * square + (20.0 + 12.0 * nu) * m2;
        Self::new(area, i, i, 2.0 * i, 6.0 * (1.0 + nu) * square / below)
    }

    /// Solid rectangle, `height` along y and `width` along z (m). Both planes have
    /// Cowper's κ = 10(1+ν)/(12+11ν) (1966, doi 10.1115/1.3625046); J is
    /// Saint-Venant's series: J = a b³/3 (1 − 192/π⁵ · b/a · Σ tanh(nπa/2b)/n⁵),
    /// n = 1, 3, 5, …, a ≥ b the sides.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] unless both sides are finite and above zero.
    pub fn rectangle(height: f64, width: f64, material: &Material) -> Result<Self, BeamError> {
        let (h, w) = (positive("height", height)?, positive("width", width)?);
        let (a, b) = (h.max(w), h.min(w));
        let term = |n: f64| (0.5 * n * PI * a / b).tanh() / n.powi(5);
        // The terms fall with n⁻⁵: beyond n = 1001 they are below rounding.
        let sum: f64 = (0..=500).rev().map(|k| term(f64::from(2 * k + 1))).sum();
        let torsion = a * b.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * b / a * sum);
        let nu = material.poisson_ratio();
        let kappa = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
        Self::general(SectionProperties {
            area: h * w,
            second_moment_y: h * w.powi(3) / 12.0,
            second_moment_z: w * h.powi(3) / 12.0,
            torsion_constant: torsion,
            shear_coefficient_y: kappa,
            shear_coefficient_z: kappa,
        })
    }
}
