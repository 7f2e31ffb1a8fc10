//! Why a replay fails, and how long it may be.

use axis_log::LogError;
use thiserror::Error;

use crate::balance_error::BalanceError;
use crate::work::MOST_STEPS;
use crate::{RunStopped, SetupError, SixDigits};

/// Most control cycles of a replay, which holds their samples in memory.
const MOST_CYCLES: f64 = 1e8;

/// Why a replay failed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// A channel that a replay needs is not in the log.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The axis cannot be set up.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The closed loop was given up.
    #[error(transparent)]
    Stopped(#[from] RunStopped),
    /// A log's torque balance cannot be made.
    #[error(transparent)]
    Balance(#[from] BalanceError),
    /// A sampling period that is none.
    #[error(
        "the sampling period of {period} s is not valid: it must be a finite number above zero"
    )]
    Period {
        /// As given, s.
        period: f64,
    },
    /// More than a replay can hold or step through.
    #[error(
        "the log's reference takes {} control cycles of {} internal steps, more than {} cycles or {} steps; give a part of it, or a longer control period or step",
        SixDigits(*.cycles), SixDigits(*.steps), SixDigits(MOST_CYCLES), SixDigits(MOST_STEPS)
    )]
    TooLong {
        /// Control cycles.
        cycles: f64,
        /// Internal steps of each.
        steps: f64,
    },
}

/// Refuses a replay without end before it begins.
pub(super) fn check_length(cycles: f64, steps: f64) -> Result<(), ReplayError> {
    if cycles <= MOST_CYCLES && cycles * steps <= MOST_STEPS {
        return Ok(());
    }
    Err(ReplayError::TooLong { cycles, steps })
}
