//! What a shaft carries and what carries it: masses, bearings, damping, unbalance.

use std::f64::consts::PI;

use crate::error::{finite, not_negative, positive};
use crate::shape::ring;
use crate::{BeamError, Material};

/// A rigid body on a node: a disc, a pulley, a pedestal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LumpedMass {
    /// Mass, kg.
    pub mass: f64,
    /// Moment of inertia about the shaft's axis x, kg·m²; on a node of the shaft it
    /// gives the gyroscopic moment.
    pub polar_inertia: f64,
    /// Moment of inertia about y and about z through the node, kg·m².
    pub diametral_inertia: f64,
}

impl LumpedMass {
    /// A mass without moments of inertia.
    pub fn point(mass: f64) -> Self {
        Self {
            mass,
            polar_inertia: 0.0,
            diametral_inertia: 0.0,
        }
    }

    /// A disc of `diameters` [outer, inner] and `width` metres, its middle on the
    /// node: J_p = m(D² + d²)/8, J_d = J_p/2 + m w²/12.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] unless 0 ≤ inner < outer and width > 0, all finite.
    pub fn disc(diameters: [f64; 2], width: f64, material: &Material) -> Result<Self, BeamError> {
        let [outer, inner] = diameters;
        let [d, hole] = ring(outer, inner)?;
        let w = positive("width", width)?;
        let mass = material.density() * 0.25 * PI * (d - hole) * (d + hole) * w;
        let polar_inertia = mass * (d * d + hole * hole) / 8.0;
        Ok(Self {
            mass,
            polar_inertia,
            diametral_inertia: 0.5 * polar_inertia + mass * w * w / 12.0,
        })
    }

    pub(crate) fn check(&self) -> Result<(), BeamError> {
        not_negative("mass", self.mass)?;
        not_negative("polar_inertia", self.polar_inertia)?;
        not_negative("diametral_inertia", self.diametral_inertia)?;
        Ok(())
    }
}

/// A linear bearing or seal: the force on the shaft is −K (v, w) − C (v̇, ẇ), rows and
/// columns y, z. Off-diagonal terms need not be symmetric, and any sign is allowed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Bearing {
    /// Stiffness [[k_yy, k_yz], [k_zy, k_zz]], N/m.
    pub stiffness: [[f64; 2]; 2],
    /// Damping [[c_yy, c_yz], [c_zy, c_zz]], N·s/m.
    pub damping: [[f64; 2]; 2],
}

impl Bearing {
    /// The same `stiffness` (N/m) and `damping` (N·s/m) along y and z, no cross terms.
    pub fn isotropic(stiffness: f64, damping: f64) -> Self {
        Self::orthotropic([stiffness, stiffness], [damping, damping])
    }

    /// `stiffness` (N/m) and `damping` (N·s/m) along [y, z], no cross terms.
    pub fn orthotropic(stiffness: [f64; 2], damping: [f64; 2]) -> Self {
        let diagonal = |[y, z]: [f64; 2]| [[y, 0.0], [0.0, z]];
        Self {
            stiffness: diagonal(stiffness),
            damping: diagonal(damping),
        }
    }

    pub(crate) fn check(&self) -> Result<(), BeamError> {
        for value in self.stiffness.iter().flatten() {
            finite("bearing stiffness", *value)?;
        }
        for value in self.damping.iter().flatten() {
            finite("bearing damping", *value)?;
        }
        Ok(())
    }
}

/// Damping of the structure, added to that of bearings and dampers. It does not turn
/// with the shaft: damping within the shaft, which drives forward whirl above a
/// critical speed, is [`crate::BeamModel::set_rotating_damping`].
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum Damping {
    /// None.
    #[default]
    None,
    /// C = α M + β K, K with its springs and the symmetric part of its bearings:
    /// ζ = α/(2ω) + βω/2 (Rayleigh 1877).
    Rayleigh {
        /// α, 1/s.
        alpha: f64,
        /// β, s.
        beta: f64,
    },
    /// C = M Φ diag(2 ζ ω) Φᵀ M: a damping ratio for each undamped mode at standstill,
    /// from the lowest; modes beyond the list have none.
    Modal(Vec<f64>),
}

impl Damping {
    /// Rayleigh damping with a ratio at each of two frequencies: `points` are
    /// (ω in rad/s, ζ). A ratio that the law cannot have without a negative
    /// coefficient is accepted; between the two points ζ is lower, outside higher.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for frequencies not finite and above zero or equal,
    /// and for ratios not finite and at least zero.
    pub fn rayleigh_at(points: [(f64, f64); 2]) -> Result<Self, BeamError> {
        let [(w1, z1), (w2, z2)] = points;
        positive("first frequency", w1)?;
        positive("second frequency", w2)?;
        not_negative("first damping ratio", z1)?;
        not_negative("second damping ratio", z2)?;
        if w1 == w2 {
            return Err(BeamError::Parameter {
                field: "second frequency",
                value: w2,
                valid: "other than the first",
            });
        }
        let beta = 2.0 * (z2 * w2 - z1 * w1) / ((w2 - w1) * (w2 + w1));
        let alpha = 2.0 * z1 * w1 - beta * w1 * w1;
        Ok(Self::Rayleigh { alpha, beta })
    }

    pub(crate) fn check(&self) -> Result<(), BeamError> {
        match self {
            Self::None => {}
            Self::Rayleigh { alpha, beta } => {
                finite("alpha", *alpha)?;
                finite("beta", *beta)?;
            }
            Self::Modal(ratios) => {
                for ratio in ratios {
                    not_negative("modal damping ratio", *ratio)?;
                }
            }
        }
        Ok(())
    }
}

/// A mass off the axis that turns with the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Unbalance {
    /// Node of the shaft.
    pub node: usize,
    /// Mass times eccentricity, kg·m.
    pub moment: f64,
    /// Angle ahead of the y axis at t = 0, rad, positive from y to z.
    pub phase: f64,
}
