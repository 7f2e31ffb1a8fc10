//! Dynamics of feed drives: what a motor torque makes of the load's motion.
//!
//! # The problem
//! A feed axis is a motor, a transmission that gives way, and a load (table,
//! carriage, joint) whose position may change the transmission's stiffness:
//!
//! ```text
//! motor torque T ──► motor, θ ──[ k(x), βk(x); offset, gap ]──► load, y ◄── load force
//! ```
//!
//! The motor torque and the force on the load come from the caller, who gets the
//! motion at the end of each step. Three drives, from the most detailed on:
//!
//! | drive | what gives way | steppers |
//! |---|---|---|
//! | [`FeedDrive`], a ball screw | couplings, the screw's torsion, the nut; with [`AxialSupport`] the screw's length and its bearings | [`ModalStepper`], [`ImplicitStepper`] |
//! | [`ElasticDrive`], two inertias | one [`Stiffness`]: a constant, [`BeltStrands`], [`ScrewShaft`], or several [`InSeries`] | [`ElasticStepper`] |
//! | [`RigidDrive`], one inertia, with a [`ForceCourse`] within a step | nothing | [`RigidStepper`] |
//!
//! All step through the trait [`TimeStepper`]; the force on the load may depend on
//! the load's motion at the end of the step (friction), for which [`find_load`]
//! searches. [`NutErrors`] adds an error of the kinematics and a gap.
//!
//! # The ball screw
//!
//! The drive of Liu et al. (Machines 2025, 13(5), 433,
//! doi:10.3390/machines13050433, Section 3.1) is a torsional chain with a
//! translating table:
//!
//! ```text
//! motor ──K_R1── torque sensor ──K_R2── screw nodes 0 … N      (rotations, rad)
//!                                          │ nut at x: k_n
//!                                        table                 (displacement, m)
//! ```
//!
//! With the generalised coordinates `q = [θ_motor, θ_sensor, θ_0 … θ_N, y]`,
//! `N + 4` of them, the motion obeys
//!
//! ```text
//! M(x) q̈ + C(x) q̇ + K(x) q = F,      C = β K,      x = x_0 + y
//! ```
//!
//! where `x` is the table position measured from the driven end. The screw's
//! part of `M` and `K` comes from [`beam_fem`]; the nut adds
//! `k_n b bᵀ` with `b = [… r n(x) …, −1]` and `r = lead / 2π`, that is the
//! paper's Eq. (4) with its lost signs restored. How the nut meets the mesh
//! is a choice, [`NutCoupling`]: through the element's shape functions, or on
//! a node that moves with it (the paper's).
//!
//! [`FeedDrive::receptance`], `mobility` and `accelerance` are its frequency response,
//! [`FeedDrive::state_space`] its linear state space at one position;
//! [`FeedDrive::left_handed`] turns the screw's hand round.
//!
//! # Two inertias
//!
//! `J θ̈ = T − r F`, `m ÿ = F − load`, with the force `F = k(x) δ + βk(x) δ̇` of the
//! compression `δ = r θ − y`: the resonance `√(k (1/m + r²/J))`, the antiresonance
//! seen from the motor `√(k/m)`.
//!
//! # Symbols and units
//! | symbol | what | unit |
//! |---|---|---|
//! | θ, T, J | angle, torque and inertia of the motor | rad, N·m, kg·m² |
//! | y, m, x | displacement of the load, its mass, its position from the driven end | m, kg, m |
//! | F, δ | force of the transmission, its compression | N, m |
//! | r | travel of the load per radian of the motor, lead / 2π of a screw | m/rad |
//! | k, β | stiffness; damping as a multiple of it (Rayleigh) | N/m, s |
//! | K_R1, K_R2, k_n | stiffness of the couplings and of the nut | N·m/rad, N·m/rad, N/m |
//! | M, C, K, q | mass, damping and stiffness matrix, coordinates | SI, rad and m |
//!
//! Where the load turns, read rad for m, N·m for N and kg·m² for kg of the load.
//!
//! # What it knows nothing of
//! Friction laws, motors, controllers, files.
//!
//! # Examples
//! Natural frequencies of a ball screw drive, with the table at 0.6 m:
//!
//! ```
//! use beam_fem::{CrossSection, Material};
//! use feed_dynamics::{DriveParameters, FeedDrive, NutCoupling};
//!
//! let steel = Material::new(206e9, 0.3, 7850.0)?;
//! let drive = FeedDrive::new(DriveParameters {
//!     section: CrossSection::solid_circle(0.040, &steel)?,
//!     material: steel,
//!     screw_length: 1.5,
//!     elements: 10,
//!     lead: 0.010,
//!     motor_inertia: 0.0053,
//!     sensor_inertia: 1e-4,
//!     motor_coupling_stiffness: 2800.0,
//!     screw_coupling_stiffness: 2800.0,
//!     table_mass: 515.0,
//!     nut_stiffness: 7.45e7,
//!     axial: None,
//!     stiffness_damping: 1e-5,
//! })?;
//! let modes = drive.modes(0.6, NutCoupling::ShapeFunctions)?;
//! assert_eq!(modes.frequencies_rad_s.len(), 14);
//! assert!(modes.frequencies_rad_s[0] < 1e-3); // the axis is free to move
//! println!("first elastic mode: {:.1} Hz", modes.frequencies_rad_s[1] / std::f64::consts::TAU);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A carriage on a toothed belt, whose strands change with its position:
//!
//! ```
//! use std::sync::Arc;
//! use feed_dynamics::{
//!     BeltStrands, ElasticDrive, ElasticDriveParameters, ElasticStepper, Settled, TimeStepper,
//! };
//!
//! let drive = ElasticDrive::new(ElasticDriveParameters {
//!     motor_inertia: 2e-4,
//!     load_inertia: 12.0,
//!     travel_per_radian: 0.02,
//!     stiffness: Arc::new(BeltStrands::new(3e5, 0.15, 1.2)?),
//!     stiffness_damping: 2e-5,
//! })?;
//! assert!(drive.resonance(0.0) > drive.resonance(0.45)); // both strands are equal there
//!
//! let stepper = ElasticStepper::new(&drive, 1e-4)?;
//! let mut state = stepper.settled(0.1, &Settled::default())?;
//! for _ in 0..100 {
//!     let report = stepper.step(&mut state, 2.0, |carriage| 60.0 * carriage.speed);
//!     assert!(report.load.converged);
//! }
//! assert!(stepper.observe(&state).speed > 0.0);
//! # Ok::<(), feed_dynamics::DriveError>(())
//! ```

mod axial;
mod drive;
mod elastic;
mod error;
mod matrices;
mod modes;
mod response;
mod rigid;
mod state_space;
mod stepper;
#[cfg(feature = "serde")]
mod stored;

pub use axial::{AxialSupport, Mounting, ScrewShaft};
pub use drive::{DriveParameters, FeedDrive};
pub use elastic::{
    BeltStrands, ElasticDrive, ElasticDriveParameters, ElasticState, ElasticStepper, InSeries,
    Side, Stiffness,
};
pub use error::DriveError;
pub use matrices::{DriveMatrices, NutCoupling};
pub use modes::DriveModes;
pub use response::Coordinate;
pub use rigid::{ForceCourse, RigidDrive, RigidState, RigidStepper};
pub use state_space::{Quantity, StateSpace};
pub use stepper::{
    ImplicitState, ImplicitStepper, LoadSearch, ModalState, ModalStepper, NutErrors, Observation,
    Settled, StepReport, TableMotion, TimeStepper, find_load,
};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
