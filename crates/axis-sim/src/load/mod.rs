//! Loads: forces on the load besides its friction.

mod gravity;
mod pendulum;

use std::fmt;

use crate::effects::{Steepness, TableState};
use crate::part::PartKind;

/// All kinds of load, one line each.
pub const LOADS: &[&PartKind<dyn Load>] = &[&gravity::KIND, &pendulum::KIND];

/// A force on the load. The axis starts settled under it.
pub trait Load: fmt::Debug + Send + Sync {
    /// N or N·m, positive against positive motion.
    fn force(&self, at: &TableState) -> f64;

    /// How the force depends on the load's motion, at most.
    fn steepness(&self) -> Steepness {
        Steepness::UNKNOWN
    }
}
