//! Why a controller cannot be estimated.

use axis_log::LogError;
use axis_sim::ReplayError;
use axis_sim::part::PartError;
use thiserror::Error;

/// Why a controller cannot be estimated.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ControllerError {
    /// A channel that is needed is not in a log.
    #[error("{file}: {reason}")]
    Log {
        /// The log.
        file: String,
        /// What is missing.
        reason: LogError,
    },
    /// A log cannot be followed.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A control refuses its values.
    #[error(transparent)]
    Part(#[from] PartError),
    /// A log shows no command of the actuator.
    #[error(
        "{file}: no channel {channel}, the controller's command; valid: a log of it, or a [[log.column]] that makes it"
    )]
    NoCommand {
        /// The log.
        file: String,
        /// The channel that the axis' actuator asks for.
        channel: &'static str,
    },
    /// No structure could be fitted.
    #[error(
        "no control (p-pi, p-p, pid) gives the logged command; valid: logs of motion, with the command that the controller gave in them"
    )]
    NoneFits,
}
