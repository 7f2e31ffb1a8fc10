//! Why a mapping cannot be used.

use thiserror::Error;

use crate::unit::suffix_list;
use crate::unit_table::source_units;

/// A mapping that cannot be used on any file.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MappingError {
    /// A channel name without a known unit.
    #[error(
        "channel \"{channel}\" (from \"{column}\") has no known unit suffix: end the name in \
         one of {}",
        suffix_list()
    )]
    UnitSuffix {
        /// Name of the channel.
        channel: String,
        /// Name of its source.
        column: String,
    },
    /// Two sources for one channel.
    #[error("channel \"{channel}\" has two sources: it must have one")]
    TwoSources {
        /// Name of the channel.
        channel: String,
    },
    /// A scale that is 0, NaN or infinite.
    #[error("channel \"{channel}\": scale is {value}: it must be finite and not 0")]
    Scale {
        /// Name of the channel.
        channel: String,
        /// The scale.
        value: f64,
    },
    /// An offset that is NaN or infinite.
    #[error("channel \"{channel}\": offset is {value}: it must be finite")]
    Offset {
        /// Name of the channel.
        channel: String,
        /// The offset.
        value: f64,
    },
    /// A delay that is NaN or infinite.
    #[error("channel \"{channel}\": delay is {value} s: it must be finite, and 0 for t_s")]
    Delay {
        /// Name of the channel.
        channel: String,
        /// The delay, s.
        value: f64,
    },
    /// A unit that is not known.
    #[error(
        "channel \"{channel}\": unit is \"{unit}\": it must be one of {}",
        source_units(channel)
    )]
    Unit {
        /// Name of the channel.
        channel: String,
        /// The unit given.
        unit: String,
    },
    /// A unit of another dimension than the channel's.
    #[error(
        "channel \"{channel}\" cannot be read from a column in {unit}: that is another \
         dimension; give one of {}, a factor without unit, or a channel of that dimension",
        source_units(channel)
    )]
    UnitDimension {
        /// Name of the channel.
        channel: String,
        /// The unit given.
        unit: String,
    },
    /// Counts without their number a turn, or that without counts.
    #[error(
        "channel \"{channel}\": unit = \"counts\" (or \"counts/s\") and counts_per_turn, \
         finite and above 0, go together"
    )]
    CountsPerTurn {
        /// Name of the channel.
        channel: String,
    },
    /// A share without the value at 100 %.
    #[error(
        "channel \"{channel}\": unit is \"%\": give as factor what 100 % is, in the unit of \
         the channel"
    )]
    FullScale {
        /// Name of the channel.
        channel: String,
    },
    /// A sample rate that is not a positive number.
    #[error("sample_rate_hz is {value}: it must be finite and above 0")]
    SampleRate {
        /// The rate, Hz.
        value: f64,
    },
}
