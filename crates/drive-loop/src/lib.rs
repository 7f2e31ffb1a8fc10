//! Margins of a drive's loops, and gains that have them.
//!
//! # The problem
//! A drive's position controller stands over a speed controller, both sampled, on a machine that
//! is elastic. How far are the two loops from instability, wherever the load is, with other masses,
//! with the load sliding or held by its friction, with a cycle more of delay? And which gains hold
//! the load best against forces at margins that hold over all of that?
//!
//! # What is here
//! - [`LoopAnalysis`]: the linear loop at its own rates, with filters and delays: sensitivity at the
//!   command and at the position, gain, phase and delay margins, bandwidths, compliance at the load,
//!   eigenvalues; in each [`Corner`] of a [`LoopSet`], with curves for Bode's and Nyquist's plots.
//! - [`Tuning`]: gains of an axis under limits of the sensitivity over a set, checked by simulation,
//!   with what limits them and what would help.
//! - [`MeasuredDrive`]: frequency responses of the axis from its log, with deviations, modes and
//!   margins, against the model; [`LoopSet::with_measured`] tunes on them.
//!
//! The equations and where they are from are in docs/theory/drive-loop.md.
//!
//! # Example
//! The paper's axis, as printed: its maximum sensitivity at the position of its trajectories.
//!
//! ```
//! use axis_sim::Axis;
//! use drive_loop::{LoopAnalysis, LoopSet};
//!
//! let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
//! let axis = Axis::read(file.as_ref())?;
//! let found = LoopAnalysis::of(&axis, &LoopSet { positions: vec![0.6], ..LoopSet::nominal() })?;
//! let own = found.own();
//! assert!(own.stable);
//! assert!(own.command.sensitivity.unwrap() < 1.6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What this crate knows nothing of
//! Files, options, terminals, pages; how a response is estimated from samples (`frequency-response` does).

mod analysis;
mod error;
mod gains;
mod helps;
mod keys;
mod law;
mod linear;
mod loops;
mod margins;
mod measured;
mod measured_plant;
mod moves;
mod plant;
mod quick_current;
mod report;
mod search;
mod set;
mod tune;
mod tune_settings;
mod tuned_gains;
mod tuning;
mod turn;

pub use analysis::{LoopAnalysis, LoopCurves, WorstMargins};
pub use error::LoopError;
pub use helps::Help;
pub use keys::TunedKey;
pub use margins::{CornerMargins, CutMargins};
pub use measured::{
    ComparedMode, Comparison, ComplianceLine, MeasureSettings, MeasuredCompliance, MeasuredDrive,
    MeasuredLine, MeasuredMargins, MeasuredMode, MeasuredModes, MeasuredPlant, MeasuredShape, Trap,
    WithDeviation,
};
pub use moves::{MoveFigures, moves};
pub use plant::Corner;
pub use set::{LoopSet, MASSES};
pub use tune::{Tuned, with_acceleration};
pub use tune_settings::TuneSettings;
pub use tuned_gains::{LoopFigures, TunedGains};
pub use tuning::{Limiting, MoveCheck, Tuning};
