//! One row of the table.

use serde::{Deserialize, Serialize};

/// What a row found.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct Measured {
    /// What was run, in words.
    pub what: String,
    /// The goal, in words; empty for none.
    pub goal: String,
    /// The figures, in words.
    pub found: String,
    /// Whether the goal is met; of no goal none.
    pub met: Option<bool>,
    /// What limits it, and what the row does not say.
    pub note: String,
}
