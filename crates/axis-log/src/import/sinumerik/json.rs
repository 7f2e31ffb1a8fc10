//! The JSON of a recording, as far as it is read.

use std::fmt;

use serde::de::{IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
pub(super) struct File {
    pub header: Header,
    pub payload: Vec<Rows>,
    #[serde(default)]
    pub footer: Footer,
}

#[derive(Deserialize)]
pub(super) struct Header {
    #[serde(rename = "SignalListHFData", default)]
    pub signals: Vec<Signal>,
    #[serde(rename = "CycleTimeMs", default)]
    cycle: serde_json::Value,
}

impl Header {
    /// The position control cycle, s, where the header has one.
    pub(super) fn cycle(&self) -> Option<f64> {
        let ms = match &self.cycle {
            serde_json::Value::String(text) => text.trim().parse().ok(),
            other => other.as_f64(),
        };
        ms.filter(|ms: &f64| ms.is_finite() && *ms > 0.0)
            .map(|ms| ms * 1e-3)
    }
}

#[derive(Deserialize)]
pub(super) struct Signal {
    #[serde(rename = "Address")]
    pub address: String,
    /// Name of the axis on the machine.
    #[serde(rename = "Axis", default)]
    pub axis: Option<String>,
}

#[derive(Default, Deserialize)]
pub(super) struct Footer {
    #[serde(rename = "ErrorMessages", default)]
    pub errors: Vec<String>,
}

/// Rows of `HFData`; none of any other object of the payload.
pub(super) struct Rows(pub Vec<Vec<Cell>>);

impl<'de> Deserialize<'de> for Rows {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Object;
        impl<'de> Visitor<'de> for Object {
            type Value = Rows;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object of the payload")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Rows, A::Error> {
                let mut rows = Vec::new();
                while let Some(key) = map.next_key::<String>()? {
                    match key.as_str() {
                        "HFData" => rows.extend(map.next_value::<Vec<Vec<Cell>>>()?),
                        _ => drop(map.next_value::<IgnoredAny>()?),
                    }
                }
                Ok(Rows(rows))
            }
        }
        from.deserialize_map(Object)
    }
}

/// A value: a number, nothing, or what is no number.
#[derive(Clone, Copy)]
pub(super) enum Cell {
    Number(f64),
    Null,
    Other,
}

impl<'de> Deserialize<'de> for Cell {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Value;
        impl<'de> Visitor<'de> for Value {
            type Value = Cell;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a value")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Cell, E> {
                Ok(Cell::Number(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Cell, E> {
                Ok(Cell::Number(value as f64))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Cell, E> {
                Ok(Cell::Number(value as f64))
            }

            fn visit_unit<E>(self) -> Result<Cell, E> {
                Ok(Cell::Null)
            }

            fn visit_bool<E>(self, _: bool) -> Result<Cell, E> {
                Ok(Cell::Other)
            }

            fn visit_str<E>(self, _: &str) -> Result<Cell, E> {
                Ok(Cell::Other)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Cell, A::Error> {
                while seq.next_element::<IgnoredAny>()?.is_some() {}
                Ok(Cell::Other)
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Cell, A::Error> {
                while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
                Ok(Cell::Other)
            }
        }
        from.deserialize_any(Value)
    }
}
