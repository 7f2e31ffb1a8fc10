//! Feed-forward of the current that friction asks for.

use lugre::{Exponential, LuGre};

use crate::error::{self, require, within};
use crate::{Compensator, CompensatorError, Correction, Sample};

/// LuGre friction along the reference velocity, divided by the torque constant.
///
/// The bristles are carried along the planned motion, not the measured one:
/// the feed-forward has no noise and closes no loop (Section 4.4, Fig. 8 of
/// Liu et al. 2025, where K_T is the torque constant).
#[derive(Clone, Copy, Debug)]
pub struct FrictionFeedforward<T = f64> {
    law: LuGre<T>,
    per_travel: T,
    per_torque: T,
    period: T,
    bristle: T,
    speed: T,
}

/// The drive that a [`FrictionFeedforward`] is for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FeedforwardDrive<T = f64> {
    /// Load travel per radian of the law's coordinate r = lead/2π, m/rad, from 1e-9 to 1e3.
    pub travel_per_radian: T,
    /// Torque constant K_t, N·m/A, from 1e-9 to 1e9.
    pub torque_constant: T,
    /// Control period, s, from 1e-9 to 1e3.
    pub period: T,
}

impl<T: Exponential> FrictionFeedforward<T> {
    /// Friction `law` at the screw (N·m over rad/s) of a drive.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] for a value outside its range.
    pub fn new(law: LuGre<T>, drive: FeedforwardDrive<T>) -> Result<Self, CompensatorError> {
        let FeedforwardDrive {
            travel_per_radian,
            torque_constant,
            period,
        } = drive;
        let inside = within(torque_constant, 1e-9, 1e9);
        let valid = "from 1e-9 to 1e9 N·m/A";
        let torque_constant = require(inside, "torque_constant", torque_constant, valid)?;
        Ok(Self {
            law,
            per_travel: T::ONE / error::travel_per_radian(travel_per_radian)?,
            per_torque: T::ONE / torque_constant,
            period: error::period(period)?,
            bristle: T::ZERO,
            speed: T::ZERO,
        })
    }

    /// The friction law.
    pub fn law(&self) -> &LuGre<T> {
        &self.law
    }

    /// The law's coordinate per travel, rad/m.
    pub fn per_travel(&self) -> T {
        self.per_travel
    }

    /// Command per friction of the law, A/(N·m).
    pub fn per_torque(&self) -> T {
        self.per_torque
    }

    /// Control period, s.
    pub fn period(&self) -> T {
        self.period
    }

    /// The same at the start of a motion, each number rounded to the nearest of another
    /// scalar.
    ///
    /// # Errors
    /// [`lugre::LugreError`] if a parameter leaves its range by that.
    pub fn cast<U: Exponential>(&self) -> Result<FrictionFeedforward<U>, lugre::LugreError> {
        let cast = |value: T| U::of(value.to_f64());
        Ok(FrictionFeedforward {
            law: LuGre::new(self.law.parameters().cast())?,
            per_travel: cast(self.per_travel),
            per_torque: cast(self.per_torque),
            period: cast(self.period),
            bristle: U::ZERO,
            speed: U::ZERO,
        })
    }
}

impl<T: Exponential> Compensator<T> for FrictionFeedforward<T> {
    fn reset(&mut self) {
        self.bristle = T::ZERO;
        self.speed = T::ZERO;
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        let speed = sample.reference.velocity * self.per_travel;
        let (bristle, torque) = self
            .law
            .step_torque(self.bristle, self.speed, speed, self.period);
        self.bristle = bristle;
        self.speed = speed;
        Correction {
            position: T::ZERO,
            command: torque * self.per_torque,
        }
    }
}
