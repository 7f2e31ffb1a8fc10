//! What is asked of gains.

use crate::error::LoopError;
use crate::set::LoopSet;

/// What is asked of gains.
#[derive(Clone, Debug, PartialEq)]
pub struct TuneSettings {
    /// Maximum sensitivity at either cut, in all corners.
    pub sensitivity: f64,
    /// The same with one more cycle of delay.
    pub sensitivity_late: f64,
    /// Greatest ripple of the command by the step of the sensor that the speed is derived from, as a
    /// share of the greatest command (RMS); infinite for none.
    pub ripple: f64,
    /// The corners.
    pub set: LoopSet,
    /// Whether the acceleration is fed forward.
    pub acceleration: bool,
    /// Whether a notch may be set where the file has none.
    pub notch: bool,
    /// Whether the current controllers are set to the magnitude optimum first.
    pub current: bool,
    /// Whether the limits are lowered until no simulated move rings or saturates more than with the
    /// gains of the file.
    pub simulated: bool,
}

impl Default for TuneSettings {
    fn default() -> Self {
        Self {
            sensitivity: 1.6,
            sensitivity_late: 2.0,
            ripple: 0.02,
            set: LoopSet::default(),
            acceleration: true,
            notch: true,
            current: false,
            simulated: true,
        }
    }
}

impl TuneSettings {
    pub(crate) fn check(&self) -> Result<(), LoopError> {
        let refused = |name, value, valid| Err(LoopError::Setting { name, value, valid });
        if !(1.1..=10.0).contains(&self.sensitivity) {
            return refused(
                "the limit of the sensitivity",
                self.sensitivity,
                "from 1.1 to 10",
            );
        }
        if self.sensitivity_late.is_nan() || self.sensitivity_late < self.sensitivity {
            let valid = "at least the limit without the cycle of delay";
            return refused(
                "the limit with one more cycle",
                self.sensitivity_late,
                valid,
            );
        }
        if self.ripple.is_nan() || self.ripple <= 0.0 {
            return refused("the limit of the ripple", self.ripple, "above 0");
        }
        Ok(())
    }
}
