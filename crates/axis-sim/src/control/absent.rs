//! No control: a drive that does not tell its controller, or a bench without one.

use std::sync::Arc;

use super::{Control, Controller};
use crate::actuator::Surroundings;
use crate::part::{Known, Part, PartError, PartKind, Role, Values};

/// What an axis has whose file leaves `[control]` out. No file can name it.
pub(crate) static KIND: PartKind<dyn Control> = PartKind {
    name: "none",
    summary: "unknown controller",
    keys: &[],
    known: &[
        Known::by(SAMPLED_INERTIA, |values, by| {
            values.set(SAMPLED_INERTIA, by * sampled(values));
        })
        .with_own_tolerance(0.1, Some(Role::LoadInertia)),
        Known::by(COMMAND_HOLD, |values, by| {
            values.set(COMMAND_HOLD, by * hold(values));
        })
        .with_own_tolerance(1.0, None),
        // Beside nothing: the share by which it is off is the skew.
        Known::by(TORQUE_SKEW, |values, by| values.set(TORQUE_SKEW, by - 1.0))
            .with_own_tolerance(0.5, None),
        Known::by(ENCODER_SKEW, |values, by| {
            values.set(ENCODER_SKEW, by - 1.0)
        })
        .with_own_tolerance(0.5, None),
    ],
    build: |_| Ok(Arc::new(Absent)),
};

/// The torque of acceleration as a logged command or current shows it, as a share of its mean.
///
/// A position controller that is slower than the speed controller below it gives this one a
/// staircase. With the gain k_p from speed to torque the torque begins each of its periods T up
/// to k_p a T / 2 above the mean (a being the acceleration), and a log that is taken in step with
/// it shows that one sample, as if the axis had so much more inertia J. Of a loop that crosses
/// over at ω = k_p / J that is the share ω T / 2; ω T is 0.2 at most in a drive that is well
/// damped.
const SAMPLED_INERTIA: &str = "sampled_inertia";

/// Time for which a command is held, as a share of the period of its log. A controller may be
/// as fast as its log or any number of times faster, so all from 0 to 1 is possible.
const COMMAND_HOLD: &str = "command_hold";

/// Time by which a torque, a force or a current that is measured is ahead of the motion beside it, as
/// a share of the period of its log: channels of one row are seldom taken at one instant, and
/// what is called measured may be a command that is held.
const TORQUE_SKEW: &str = "torque_skew";

/// Time by which the load's position is shown later than the motor's angle, as a share of the period of
/// their log: two encoders are seldom read at one instant.
const ENCODER_SKEW: &str = "encoder_skew";

fn sampled(values: &Values) -> f64 {
    values.optional(SAMPLED_INERTIA).unwrap_or(1.0)
}

fn hold(values: &Values) -> f64 {
    values.optional(COMMAND_HOLD).unwrap_or(0.5)
}

/// That share for a control; 1 where it is known.
pub(crate) fn sampled_inertia(control: &Part<dyn Control>) -> f64 {
    sampled(control.values())
}

/// Share of a log's period for which a command is held where the control is not known.
pub(crate) fn command_hold(control: &Part<dyn Control>) -> f64 {
    hold(control.values())
}

/// Share of a log's period by which a measured torque is ahead of the motion where the control is
/// not known.
pub(crate) fn torque_skew(control: &Part<dyn Control>) -> f64 {
    control.values().optional(TORQUE_SKEW).unwrap_or(0.0)
}

/// Share of a log's period by which the load's position is shown later than the motor's angle where the
/// control is not known.
pub(crate) fn encoder_skew(control: &Part<dyn Control>) -> f64 {
    control.values().optional(ENCODER_SKEW).unwrap_or(0.0)
}

/// Why nothing that needs a loop can be made of such an axis.
pub(crate) const WHAT: &str = "this axis has no [control]: its controller is not known, so its closed loop cannot be simulated";

/// What would be valid.
pub(crate) const VALID: &str = "an axis file with a table [control], or a command that needs no loop (`discover` finds what a model lacks from torque balance)";

#[derive(Debug)]
struct Absent;

impl Control for Absent {
    fn velocity_gain(&self, _: f64) -> Option<f64> {
        None
    }

    /// There is no state that a log does not show.
    fn starts_in_motion(&self) -> bool {
        true
    }

    fn start(&self, _: &Surroundings) -> Result<Box<dyn Controller>, PartError> {
        Err(PartError::together(WHAT, VALID))
    }
}
