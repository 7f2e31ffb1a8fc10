//! Parameters: the numbers of the axis file's parts, by table and key.

use std::borrow::Cow;

use axis_sim::part::Key;
use axis_sim::{Axis, Registry, TABLES_WITHOUT_PARTS};
use toml_edit::{DocumentMut, Item, TableLike, Value};

use crate::error::UnitError;

/// Of `[control]`, what the unit's step is made of.
const STEP: &str = "frequency";

/// A number of the axis file.
pub(crate) struct Parameter {
    pub table: String,
    pub key: String,
    /// In the key's unit, as the file has it.
    pub value: f64,
    /// The unit that ends the key; empty if it has none.
    pub unit: &'static str,
    /// What is valid, in words.
    pub valid: String,
    /// Least and greatest value, in the key's unit.
    pub limits: Option<[f64; 2]>,
}

/// The numbers of all parts that stand in tables of their own, in the order of the file.
///
/// # Errors
/// As [`Axis::parse`].
pub(crate) fn parameters(name: &str, text: &str) -> Result<Vec<Parameter>, UnitError> {
    let keys = Registry::default().keys(name, text)?;
    let document = document(text)?;
    let mut all = Vec::new();
    for (table, item) in document
        .iter()
        .filter(|(table, _)| !TABLES_WITHOUT_PARTS.contains(table))
    {
        let keys = keys.iter().find(|key| key.name() == table);
        let Some((keys, item)) = keys.zip(item.as_table_like()) else {
            continue;
        };
        all.extend(of_table(table, item, keys.keys()));
    }
    Ok(all)
}

fn of_table(table: &str, item: &dyn TableLike, keys: &[Key]) -> Vec<Parameter> {
    let numbers = item.iter().filter_map(|(spelling, item)| {
        let value = item.as_float().or(item.as_integer().map(|i| i as f64))?;
        let spelled = |key: &&Key| key.is_number() && key.spellings().iter().any(|s| s == spelling);
        let key = keys.iter().find(spelled)?;
        if (table, key.name()) == ("control", STEP) {
            return None;
        }
        let end = spelling.strip_prefix(key.name())?.trim_start_matches('_');
        let unit = key.units().iter().find(|(unit, _)| *unit == end).copied();
        Some(Parameter {
            table: table.to_owned(),
            key: spelling.to_owned(),
            value,
            unit: unit.map_or("", |(unit, _)| unit),
            valid: key.valid(unit),
            limits: limits(key, unit.map_or(1.0, |(_, factor)| factor), value),
        })
    });
    numbers.collect()
}

/// The key's limits in a unit of `factor` SI units. The file's value was taken, so where it is at a
/// limit, the limit is that value and not one that rounding has moved.
fn limits(key: &Key, factor: f64, value: f64) -> Option<[f64; 2]> {
    let [least, most] = key.limits()?.map(|limit| limit / factor);
    let limits = [least.min(value), most.max(value)];
    limits
        .iter()
        .all(|limit| limit.is_finite())
        .then_some(limits)
}

/// Where a parameter stands.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place<'a> {
    /// In the axis file of a drive.
    Drive {
        /// Which drive of the unit, from 0.
        drive: usize,
        table: &'a str,
        key: &'a str,
    },
    /// Among the numbers of the machine file.
    Machine(usize),
}

/// A parameter that is not as its file has it, and its number, in its unit.
pub(crate) type Changed<'a> = (Place<'a>, f64);

/// The axis of `text` with those parameters that stand in it.
///
/// # Errors
/// As [`Axis::parse`]: the words of the axis file's checks.
pub(crate) fn changed<'a>(
    axis: &'a Axis,
    name: &str,
    text: &str,
    changed: &[Changed<'_>],
) -> Result<Cow<'a, Axis>, UnitError> {
    if changed.is_empty() {
        return Ok(Cow::Borrowed(axis));
    }
    let mut document = document(text)?;
    for (place, number) in changed {
        let Place::Drive { table, key, .. } = place else {
            continue;
        };
        let table = document.get_mut(table).and_then(Item::as_table_like_mut);
        if let Some(item) = table.and_then(|table| table.get_mut(key)) {
            *item = Item::Value(Value::from(*number));
        }
    }
    Ok(Cow::Owned(Axis::parse(name, &document.to_string())?))
}

fn document(text: &str) -> Result<DocumentMut, UnitError> {
    let read = text.parse::<DocumentMut>();
    read.map_err(|error| UnitError::Text(error.to_string()))
}
