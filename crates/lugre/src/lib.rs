//! Friction laws that stick, creep and slide: LuGre with its exact stiff step, and behind one
//! trait, [`FrictionLaw`], a family of others; with their identification from measurements.
//!
//! | law | type |
//! |---|---|
//! | LuGre, one level in both directions | [`LuGre`] |
//! | LuGre with levels by direction, any Stribeck exponent, viscous friction up to v³ | [`GeneralLuGre`] |
//! | Dahl | [`Dahl`] |
//! | elasto-plastic | [`ElastoPlastic`] |
//! | Bouc and Wen | [`BoucWen`] |
//! | generalised Maxwell slip | [`MaxwellSlip`] |
//! | Stribeck curve without memory | [`StaticFriction`] |
//!
//! All but the first take the same [`SteadyState`], and a normal load with each force. The
//! rest of this page is about LuGre.
//!
//! # The problem
//! Two surfaces touch through elastic bristles of mean deflection `z`. With
//! the sliding speed `ω`,
//!
//! ```text
//! dz/dt = ω − σ0 |ω| z / G(ω)                                (1)
//! G(ω)  = T_C + (T_S − T_C) exp(−(ω/Ω_S)²)                   (2)
//! T_f   = σ0 z + σ1 dz/dt + σ2 ω                             (3)
//! ```
//!
//! and at constant speed, where `dz/dt = 0` and `z = G sign ω / σ0`,
//!
//! ```text
//! T_ss(ω) = G(ω) sign ω + σ2 ω                               (4)
//! ```
//!
//! (C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky, "A new model
//! for control of systems with friction", IEEE Trans. Automatic Control 40(3),
//! 1995, doi 10.1109/9.376053.)
//!
//! # Symbols and units
//! | symbol | what | unit |
//! |---|---|---|
//! | ω | sliding speed, the one input | rad/s |
//! | z | mean deflection of the bristles, the one state | rad |
//! | T_f | friction, the one output; positive when it opposes positive ω | N·m |
//! | T_C, T_S | level at high speed (Coulomb), level at break-away (stiction) | N·m |
//! | Ω_S | Stribeck speed, at which the level has fallen by 63 % of T_S − T_C | rad/s |
//! | σ0, σ1 | stiffness and damping of the bristles | N·m/rad, N·m·s/rad |
//! | σ2 | viscous friction | N·m·s/rad |
//!
//! Read N for N·m, m for rad and m/s for rad/s and the same code describes a sliding contact: no
//! equation holds a conversion.
//!
//! # The step, and an example
//! Equation (1) is linear in `z`, with the time constant `G / (σ0 |ω|)`, which
//! is under a millisecond at traverse speed and infinite at rest.
//! [`LuGre::step`] is therefore an exponential integrator: exact for a constant
//! `ω` however long the step, second order for one that changes.
//!
//! ```
//! use lugre::{LuGre, Parameters};
//!
//! let law = LuGre::new(Parameters::LIU_2025)?;
//!
//! let speed = 10.0;
//! let mut z = 0.0; // the law is immutable: the state is the caller's
//! for _ in 0..2_000 {
//!     z = law.step(z, speed, speed, 1e-4);
//! }
//! assert!((law.torque(z, speed) - law.steady_state(speed)).abs() < 1e-12);
//! # Ok::<(), lugre::LugreError>(())
//! ```
//!
//! # Scalar
//! The law is generic over its scalar: `f64` where none is named, `f32` for a
//! controller without double precision in hardware. [`Exponential`] has what
//! the two need apart. Identification is in `f64`, and
//! [`Parameters::cast`] takes its result over.
//!
//! # Features
//! Without features the crate is `no_std` and allocates nothing. `identify`
//! (on by default, needs `std`) finds LuGre's six parameters and those of any law of the
//! family from records, see the module `identify`. `serde` reads and writes [`Parameters`]
//! and those of the family, plain data, and [`LuGre`], which is validated on the way in.
//!
//! # What this crate does not know
//! Nothing of machines, of where friction acts, of transmissions, control,
//! files or time stepping of the mass that slides. It keeps no state.

#![cfg_attr(not(feature = "std"), no_std)]

mod exponential;
mod family;
#[cfg(feature = "identify")]
pub mod identify;
mod law;
mod parameters;
mod passivity;
mod sliding;
mod step;

pub use exponential::{Decays, Exponential};
pub use family::{
    BoucWen, BoucWenOnset, Bristle, BristleParameters, ClassicBoucWen, Dahl, DahlOnset,
    ElastoPlastic, ElastoPlasticOnset, FrictionError, FrictionLaw, FrictionLevel, GeneralLuGre,
    LinearOnset, MaxwellSlip, MaxwellSlipParameters, MaxwellState, Onset, Regularisation,
    StaticFriction, StaticFrictionParameters, SteadyState,
};
pub use law::{Constants, LuGre};
pub use parameters::{LugreError, Parameters};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
