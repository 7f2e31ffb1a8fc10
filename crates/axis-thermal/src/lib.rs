//! Heat of a feed axis: what its losses warm, how far it grows by that, and what its friction becomes.
//!
//! # The problem
//! Bodies of one temperature each (winding, motor housing, bearings, nut, table, bed, scale) and the
//! segments of a screw exchange heat with each other and the air. The nut moves along the screw and
//! brings its heat where it is. With capacities C, conductances K, the powers P of a duty that
//! repeats itself and the air's temperature T_a
//!
//! ```text
//! C Ṫ = −K T + P(T) + g T_a
//! screw segment i    ρcAΔx Ṡᵢ = ½ P_nut,i + kA/Δx (Sᵢ₋₁ − 2Sᵢ + Sᵢ₊₁) − h πDΔx (Sᵢ − T_a) + w_i G (T_nut − Sᵢ)
//! ```
//!
//! w_i is the share of time in which the nut is over segment i, `P_nut,i` the nut's mean loss there:
//! a duty is short beside the time in which temperatures change. P depends on T by the laws of
//! viscosity, preload and resistance ([`FrictionLaws`], [`WindingLoss`]).
//!
//! # What is here
//! - [`ThermalParameters`]: all numbers, with defaults that are assumed and say so.
//! - [`Duty`]: mean losses of a motion by place of the nut, from [`DutySample`]s, whoever makes them.
//! - [`ThermalModel`], [`AxisAtWork`]: the network under a duty; linear parts exact, steps as long as
//!   the losses allow. An hour takes some milliseconds, and no memory that grows with the time.
//! - [`Growth`], [`ThermalForce`]: by position, for a screw fixed at one end or both, for scale and bed.
//!
//! - [`GrowthPredictor`]: growth and friction while an axis works, from its reference alone, set right by a probe
//!   now and then.
//! - [`GrowthLog`], [`ThermalParameters::fit`]: a model from hours of logged growth.
//! - [`ThermalParameters::explain`]: whether growth and friction that falls with warmth explain such logs.
//!
//! # Units
//! SI, temperatures in °C. Of an axis that turns, torque and speed stand for force and speed.
//!
//! # Example
//! The screw of the paper's axis, whose nut goes to and fro at 200 mm/s and 10 mm lead:
//!
//! ```
//! use axis_thermal::{DutySample, HeatNode, ThermalModel, ThermalParameters};
//!
//! let model = ThermalModel::new(ThermalParameters::default())?;
//! let mut duty = model.duty();
//! for k in 0..500 {
//!     duty.push(&DutySample {
//!         duration: 0.005,
//!         position: 0.45 + 0.001 * f64::from(k), // m
//!         screw_speed: 125.7,                    // rad/s
//!         dry_power: 85.0,                       // W
//!         viscous_power: 471.0,
//!         ..DutySample::default()
//!     });
//! }
//! duty.push(&DutySample { duration: 1.5, position: 0.95, ..DutySample::default() });
//!
//! let cold = model.at_rest(20.0);
//! let mut warm = cold.clone();
//! model.under(&duty)?.run(&mut warm, 20.0, 3600.0)?;
//! assert!(warm.of(HeatNode::Nut) > 28.0);
//! let growth = model.growth(&cold, &warm, 0.95);
//! assert!(growth.screw > 80e-6 && growth.scale < 5e-6); // m
//! # Ok::<(), axis_thermal::ThermalError>(())
//! ```
//!
//! # What this crate knows nothing of
//! Axes, mechanisms and files; how losses come about; reports.

mod check;
mod defaults;
mod duty;
mod error;
mod explained;
mod friction;
mod growth;
mod growth_log;
mod heat_effects;
mod identify;
mod least_squares;
mod model;
mod network;
mod parameters;
mod predict;
mod residual_noise;
mod rival_drift;
mod run;
mod screw;
mod state;
mod unknown;
mod work;

pub use duty::{Duty, DutySample};
pub use error::ThermalError;
pub use explained::{HeatEffect, HeatEstimate, HeatExplained, HeatGap, HeatResidual};
pub use friction::{FrictionLaws, TemperatureLaw};
pub use growth::{Growth, ThermalForce};
pub use growth_log::{
    FollowedFriction, FollowedGrowth, FollowedLog, GrowthLog, GrowthOf, GrowthStretch, GrowthZero,
    GrowthZeros,
};
pub use heat_effects::HeldLog;
pub use identify::{FittedGrowth, GrowthFit};
pub use model::ThermalModel;
pub use parameters::{
    Expansions, FrictionShares, HeatShares, ThermalBodies, ThermalBody, ThermalLinks,
    ThermalParameters, WindingLoss,
};
pub use predict::GrowthPredictor;
pub use rival_drift::{DriftOver, RivalDrift};
pub use run::{ThermalAccuracy, ThermalWork};
pub use screw::{ScrewAir, ScrewEnds, ThermalScrew};
pub use state::{HeatNode, ThermalState};
pub use unknown::ThermalUnknown;
pub use work::{AxisAtWork, HeatLosses};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
