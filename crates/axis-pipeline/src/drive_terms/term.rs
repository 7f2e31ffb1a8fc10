//! A number for a drive.

use serde::Serialize;

/// A number that a drive takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
}
