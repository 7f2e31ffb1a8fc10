//! One column of a log.

use crate::error::LogError;
use crate::unit::unit_of;

/// One named quantity, sampled at every instant of its log.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Full name with the unit as suffix, as in the header of a file:
    /// `position_ref_m`.
    pub name: String,
    /// Symbol of the unit, as [`unit_of`] reads it from the name: `m`, `rad/s`.
    pub unit: String,
    /// Samples in that unit, one for each instant.
    pub samples: Vec<f64>,
}

impl Channel {
    /// A channel whose unit is read from the suffix of `name`.
    ///
    /// # Errors
    /// [`LogError::UnitSuffix`] if the name has no known unit suffix. The
    /// samples are checked when the channel joins a [`Log`](crate::Log).
    pub fn new(name: impl Into<String>, samples: Vec<f64>) -> Result<Self, LogError> {
        let name = name.into();
        let unit = unit_of(&name)
            .ok_or_else(|| LogError::UnitSuffix { name: name.clone() })?
            .to_owned();
        Ok(Self {
            name,
            unit,
            samples,
        })
    }

    /// What can be checked on one channel alone: name, unit and finite samples.
    pub(crate) fn check(&self) -> Result<(), LogError> {
        let expected = unit_of(&self.name).ok_or_else(|| LogError::UnitSuffix {
            name: self.name.clone(),
        })?;
        if self.unit != expected {
            return Err(LogError::UnitMismatch {
                name: self.name.clone(),
                unit: self.unit.clone(),
                expected,
            });
        }
        match self.samples.iter().position(|v| !v.is_finite()) {
            Some(index) => Err(LogError::NotFinite {
                name: self.name.clone(),
                index,
                value: self.samples[index],
            }),
            None => Ok(()),
        }
    }
}
