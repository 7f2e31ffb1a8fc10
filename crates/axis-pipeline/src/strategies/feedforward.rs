//! Friction feed-forward on an axis.

use axis_sim::Axis;
use compensator::{FeedforwardDrive, FrictionFeedforward};
use lugre::LuGre;

use crate::PipelineError;

/// From a friction law in its own coordinate to the actuator's command.
#[derive(Clone, Copy, Debug)]
pub struct Feedforward {
    /// Load travel per unit of the law's coordinate.
    lever: f64,
    /// Friction of the law per unit of the command.
    per_effort: f64,
}

impl Feedforward {
    /// On an axis.
    pub fn of(axis: &Axis) -> Self {
        let r = axis.travel_per_radian();
        let lever = axis.friction.lever(r);
        Self {
            lever,
            per_effort: axis.torque_constant() * (lever / r),
        }
    }

    /// Feed-forward of a law, with a control period (s).
    ///
    /// # Errors
    /// [`PipelineError::Compensator`] for values outside their ranges.
    pub fn of_law(&self, law: LuGre, period: f64) -> Result<FrictionFeedforward, PipelineError> {
        let Self { lever, per_effort } = *self;
        Ok(FrictionFeedforward::new(
            law,
            FeedforwardDrive {
                travel_per_radian: lever,
                torque_constant: per_effort,
                period,
            },
        )?)
    }
}
