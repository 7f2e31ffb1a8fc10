//! Where a run is given up.

use feed_dynamics::DriveError;

use super::ClosedLoop;
use crate::cycle::{Cycle, Outcome, Stop, StopReason};
use crate::plant::AdvanceError;
use crate::value_range::ValueRange;

impl ClosedLoop {
    pub(super) fn stop_reason(&self, cycle: &Cycle) -> Option<StopReason> {
        let axis = &self.axis;
        let current = cycle.current.d + cycle.current.q + cycle.command.effort;
        let state = cycle.position + cycle.motor_speed + current;
        if !state.is_finite() {
            Some(StopReason::NotFinite)
        } else if cycle.error().abs() > axis.following_error_limit {
            let limit = axis.following_error_limit;
            Some(StopReason::FollowingError(limit, axis.freedom()))
        } else if !self.room().contains(cycle.position) {
            Some(StopReason::LeftStroke)
        } else {
            None
        }
    }

    /// Where the load may be: on the stroke, as far as the mechanism reaches.
    fn room(&self) -> ValueRange {
        let stroke = &self.axis.stroke;
        let stroke = ValueRange {
            least: stroke.minimum,
            most: stroke.maximum,
        };
        match self.axis.mechanism.reach() {
            Some(reach) => ValueRange {
                least: stroke.least.max(reach.least),
                most: stroke.most.min(reach.most),
            },
            None => stroke,
        }
    }

    pub(super) fn stopped(&self, reason: StopReason, at: &Cycle) -> crate::RunStopped {
        crate::RunStopped {
            time: at.time,
            reason,
            at: Stop {
                position: at.position,
                error: at.error(),
                motor_speed: at.motor_speed,
                torque: at.torque,
                freedom: self.axis.freedom(),
                motor: self.axis.mechanism.motor_freedom(),
                stroke: [self.room().least, self.room().most],
            },
        }
    }

    pub(super) fn given_up(&self, reason: StopReason, at: &Cycle) -> Outcome {
        let crate::RunStopped { time, reason, at } = self.stopped(reason, at);
        Outcome::Stopped { time, reason, at }
    }
}

/// Why a run cannot go on after `error`, which has left it in the state `at`.
pub(super) fn reason_of(error: &AdvanceError, at: &Cycle) -> StopReason {
    match error {
        AdvanceError::LoadNotFound { residual, .. } if (state(at) + residual).is_finite() => {
            StopReason::LoadNotFound
        }
        AdvanceError::Drive(error) => reason_of_drive(error, at),
        _ => StopReason::NotFinite,
    }
}

/// The same of the mechanics alone.
pub(super) fn reason_of_drive(error: &DriveError, at: &Cycle) -> StopReason {
    match error {
        DriveError::OffScrew { .. } if state(at).is_finite() => StopReason::LeftStroke,
        _ => StopReason::NotFinite,
    }
}

/// Finite where all of it is.
fn state(at: &Cycle) -> f64 {
    at.position + at.motor_speed + at.current.d + at.current.q
}
