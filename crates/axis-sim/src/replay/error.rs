//! Why a replay fails, and how long it may be.

use axis_log::LogError;
use feed_dynamics::DriveError;
use thiserror::Error;

use crate::work::MOST_STEPS;
use crate::{RunStopped, SixDigits};

/// Most control cycles of a replay, which holds their samples in memory.
const MOST_CYCLES: f64 = 1e8;

/// Why a replay failed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// A channel that a replay needs is not in the log.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The mechanics cannot be set up.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// The closed loop was given up.
    #[error(transparent)]
    Stopped(#[from] RunStopped),
    /// No load goes with a rigid machine's motion at the end of a step.
    #[error(
        "the replay stopped at t = {} s because no friction goes with the motion at the end of a step: table at {} m, {} m/s",
        SixDigits(*.time), SixDigits(*.position), SixDigits(*.speed)
    )]
    LoadNotFound {
        /// When, s.
        time: f64,
        /// Table position then, m.
        position: f64,
        /// Table speed then, m/s.
        speed: f64,
    },
    /// A state is no longer a number.
    #[error("the replay diverged at t = {} s", SixDigits(*.time))]
    Diverged {
        /// When, s.
        time: f64,
    },
    /// The tracking error passed the limit of the axis file.
    #[error(
        "the replay was given up at t = {} s: the tracking error of {} mm is beyond {} mm, the following_error_limit_mm of the axis file's [control]",
        SixDigits(*.time), SixDigits(1e3 * .error), SixDigits(1e3 * .limit)
    )]
    FollowingError {
        /// When, s.
        time: f64,
        /// Tracking error then, m.
        error: f64,
        /// Its limit, m.
        limit: f64,
    },
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
