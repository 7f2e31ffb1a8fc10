//! No control: a drive that does not tell its controller, or a bench without one.

use std::sync::Arc;

use super::{Control, Controller};
use crate::actuator::Surroundings;
use crate::part::{PartError, PartKind};

/// What an axis has whose file leaves `[control]` out. No file can name it.
pub(crate) static KIND: PartKind<dyn Control> = PartKind {
    name: "none",
    summary: "no controller that is known",
    keys: &[],
    known: &[],
    build: |_| Ok(Arc::new(Absent)),
};

/// Why nothing that needs a loop can be made of such an axis.
pub(crate) const WHAT: &str = "this axis has no [control]: its controller is not known, so its closed loop cannot be simulated";

/// What would be valid.
pub(crate) const VALID: &str = "an axis file with a table [control], or a command that needs no loop (`discover` finds what a model lacks from torque balance)";

#[derive(Debug)]
struct Absent;

impl Control for Absent {
    fn velocity_gain(&self, _: f64) -> Option<f64> {
        None
    }

    /// There is no state that a log does not show.
    fn starts_in_motion(&self) -> bool {
        true
    }

    fn start(&self, _: &Surroundings) -> Result<Box<dyn Controller>, PartError> {
        Err(PartError::together(WHAT, VALID))
    }
}
