//! The factors between the units that drives export.

use std::f64::consts::TAU;

use crate::mapping_error::MappingError;
use crate::unit::unit_of;
use crate::unit_table::{COUNTS, PERCENT, Row, row};

/// Channel units per unit of the source: what a column in `unit` is multiplied by to be
/// the channel, where its factor is `factor`.
///
/// A unit converts to that of the channel's suffix by definition: `"deg"` of a channel in
/// rad by π/180, `"rpm"` of one in rad/s by 2π/60, `"mm"` of one in m by 10⁻³. `"counts"`
/// and `"counts/s"` are of an encoder with `counts_per_turn` counts a turn. `"%"` is a
/// share of a full scale: 0.01 times `factor`, which must then be the channel's value at
/// 100 % unless the channel is without dimension (`_1`). The result is the definition's
/// value times `factor`, rounded twice at most.
///
/// # Errors
/// [`MappingError::Unit`], [`MappingError::UnitDimension`],
/// [`MappingError::CountsPerTurn`], [`MappingError::FullScale`], or
/// [`MappingError::UnitSuffix`].
pub(crate) fn scale_of(
    source: &str,
    channel: &str,
    unit: &str,
    counts_per_turn: Option<f64>,
    factor: Option<f64>,
) -> Result<f64, MappingError> {
    let target = channel_row(source, channel)?;
    let k = factor.unwrap_or(1.0);
    let dimension = |dimension: &str, size: f64| match target {
        Some((_, of, own)) if *of == dimension => Ok(size / own * k),
        _ => Err(MappingError::UnitDimension {
            channel: channel.to_owned(),
            unit: unit.to_owned(),
        }),
    };
    if unit == PERCENT {
        let number = target.is_some_and(|(_, of, _)| *of == "number");
        return match factor.is_some() || number {
            true => Ok(0.01 * k),
            false => Err(MappingError::FullScale {
                channel: channel.to_owned(),
            }),
        };
    }
    if let Some((_, of)) = COUNTS.iter().find(|(name, _)| *name == unit) {
        let counts = counts_per_turn.filter(|c| c.is_finite() && *c > 0.0);
        let counts = counts.ok_or_else(|| MappingError::CountsPerTurn {
            channel: channel.to_owned(),
        })?;
        return dimension(of, TAU / counts);
    }
    match row(unit) {
        Some((_, of, size)) => dimension(of, *size),
        None => Err(MappingError::Unit {
            channel: channel.to_owned(),
            unit: unit.to_owned(),
        }),
    }
}

fn channel_row(source: &str, channel: &str) -> Result<Option<&'static Row>, MappingError> {
    let symbol = unit_of(channel).ok_or_else(|| MappingError::UnitSuffix {
        channel: channel.to_owned(),
        column: source.to_owned(),
    })?;
    Ok(row(symbol))
}
