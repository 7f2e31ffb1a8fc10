//! Keys as properties.

use serde_json::{Map, Value, json};

use crate::part::{Key, Kind};
use crate::value_range::ValueRange;

/// Significant digits of a limit: the reader takes what is 1e-12 of it beyond, and a limit in
/// a unit should not end in the rounding of its conversion.
const DIGITS: usize = 13;

/// A table of these keys and no others.
pub(super) fn closed(keys: &[Key]) -> Value {
    let properties: Map<String, Value> = keys.iter().flat_map(properties).collect();
    let mut table = json!({
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    });
    let required: Vec<String> = keys.iter().filter_map(required).collect();
    if !required.is_empty() {
        table["required"] = json!(required);
    }
    let choices: Vec<Value> = keys.iter().filter_map(one_unit).collect();
    if !choices.is_empty() {
        table["allOf"] = Value::Array(choices);
    }
    table
}

/// A table without the spellings of `keys` that `kept` does not have.
pub(super) fn without(keys: &[Key], kept: &[Key]) -> Value {
    let kept: Vec<String> = kept.iter().flat_map(Key::spellings).collect();
    let all = keys.iter().flat_map(Key::spellings);
    let gone = all.filter(|spelling| !kept.contains(spelling));
    let properties: Map<String, Value> = gone.map(|spelling| (spelling, json!(false))).collect();
    json!({ "properties": properties })
}

/// A key under each of its spellings.
pub(super) fn properties(key: &Key) -> Vec<(String, Value)> {
    match &key.kind {
        Kind::Quantity(dimension, limits) => {
            let units = key.spellings().into_iter().zip(dimension.units);
            units
                .map(|(spelling, unit)| (spelling, number(key, Some(*unit), limits)))
                .collect()
        }
        Kind::Number(_, limits) => vec![(key.name.to_owned(), number(key, None, limits))],
        Kind::Table(keys) => vec![(key.name.to_owned(), closed(keys))],
        Kind::Tables(keys) => {
            let all = json!({ "type": "array", "items": closed(keys) });
            vec![(key.name.to_owned(), all)]
        }
        Kind::Word(words) => vec![(
            key.name.to_owned(),
            json!({ "enum": words, "description": told(key, None) }),
        )],
        Kind::Text(_) => vec![(
            key.name.to_owned(),
            json!({ "type": "string", "description": told(key, None) }),
        )],
        Kind::Count(least, most) => {
            let count = json!({
                "type": "integer",
                "minimum": least,
                "maximum": most,
                "description": told(key, None),
            });
            vec![(key.name.to_owned(), count)]
        }
    }
}

fn number(key: &Key, unit: Option<(&str, f64)>, limits: &ValueRange) -> Value {
    let factor = unit.map_or(1.0, |(_, factor)| factor);
    let mut number = json!({
        "type": "number",
        "minimum": rounded(limits.least / factor),
        "maximum": rounded(limits.most / factor),
        "description": told(key, unit),
    });
    if let Some(default) = key.default {
        number["default"] = json!(rounded(default / factor));
    }
    number
}

fn told(key: &Key, unit: Option<(&str, f64)>) -> String {
    let factor = unit.map_or(1.0, |(_, factor)| factor);
    key.valid(unit) + &key.left_out(factor)
}

fn rounded(value: f64) -> f64 {
    let digits = DIGITS - 1;
    format!("{value:.digits$e}").parse().unwrap_or(value)
}

/// The key that must be there, where it has one spelling.
fn required(key: &Key) -> Option<String> {
    let spellings = key.spellings();
    match spellings.as_slice() {
        [only] if !key.optional => Some(only.clone()),
        _ => None,
    }
}

/// A quantity in one of its units, and in no second one.
fn one_unit(key: &Key) -> Option<Value> {
    let spellings = key.spellings();
    if spellings.len() < 2 {
        return None;
    }
    let given: Vec<Value> = spellings
        .iter()
        .map(|s| json!({ "required": [s] }))
        .collect();
    if !key.optional {
        return Some(json!({ "oneOf": given }));
    }
    let mut either = given.clone();
    either.push(json!({ "not": { "anyOf": given } }));
    Some(json!({ "oneOf": either }))
}
