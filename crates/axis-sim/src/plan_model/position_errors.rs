//! What compensation tables over the position are for.

use std::f64::consts::TAU;

use super::kinematics::offset;
use crate::axis::Axis;
use crate::effects::Hooks;
use crate::error::SetupError;

/// What the effects of an axis file do that depends on the position alone: what the
/// compensation tables of a drive are for. As at the start of a motion: what grows with
/// time is not in it.
#[derive(Clone, Debug)]
pub struct PositionErrors {
    hooks: Hooks,
    travel: f64,
    start: f64,
}

/// Angles over which the mean of a turn is taken.
const OF_A_TURN: u32 = 32;

impl PositionErrors {
    /// Where the load stands ahead of the motor's angle times the travel per radian, at
    /// `position` against the stroke's start, m or rad; mean over the turn around it.
    #[must_use]
    pub fn lead(&self, position: f64) -> f64 {
        self.mean(position) - self.mean(self.start)
    }

    /// What of it repeats with the motor's turn, at an angle (rad), m or rad.
    #[must_use]
    pub fn lead_in_turn(&self, angle: f64) -> f64 {
        let position = self.travel * angle;
        self.offset(angle) - self.mean(position)
    }

    /// Torque of the motor without any command, at an angle (rad), N·m.
    #[must_use]
    pub fn cogging(&self, angle: f64) -> f64 {
        self.hooks.torque_at(angle, 0.0)
    }

    fn offset(&self, angle: f64) -> f64 {
        offset(&self.hooks, self.travel, angle)
    }

    fn mean(&self, position: f64) -> f64 {
        let middle = position / self.travel;
        let at = |i: u32| middle + TAU * ((f64::from(i) + 0.5) / f64::from(OF_A_TURN) - 0.5);
        let sum: f64 = (0..OF_A_TURN).map(|i| self.offset(at(i))).sum();
        sum / f64::from(OF_A_TURN)
    }
}

impl Axis {
    /// What its effects do that depends on the position alone.
    ///
    /// # Errors
    /// [`SetupError`] if an effect does not fit the axis.
    pub fn position_errors(&self) -> Result<PositionErrors, SetupError> {
        let (axis, hooks) = self.with_effects()?;
        Ok(PositionErrors {
            travel: axis.travel_per_radian(),
            start: axis.stroke.start,
            hooks,
        })
    }
}
