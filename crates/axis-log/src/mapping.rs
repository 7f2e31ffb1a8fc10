//! How the columns of a file become channels.

use std::collections::HashSet;

use crate::log::TIME_CHANNEL;
use crate::mapping_error::MappingError;
use crate::source_unit::scale_of;
use crate::unit::unit_of;

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
    /// Whether someone stated the scale, as a unit or a factor. Where nobody did, a unit that the
    /// file states beside the column counts.
    pub is_scale_stated: bool,
    /// What is added after scaling, in units of the channel. Finite.
    pub offset: f64,
    /// By how much the file shows the quantity late, s; negative where early. What
    /// stands at `t` in the file is the quantity's value at `t − delay`. Finite.
    /// [`read_log`](crate::read_log) refuses a delay, [`prepare`](crate::intake::prepare)
    /// takes it out.
    pub delay: f64,
}

/// How a column is written in a file, before its unit is resolved to a scale.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ColumnUnit<'a> {
    /// Name of the column's unit: `"mm"`, `"deg"`, `"counts"`, `"%"`, ….
    pub unit: Option<&'a str>,
    /// Encoder counts in a turn; finite and above 0. For `"counts"` and `"counts/s"`.
    pub counts_per_turn: Option<f64>,
    /// Factor on top of the unit's; negative where the sign is reversed. Of `"%"`, the
    /// channel's value at 100 %.
    pub factor: Option<f64>,
}

impl ColumnMap {
    /// A column in a unit of its own, without offset and delay.
    ///
    /// ```
    /// use axis_log::{ColumnMap, ColumnUnit};
    /// let unit = ColumnUnit { unit: Some("deg"), factor: Some(-1.0), ..Default::default() };
    /// let map = ColumnMap::in_unit("Phi", "motor_angle_rad", unit)?;
    /// assert_eq!(map.apply(180.0), -std::f64::consts::PI);
    /// # Ok::<(), axis_log::MappingError>(())
    /// ```
    ///
    /// # Errors
    /// A [`MappingError`]: a unit that is not known or of another dimension than the
    /// channel, counts without `counts_per_turn` (or that without counts), a share
    /// without full scale.
    pub fn in_unit(
        source: impl Into<String>,
        channel: impl Into<String>,
        unit: ColumnUnit<'_>,
    ) -> Result<Self, MappingError> {
        let (source, channel) = (source.into(), channel.into());
        let counts = unit.unit.is_some_and(|unit| unit.starts_with("counts"));
        if unit.counts_per_turn.is_some() && !counts {
            return Err(MappingError::CountsPerTurn { channel });
        }
        let scale = match unit.unit {
            None => unit.factor.unwrap_or(1.0),
            Some(name) => {
                let per_turn = unit.counts_per_turn;
                scale_of(&source, &channel, name, per_turn, unit.factor)?
            }
        };
        Ok(Self {
            source,
            channel,
            scale,
            is_scale_stated: unit.unit.is_some() || unit.factor.is_some(),
            offset: 0.0,
            delay: 0.0,
        })
    }

    /// The channel's value, `scale · value + offset`.
    pub fn apply(&self, value: f64) -> f64 {
        self.scale * value + self.offset
    }

    /// The column's value that [`apply`](Self::apply) makes this one of,
    /// `(value − offset) / scale`, but for rounding.
    pub fn invert(&self, value: f64) -> f64 {
        (value - self.offset) / self.scale
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
            if !map.delay.is_finite() || map.delay != 0.0 && channel == TIME_CHANNEL {
                let value = map.delay;
                return Err(MappingError::Delay { channel, value });
            }
        }
        Ok(())
    }
}
