//! Values under the names that result files give them.

use axis_sim::mechanism::Freedom;
use serde::Serialize;

/// Errors of an axis, under the name of their unit.
#[derive(Clone, Copy, Debug, Serialize)]
pub enum Errors<T> {
    /// µm, of an axis that moves along a line.
    #[serde(rename = "errors_um")]
    Linear(T),
    /// µrad, of one that turns.
    #[serde(rename = "errors_urad")]
    Rotary(T),
}

impl<T> Errors<T> {
    /// Errors in millionths of the unit of an axis' position.
    pub fn of(freedom: Freedom, errors: T) -> Self {
        match freedom {
            Freedom::Linear => Self::Linear(errors),
            Freedom::Rotary => Self::Rotary(errors),
        }
    }

    /// The errors, and the unit.
    pub fn get(&self) -> (&T, &'static str) {
        match self {
            Self::Linear(errors) => (errors, "µm"),
            Self::Rotary(errors) => (errors, "µrad"),
        }
    }
}
