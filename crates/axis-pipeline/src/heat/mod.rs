//! An axis' heat beside its motions: a thermal model from slow logs, growth predicted from the reference, and
//! both corrections together.
//!
//! ```text
//! hours of logs ─ slow_log ─► GrowthLog ─ fit ─► thermal numbers ─┐
//! reference ──────────────────────────────────────────────────────┴─► growth, friction's factors ─► plan
//! ```

mod ahead;
mod channels;
mod explain;
mod follow;
mod identify;
mod readings;
mod slow_log;
mod warm_moves;

use axis_sim::SixDigits;
use thiserror::Error;

pub use ahead::HeatAhead;
pub use explain::{explain, is_slow};
pub use follow::{FollowOptions, FollowedRow, Following, follow};
pub use identify::{HeatFit, HeldOut, fit};
pub use slow_log::{SlowLog, SlowLogOptions, probe_of, zero_of};
pub use warm_moves::{DutyHeat, ModelHeat, WarmMoves, warm_axis};

/// Why a slow log or its model was refused.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum HeatError {
    /// The log lacks something, or a value of it makes no sense.
    #[error("the log {what}; valid: {valid}")]
    Log {
        /// What is wrong.
        what: String,
        /// What would be valid.
        valid: String,
    },
    /// An option makes no sense.
    #[error("{name} is {value}; valid: {valid}")]
    Option {
        /// Which one.
        name: &'static str,
        /// As given.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// Moves would begin before those of the time before have ended.
    #[error(
        "the moves take {} s, and those after {} s would begin before those after {} s have ended; valid: steps of that duration or more, from 0",
        SixDigits(*pass),
        SixDigits(*time),
        SixDigits(*before)
    )]
    PassesOverlap {
        /// The earlier time, s.
        before: f64,
        /// The time that comes too early, s.
        time: f64,
        /// Duration of the moves, s.
        pass: f64,
    },
    /// Growth is followed along a screw alone.
    #[error(
        "this axis has no screw, and growth is fitted and predicted for screws alone; valid: an axis with [mechanism] of kind ball-screw or screw-datasheet"
    )]
    NoScrew,
    /// The thermal model refused.
    #[error(transparent)]
    Thermal(#[from] axis_thermal::ThermalError),
    /// The axis' effects leave no valid friction.
    #[error(transparent)]
    Axis(#[from] axis_sim::PlanModelError),
}

impl HeatError {
    fn log(what: impl Into<String>, valid: impl Into<String>) -> Self {
        let (what, valid) = (what.into(), valid.into());
        Self::Log { what, valid }
    }
}
