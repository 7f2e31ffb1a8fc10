//! Friction identified from logs of an axis, as the paper does it on its machine:
//! constant-speed runs, then a pre-sliding test (Section 3.2).
//!
//! [`identify_from_logs`] takes logs of any origin and finds by itself the stretches that
//! serve; what it knows of the machine is the axis file's inertia, transmission, torque
//! constant and loads, and of its friction nothing. [`identify`] makes such logs on a
//! simulated machine, whose sensors show what they show, and gives them to the same function.
//!
//! The formulas are in docs/theory/axis-pipeline.md, "Friction".

mod curve;
mod error;
mod experiment;
mod found;
mod from_logs;
mod plan;
mod presliding;
mod steady;
mod varying;

pub use error::IdentifyLogsError;
pub use experiment::{Session, identify};
pub use found::{FoundParameter, Identified, Open, ParameterSource, SmallMotion, SpeedRun};
pub use from_logs::identify_from_logs;
pub use plan::IdentificationPlan;
