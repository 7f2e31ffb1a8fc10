//! Feed-forward of the current that friction asks for.

use lugre::LuGre;

use crate::error::{self, require};
use crate::{Compensator, CompensatorError, Correction, Sample};

/// LuGre friction along the reference velocity, divided by the torque constant.
///
/// The bristles are carried along the planned motion, not the measured one:
/// the feed-forward has no noise and closes no loop (Section 4.4, Fig. 8 of
/// Liu et al. 2025, where K_T is the torque constant).
#[derive(Clone, Copy, Debug)]
pub struct FrictionFeedforward {
    law: LuGre,
    per_travel: f64,
    per_torque: f64,
    period: f64,
    bristle: f64,
    speed: f64,
}

impl FrictionFeedforward {
    /// Friction `law` at the screw (N·m over rad/s); `travel_per_radian`
    /// r = lead/2π (from 1e-9 to 1e3 m/rad); `torque_constant` K_t (from 1e-9
    /// to 1e9 N·m/A); control `period` (from 1e-9 to 1e3 s).
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] for a value outside its range.
    pub fn new(
        law: LuGre,
        travel_per_radian: f64,
        torque_constant: f64,
        period: f64,
    ) -> Result<Self, CompensatorError> {
        let inside = (1e-9..=1e9).contains(&torque_constant);
        let valid = "from 1e-9 to 1e9 N·m/A";
        let torque_constant = require(inside, "torque_constant", torque_constant, valid)?;
        Ok(Self {
            law,
            per_travel: 1.0 / error::travel_per_radian(travel_per_radian)?,
            per_torque: 1.0 / torque_constant,
            period: error::period(period)?,
            bristle: 0.0,
            speed: 0.0,
        })
    }
}

impl Compensator for FrictionFeedforward {
    fn reset(&mut self) {
        self.bristle = 0.0;
        self.speed = 0.0;
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        let speed = sample.reference.velocity * self.per_travel;
        let (bristle, torque) = self
            .law
            .step_torque(self.bristle, self.speed, speed, self.period);
        self.bristle = bristle;
        self.speed = speed;
        Correction {
            position: 0.0,
            iq: torque * self.per_torque,
        }
    }
}
