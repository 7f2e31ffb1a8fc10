//! The axis against the data sheets of its parts: `[rating]` of its file, and what a duty asks.
//!
//! The formulas are those of `axis_rating`; here are the numbers that go into them.

mod duty;
mod item;
mod keys;
mod log;
mod machine_items;
mod motion;
mod motor_items;
mod sheets;

pub use duty::{AxisDuty, DutyStretch};
pub use item::{CheckedItem, ItemState, ItemVerdict};
pub use sheets::{DataSheets, MotorPoint};

pub(crate) use keys::{About, MOTOR_CURVE, RATING_KEYS, about, is_linear_unit, rating_keys};
use sheets::Sheets;

use axis_log::LogError;
use axis_rating::RatingError;
use thiserror::Error;

use crate::axis::Axis;
use crate::cycle::RunStopped;
use crate::error::SetupError;
use crate::mechanism::Freedom;

/// Why an axis cannot be checked.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CheckError {
    /// A number of `[rating]`, or of the duty.
    #[error(transparent)]
    Rating(#[from] RatingError),
    /// The axis cannot have one of its effects.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The simulated run did not come to its end.
    #[error(transparent)]
    Stopped(#[from] RunStopped),
    /// A log lacks a channel.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A log does not tell the torque.
    #[error(
        "the log has no channel that tells the motor's torque; valid: iq_a (or iq_ref_a), torque_ref_n_m, force_ref_n or drive_command_v, as the axis' actuator has it"
    )]
    NoTorque,
    /// A log has no two instants.
    #[error("the log has fewer than two instants; valid: a log over some time")]
    NoTime,
}

impl Axis {
    /// What of `[rating]` this axis can have.
    pub(crate) fn is_about(&self, of: About) -> bool {
        match of {
            About::Screw => self.mechanism.screw().is_some(),
            About::Belt => self.mechanism.has_belt(),
            About::Guide => self.freedom() == Freedom::Linear,
        }
    }

    /// All items that apply to this axis, under a duty: first the motor's, then the mechanism's.
    ///
    /// # Errors
    /// [`CheckError`] if numbers of `[rating]` contradict each other.
    pub fn checked(&self, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
        let mut items = motor_items::items(self, duty)?;
        items.extend(machine_items::items(self, duty)?);
        Ok(items)
    }
}

#[cfg(test)]
mod tests;
