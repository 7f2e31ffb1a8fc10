//! Why logs do not tell an axis' friction.

use axis_log::quality::SamplingError;
use axis_sim::BalanceError;
use lugre::identify::FrictionIdentifyError;
use thiserror::Error;

/// Why no friction was identified from logs.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum IdentifyLogsError {
    /// No logs.
    #[error("there are no logs; at least one of constant-speed runs is needed")]
    NoLogs,
    /// A log is not sampled evenly, or too slowly.
    #[error("{log}: {reason}")]
    Sampling {
        /// Which log.
        log: String,
        /// What is wrong.
        reason: SamplingError,
    },
    /// A log lacks a channel.
    #[error("{log}: {reason}")]
    Channels {
        /// Which log.
        log: String,
        /// What is missing.
        reason: BalanceError,
    },
    /// Too little in the logs moves at a speed that friction can be read at.
    #[error(
        "the logs show friction at {speeds} different speed(s) ({stretches} stretches of constant speed, {windows} short ones of slowly changing speed, {vibrating} left out for vibration or standstill); at least {needed} are needed, better ten from the slowest to the fastest, each in both directions and for a second or more after the torque has settled"
    )]
    TooFewSpeeds {
        /// Different speeds found.
        speeds: usize,
        /// Stretches of constant speed.
        stretches: usize,
        /// Short stretches in which the speed changes slowly.
        windows: usize,
        /// Stretches left out.
        vibrating: usize,
        /// The least number of different speeds.
        needed: usize,
    },
    /// The runs make no friction curve.
    #[error("the runs at constant speed make no friction curve: {0}")]
    Curve(FrictionIdentifyError),
    /// What was found is no friction law.
    #[error("what the logs show is no friction law: {0}")]
    Law(#[from] lugre::LugreError),
}
