//! Which columns of a table become which channels.

use std::f64::consts::SQRT_2;

use crate::import::{is_rms, stated_unit};
use crate::log::TIME_CHANNEL;
use crate::mapping::{ColumnMap, Mapping};
use crate::read_error::ReadProblem;
use crate::table::{Head, OtherUnit, Table};
use crate::unit::unit_of;
use crate::unit_table::{known, size_of};

/// A column that becomes a channel.
pub(crate) struct Pick {
    /// Index of the column.
    pub column: usize,
    /// Name, scale and offset.
    pub map: ColumnMap,
    /// Whether someone asked for it by name; otherwise it is left out if it
    /// does not fit.
    pub asked: bool,
}

/// The mapped columns in the mapping's order, then those with a unit in the
/// file's order.
pub(crate) fn select(
    table: &impl Table,
    mapping: &Mapping,
    required: &[&str],
) -> Result<Vec<Pick>, ReadProblem> {
    let heads = table.heads();
    let mut picks = Vec::new();
    for map in &mapping.columns {
        if let Some(column) = find(heads, &map.source)? {
            picks.push(Pick {
                column,
                map: in_its_unit(map.clone(), &heads[column]),
                asked: true,
            });
        }
    }
    for (index, head) in heads.iter().enumerate() {
        let source = mapping.columns.iter().any(|m| m.source == head.name);
        let taken = picks.iter().any(|p| p.asked && p.map.channel == head.name);
        if source || taken || unit_of(&head.name).is_none() {
            continue;
        }
        let asked = head.name == TIME_CHANNEL || required.contains(&head.name.as_str());
        find(heads, &head.name)?;
        if asked || head.fault.is_none() {
            agrees(head)?;
            picks.push(Pick {
                column: index,
                map: in_its_unit(own(&head.name), head),
                asked,
            });
        }
    }
    check_required(table, mapping, required, &picks)?;
    check_readable(heads, &picks)?;
    Ok(picks)
}

fn own(name: &str) -> ColumnMap {
    ColumnMap {
        source: name.to_owned(),
        channel: name.to_owned(),
        scale: 1.0,
        is_scale_stated: false,
        // Adding −0 keeps every bit, the sign of a zero too.
        offset: -0.0,
        delay: 0.0,
    }
}

/// The mapping of a column whose file states its unit, by its type, beside its name or in it: where no
/// scale is stated it is that unit's, if that is of the channel's dimension.
pub(crate) fn in_its_unit(mut map: ColumnMap, head: &Head) -> ColumnMap {
    if map.is_scale_stated {
        return map;
    }
    if let Some((_, scale)) = scale_of_file(&map.channel, head) {
        map.scale = scale;
    }
    map
}

/// The unit that the file states for a column, and how many of the channel's one is; `None` if it states
/// none, or one of another dimension.
fn scale_of_file<'a>(channel: &str, head: &'a Head) -> Option<(&'a str, f64)> {
    let of = |unit: &str| Some((known(unit)?.1, size_of(unit)?));
    let stored = head.stored.filter(|unit| of(unit).is_some());
    let stated = || head.unit.as_deref().or_else(|| stated_unit(&head.name));
    let unit = stored.or_else(stated)?;
    let (dimension, own) = of(unit_of(channel)?)?;
    let (of_file, size) = of(unit)?;
    (dimension == of_file).then_some((unit, size / own))
}

/// What to say of a column whose mapping states another scale than the unit that the file states has,
/// whatever the sign.
pub(crate) fn other_unit(map: &ColumnMap, head: &Head) -> Option<OtherUnit> {
    let (unit, scale) = scale_of_file(&map.channel, head).filter(|_| map.is_scale_stated)?;
    // A channel of current is √2 times the RMS value that such a column has.
    let (unit, scale) = match unit_of(&map.channel) == Some("A") && is_rms(head) {
        true => (format!("{unit} RMS"), scale * SQRT_2),
        false => (unit.to_owned(), scale),
    };
    let differs = (map.scale.abs() / scale - 1.0).abs() > SAME_SCALE;
    differs.then(|| OtherUnit {
        column: head.name.clone(),
        channel: map.channel.clone(),
        unit,
        scales: [scale, map.scale],
    })
}

/// Share of a scale by which a factor that was written with a few digits is off.
const SAME_SCALE: f64 = 1e-3;

/// Refuses a column whose name says another unit than the line below the names.
fn agrees(head: &Head) -> Result<(), ReadProblem> {
    let (Some(said), Some(named)) = (head.unit.as_deref(), unit_of(&head.name)) else {
        return Ok(());
    };
    let of = |unit: &str| Some((known(unit)?.1, size_of(unit)?));
    match of(said).zip(of(named)) {
        Some((said_is, named_is)) if head.stored.is_none() && said_is != named_is => {
            Err(ReadProblem::TwoUnits {
                name: head.name.clone(),
                said: said.to_owned(),
                named,
            })
        }
        _ => Ok(()),
    }
}

/// The only column of that name.
fn find(heads: &[Head], name: &str) -> Result<Option<usize>, ReadProblem> {
    let mut found = heads.iter().enumerate().filter(|(_, h)| h.name == name);
    match (found.next(), found.next()) {
        (Some((first, _)), Some((second, _))) => Err(ReadProblem::DuplicateColumn {
            name: name.to_owned(),
            first: first + 1,
            second: second + 1,
        }),
        (first, _) => Ok(first.map(|(index, _)| index)),
    }
}

fn check_required(
    table: &impl Table,
    mapping: &Mapping,
    required: &[&str],
    picks: &[Pick],
) -> Result<(), ReadProblem> {
    let has = |channel: &str| picks.iter().any(|p| p.map.channel == channel);
    for &channel in required {
        // The time may come from the rate.
        if has(channel) || channel == TIME_CHANNEL {
            continue;
        }
        let map = mapping.columns.iter().find(|m| m.channel == channel);
        return Err(ReadProblem::MissingColumn {
            channel: channel.to_owned(),
            column: map.map_or(channel, |m| m.source.as_str()).to_owned(),
            available: table.names(),
            unreadable: table.unreadable(),
        });
    }
    if !has(TIME_CHANNEL) && mapping.sample_rate_hz.is_none() {
        return Err(ReadProblem::NoTime {
            available: table.names(),
            unreadable: table.unreadable(),
        });
    }
    Ok(())
}

fn check_readable(heads: &[Head], picks: &[Pick]) -> Result<(), ReadProblem> {
    for pick in picks {
        let head = &heads[pick.column];
        if let Some(fault) = &head.fault {
            return Err(ReadProblem::Unreadable {
                name: head.name.clone(),
                found: fault.found.clone(),
                valid: fault.valid,
            });
        }
    }
    Ok(())
}
