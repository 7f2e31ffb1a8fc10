//! What a control cycle leaves behind, and how a run ends.

use compensator::Correction;
use foc_pmsm::{Command, Dq};
use thiserror::Error;
use trajectories::Setpoint;

use crate::{MOST_STEPS, SixDigits};

/// What one control cycle leaves behind, at its start `t_k`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cycle {
    /// Time since the motion began, s.
    pub time: f64,
    /// Reference.
    pub reference: Setpoint,
    /// Table position, m from the driven end.
    pub position: f64,
    /// Table speed, m/s. Not seen by the controller.
    pub table_speed: f64,
    /// Motor angle since the start, rad.
    pub motor_angle: f64,
    /// Motor speed, rad/s.
    pub motor_speed: f64,
    /// Currents, A.
    pub current: Dq,
    /// What the sensors show: the above where they are perfect.
    pub measured: Measured,
    /// What the controller commands for the cycle.
    pub command: Command,
    /// What the compensator added.
    pub correction: Correction,
}

/// What the sensors show at a sampling instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Table position, m from the driven end.
    pub position: f64,
    /// Motor angle since the start, rad.
    pub motor_angle: f64,
    /// Motor speed, rad/s.
    pub motor_speed: f64,
    /// Currents, A.
    pub current: Dq,
}

impl Cycle {
    /// Tracking error S_ref − S, m.
    pub fn error(&self) -> f64 {
        self.reference.position - self.position
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The motion was followed to its end.
    Completed,
    /// The run was given up.
    Stopped {
        /// When, s.
        time: f64,
        /// Why.
        reason: StopReason,
        /// Table position then, m.
        position: f64,
        /// Tracking error then, m.
        error: f64,
        /// Motor speed then, rad/s.
        motor_speed: f64,
        /// q current then, A.
        iq: f64,
    },
}

/// Why a run was given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopReason {
    /// A state is no longer a finite number.
    NotFinite,
    /// The tracking error is beyond the axis' limit, m.
    FollowingError(f64),
    /// The table has left its stroke, or the screw.
    LeftStroke,
    /// No friction was found that goes with the table's motion at the end of a
    /// step.
    LoadNotFound,
    /// The motion takes so many internal steps, more than [`MOST_STEPS`]: it
    /// was not begun.
    TooLong(f64),
}

/// A run that did not come to its end.
#[derive(Clone, Copy, Debug, Error)]
#[error(
    "the simulation stopped at t = {} s because {reason}: table at {} m, tracking error {} m, motor speed {} rad/s, q current {} A",
    SixDigits(*.time), SixDigits(*.position), SixDigits(*.error), SixDigits(*.motor_speed), SixDigits(*.iq)
)]
pub struct RunStopped {
    /// When, s.
    pub time: f64,
    /// Why.
    pub reason: StopReason,
    /// Table position then, m.
    pub position: f64,
    /// Tracking error then, m.
    pub error: f64,
    /// Motor speed then, rad/s.
    pub motor_speed: f64,
    /// q current then, A.
    pub iq: f64,
}

impl std::fmt::Display for StopReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotFinite => f.write_str("a state is no longer a finite number"),
            Self::FollowingError(limit) => write!(
                f,
                "the tracking error passed {} mm, the following_error_limit_mm of the axis file's [control] (an unstable loop, or a motion too fast for the motor)",
                SixDigits(1e3 * limit)
            ),
            Self::LeftStroke => f.write_str("the table left its stroke"),
            Self::LoadNotFound => f.write_str(
                "no friction goes with the table's motion at the end of a step (a load that jumps or falls with the speed, or a step too long for the table's mass)",
            ),
            Self::TooLong(steps) => write!(
                f,
                "the motion takes {} internal steps, more than {} (a shorter motion, a lower control frequency or a longer step would be valid)",
                SixDigits(*steps),
                SixDigits(MOST_STEPS)
            ),
        }
    }
}

impl Outcome {
    /// The run as a success or the error that tells why it is none.
    ///
    /// # Errors
    /// [`RunStopped`] where the run was given up.
    pub fn completed(self) -> Result<(), RunStopped> {
        match self {
            Self::Completed => Ok(()),
            Self::Stopped {
                time,
                reason,
                position,
                error,
                motor_speed,
                iq,
            } => Err(RunStopped {
                time,
                reason,
                position,
                error,
                motor_speed,
                iq,
            }),
        }
    }
}
