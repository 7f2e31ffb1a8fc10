//! How the columns of a file become channels.

use std::collections::HashSet;

use thiserror::Error;

use crate::unit::{suffix_list, unit_of};

/// One column of a file under another name, in another unit.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnMap {
    /// Name of the column, or of the MAT variable, exactly as in the file.
    pub source: String,
    /// Name of the channel that it becomes, ending in its unit
    /// ([`unit_of`](crate::unit_of)): `position_m`.
    pub channel: String,
    /// Channel units per unit of the file: 1e-3 for millimetres to metres.
    /// Finite and not 0; negative where the sign is reversed.
    pub scale: f64,
    /// What is added after scaling, in units of the channel. Finite.
    pub offset: f64,
}

impl ColumnMap {
    /// The channel's value, `scale · value + offset`.
    pub fn apply(&self, value: f64) -> f64 {
        self.scale * value + self.offset
    }
}

/// How a file is read: which columns are renamed and scaled, and the sample
/// rate where the file holds no time.
///
/// The default renames nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mapping {
    /// The columns that are renamed. One source may feed several channels; a
    /// channel has one source.
    pub columns: Vec<ColumnMap>,
    /// Sample rate in Hz, finite and above 0: the k-th sample, from 0, is at
    /// `k / rate` seconds. Used only where the file has no column for `t_s`.
    pub sample_rate_hz: Option<f64>,
}

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
    /// A sample rate that is not a positive number.
    #[error("sample_rate_hz is {value}: it must be finite and above 0")]
    SampleRate {
        /// The rate, Hz.
        value: f64,
    },
}

impl Mapping {
    /// Checks what can be checked without a file;
    /// [`read_log`](crate::read_log) does it too.
    ///
    /// # Errors
    /// The first [`MappingError`].
    pub fn check(&self) -> Result<(), MappingError> {
        if let Some(value) = self.sample_rate_hz
            && !(value.is_finite() && value > 0.0)
        {
            return Err(MappingError::SampleRate { value });
        }
        let mut seen = HashSet::new();
        for map in &self.columns {
            let channel = map.channel.clone();
            if unit_of(&channel).is_none() {
                let column = map.source.clone();
                return Err(MappingError::UnitSuffix { channel, column });
            }
            if !seen.insert(map.channel.as_str()) {
                return Err(MappingError::TwoSources { channel });
            }
            if !map.scale.is_finite() || map.scale == 0.0 {
                let value = map.scale;
                return Err(MappingError::Scale { channel, value });
            }
            if !map.offset.is_finite() {
                let value = map.offset;
                return Err(MappingError::Offset { channel, value });
            }
        }
        Ok(())
    }
}
