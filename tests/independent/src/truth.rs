//! What a case hides, in the library's words, and which verdict is right.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// The verdict that is right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wanted {
    /// Nothing is hidden.
    NothingMissing,
    /// An effect of the library is hidden.
    Explained,
    /// Something is hidden that is not in the library.
    Unknown,
}

/// An effect by the library's name, with its sizes by the library's names, SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrueEffect {
    /// Name.
    pub name: String,
    /// Values.
    pub parameters: BTreeMap<String, f64>,
}

impl TrueEffect {
    /// An effect with its values.
    pub fn new(name: &str, parameters: &[(&str, f64)]) -> Self {
        let own = |&(name, value): &(&str, f64)| (name.to_owned(), value);
        Self {
            name: name.to_owned(),
            parameters: parameters.iter().map(own).collect(),
        }
    }
}

/// The content of `truth.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Name of the case.
    pub case: String,
    /// Its seed.
    pub seed: u64,
    /// The verdict that is right.
    pub verdict: Wanted,
    /// What is hidden; none or one.
    pub effects: Vec<TrueEffect>,
    /// Effects that are as right in its place, as the machine does the same with them.
    pub also_right: Vec<TrueEffect>,
    /// On what something outside of the library depends.
    pub variable: Option<String>,
    /// Its law.
    pub law: Option<String>,
    /// Shares by which parameters of the axis file are off.
    pub put_off: BTreeMap<String, f64>,
    /// The tolerance that the axis file tells, percent; 1 where it tells none.
    pub told_percent: f64,
}
