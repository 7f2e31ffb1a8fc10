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

pub use crate::data_sheets::{DataSheets, MotorPoint};
pub use duty::{AxisDuty, DutyStretch};
pub use item::{CheckedItem, ItemState, ItemVerdict};

pub(crate) use keys::{About, MOTOR_CURVE, RATING_KEYS, about, is_linear_unit, rating_keys};
use sheets::Sheets;

use axis_log::quality::SamplingError;
use axis_rating::RatingError;
use thiserror::Error;

use crate::axis::Axis;
use crate::balance::BalanceError;
use crate::cycle::RunStopped;
use crate::error::SetupError;
use crate::freedom::Freedom;
use crate::thermal::THERMAL_KEYS;

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
    /// A log does not tell the motion or the torque.
    #[error(transparent)]
    Balance(#[from] BalanceError),
    /// A log is not evenly sampled.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
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

    /// A key's name as it may stand in the file of this axis: with the first unit that fits.
    fn spelled(&self, name: &str) -> String {
        let (table, own) = name.rsplit_once('.').unwrap_or(("", name));
        let keys = match table {
            "thermal" => THERMAL_KEYS,
            "actuator" => self.actuator.kind().keys,
            _ => RATING_KEYS,
        };
        let Some(key) = keys.iter().find(|key| key.name == own) else {
            return name.to_owned();
        };
        let linear = self.mechanism.motor_freedom() == Freedom::Linear;
        // Of a motor's dimensions: others have units of one sort.
        let of_motor =
            ["torque", "speed"].iter().any(|end| own.ends_with(end)) || own == "motor_constant";
        let fits = |unit: &str| !of_motor || is_linear_unit(unit) == linear;
        match key.units().iter().find(|(unit, _)| fits(unit)) {
            Some((unit, _)) => format!("{name}_{unit}"),
            None => name.to_owned(),
        }
    }

    /// All items that apply to this axis, under a duty: first the motor's, then the mechanism's.
    ///
    /// # Errors
    /// [`CheckError`] if numbers of `[rating]` contradict each other.
    pub fn checked(&self, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
        let mut items = motor_items::items(self, duty)?;
        items.extend(machine_items::items(self, duty)?);
        for item in &mut items {
            if let ItemState::NotKnown { keys, .. } = &mut item.state {
                keys.iter_mut().for_each(|key| *key = self.spelled(key));
            }
        }
        Ok(items)
    }
}

#[cfg(test)]
mod tests;
