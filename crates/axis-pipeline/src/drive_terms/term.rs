//! A number for a drive.

use schemars::JsonSchema;
use serde::Serialize;

use super::parameters::DriveParameter;

/// Name, value, its unit, factor to a drive's unit and that unit, meaning.
pub(super) type Line = (&'static str, f64, String, (f64, String), &'static str);

/// A number that a drive takes.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Term {
    /// Words in lower case, `_` between them.
    pub name: &'static str,
    /// In its SI unit.
    pub value: f64,
    /// That unit.
    pub unit: String,
    /// The same in a unit that drives use.
    pub drive_value: f64,
    /// That unit.
    pub drive_unit: String,
    /// What it is.
    pub meaning: &'static str,
    /// Parameters of drives and controls that take it.
    pub parameters: Vec<DriveParameter>,
}

impl From<Line> for Term {
    fn from((name, value, unit, (factor, drive_unit), meaning): Line) -> Self {
        Self {
            name,
            value,
            unit,
            drive_value: factor * value,
            drive_unit,
            meaning,
            parameters: Vec::new(),
        }
    }
}
