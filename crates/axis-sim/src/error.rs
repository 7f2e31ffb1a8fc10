//! Why an axis cannot be set up.

use feed_dynamics::DriveError;
use thiserror::Error;

use crate::part::PartError;
use crate::plant::AdvanceError;

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
