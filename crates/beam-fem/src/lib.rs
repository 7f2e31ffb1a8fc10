//! Timoshenko beam finite elements for shafts, screws and rotors: element matrices,
//! assembly, natural modes, whirl, critical speeds, buckling, frequency response.
//!
//! # The problem
//! A straight beam along x, from the driven end x = 0 to x = L, stretches (u),
//! twists (θx), deflects (v, w) and turns (θy, θz). Bending in the x–y plane
//! obeys Timoshenko's equations
//!
//! ```text
//! ρA v̈  = κGA (v' − θz)'
//! ρI θ̈z = EI θz'' + κGA (v' − θz)
//! ```
//!
//! with rotary inertia and shear; the x–z plane likewise with θy = −w' − γ;
//! stretch and twist are rods. N elements with the exact static displacement
//! fields turn this into
//!
//! ```text
//! M q̈ + K q = F,     M, K: (6N + 6) × (6N + 6), symmetric, K singular (six rigid motions)
//! ```
//!
//! Row 6i + d of q is degree of freedom d of node i, in the order u, v, w, θx, θy, θz.
//!
//! # Symbols and units
//! | symbol | what | unit |
//! |---|---|---|
//! | x, L | position along the beam, its length | m |
//! | u, v, w | displacements along x, y, z | m |
//! | θx, θy, θz | rotations about x, y, z | rad |
//! | γ | shear angle | rad |
//! | ρ, E, G | density, Young's and shear modulus | kg/m³, Pa, Pa |
//! | A, I, κ | area, second moment of area, shear coefficient | m², m⁴, 1 |
//! | M, K | mass and stiffness matrix: rows of forces (N) and of moments (N·m) | SI |
//! | q, F | displacements and rotations of all nodes, loads on them | m and rad, N and N·m |
//!
//! # Source
//! The element is that of Appendix A of Liu, Guo, Liu and Niu, *Machines*
//! 2025, 13(5), 433 (doi 10.3390/machines13050433), its lost signs restored:
//! see [`element`] for the sources that it was checked against.
//!
//! # What is here
//! - [`Material`], [`CrossSection`], [`Mesh`] and [`MovingNode`] make a [`Beam`].
//! - [`Beam::assemble`] gives dense matrices, [`Beam::assemble_banded`] banded
//!   ones at a cost linear in N, [`Beam::torsion`] the twist part alone.
//! - [`natural_modes`] solves the dense pencil for all modes,
//!   [`lowest_modes`] the banded one for the lowest, linearly in N.
//! - [`BeamMatrices::fixed`] and [`BandedMatrices::fixed`] hold degrees of freedom.
//! - [`Beam::torsional_compliance_at`] and
//!   [`Beam::torsional_compliance_at_node`]: how far a nut twists the screw.
//!
//! # Example
//! The free bending frequencies of a steel screw, 40 mm × 1.5 m:
//!
//! ```
//! use beam_fem::{Beam, CrossSection, Material, Mesh, lowest_modes, natural_modes};
//!
//! let steel = Material::new(206e9, 0.3, 7850.0)?;
//! let round = CrossSection::solid_circle(0.040, &steel)?;
//! let screw = Beam::new(round, steel, Mesh::uniform(1.5, 10)?);
//!
//! let matrices = screw.assemble()?;
//! let all = natural_modes(&matrices.mass, &matrices.stiffness)?;
//! assert_eq!(all.frequencies_rad_s.len(), 66);
//! assert!(all.frequencies_rad_s[..6].iter().all(|&w| w == 0.0)); // rigid motions
//!
//! let some = lowest_modes(&screw.assemble_banded(), 8)?;
//! let first = some.frequencies_hz()[6]; // bending, in pairs
//! assert!((first - 80.7).abs() < 0.5);
//! # Ok::<(), beam_fem::BeamError>(())
//! ```
//!
//! Parts are checked where they are made and cannot be changed after that:
//!
//! ```compile_fail,E0616
//! let mut steel = beam_fem::Material::new(206e9, 0.3, 7850.0)?;
//! steel.density = -1.0;
//! # Ok::<(), beam_fem::BeamError>(())
//! ```
//!
//! # Rotors and machines
//! [`SectionShape`] and [`Span`] make a [`Shaft`], stepped or tapered; a [`BeamModel`] adds
//! masses, springs, bearings, constraints, damping and axial load and gives M, K, C, G
//! as [`SystemMatrices`]:
//! - [`WhirlAnalysis`]: damped eigenvalues at a spin speed with their direction,
//!   critical speeds, data of the Campbell diagram ([`campbell`] with bearings that
//!   depend on the speed);
//! - [`SystemMatrices::unbalance_response`], [`SystemMatrices::receptance`],
//!   [`SystemMatrices::steady_response`];
//! - [`SystemMatrices::natural_modes`] and [`SystemMatrices::buckling`] under axial
//!   load.
//!
//! # What this crate knows nothing of
//! Nuts, leads, motors and friction (the caller adds their springs and masses);
//! sections that are not axisymmetric on a shaft that spins (their coefficients would
//! vary in time); sections whose shear centre lies off the centroid; bearings that are
//! not linear; files.

mod banded;
mod beam;
mod buckling;
mod critical;
mod dense;
mod dof;
pub mod element;
mod error;
mod field;
mod material;
mod mesh;
mod model;
mod modes;
mod moving_node;
mod orbit;
mod parts;
mod pencil;
mod section;
mod shaft;
mod shape;
mod spacing;
#[cfg(feature = "serde")]
mod stored;
mod system;
mod torsion;
mod unbalance;
mod whirl;

pub use banded::{BandedMatrices, SymmetricBanded};
pub use beam::{Beam, BeamMatrices};
pub use buckling::Buckling;
pub use critical::{CriticalSpeed, campbell};
pub use dof::Dof;
pub use error::BeamError;
pub use material::Material;
pub use mesh::Mesh;
pub use model::BeamModel;
pub use modes::{Modes, natural_modes};
pub use moving_node::MovingNode;
pub use orbit::Orbit;
pub use parts::{Bearing, Damping, LumpedMass, Unbalance};
pub use pencil::lowest_modes;
pub use section::{CrossSection, SectionProperties};
pub use shaft::{Shaft, Span};
pub use shape::SectionShape;
pub use system::{Receptance, SystemMatrices};
pub use torsion::Tridiagonal;
pub use unbalance::UnbalanceResponse;
pub use whirl::{Whirl, WhirlAnalysis, WhirlMode, WhirlSpectrum};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
