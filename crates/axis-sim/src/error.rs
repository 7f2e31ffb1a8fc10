//! Why an axis cannot be set up, or not go on.

use feed_dynamics::DriveError;
use thiserror::Error;

use crate::part::PartError;

/// Why an axis, with its effects, makes no closed loop.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SetupError {
    /// The mechanics cannot be set up, or are asked for what they are not.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// A cycle from a given state cannot be made.
    #[error(transparent)]
    Cycle(#[from] AdvanceError),
    /// The thermal model cannot be made, or a motion's losses.
    #[error(transparent)]
    Thermal(#[from] axis_thermal::ThermalError),
    /// A part refuses its values.
    #[error(transparent)]
    Part(#[from] PartError),
    /// An effect that this axis cannot have.
    #[error("the effect \"{effect}\" does not fit this axis: {why}")]
    Effect {
        /// Its name.
        effect: &'static str,
        /// Why not.
        why: String,
    },
}

/// Why a machine in motion cannot go on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AdvanceError {
    /// The mechanics refuse the step: an effect shifts the transmission by no number.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// No force on the load was found that goes with the motion that it leads to.
    #[error(
        "no force on the load is consistent with its motion after {rounds} iterations (relative residual {residual}): friction, loads and effects must be finite, and bounded or growing with the speed"
    )]
    LoadNotFound {
        /// Forces that were tried.
        rounds: u32,
        /// What was left of the last one, N or N·m.
        residual: f64,
    },
}
