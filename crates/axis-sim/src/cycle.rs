//! What a control cycle leaves behind, and how a run ends.

use compensator::Correction;
use foc_pmsm::Dq;
use thiserror::Error;
use trajectories::Setpoint;

use crate::freedom::Freedom;
use crate::{MOST_STEPS, SixDigits};

/// What one control cycle leaves behind, at its start `t_k`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cycle {
    /// Time since the motion began, s.
    pub time: f64,
    /// Reference.
    pub reference: Setpoint,
    /// Position of the load, m or rad.
    pub position: f64,
    /// Its speed, m/s or rad/s. Not seen by the controller.
    pub load_speed: f64,
    /// Motor angle, rad; m where the motor moves along a line
    /// ([`Mechanism::motor_freedom`](crate::mechanism::Mechanism::motor_freedom)).
    pub motor_angle: f64,
    /// Motor speed, rad/s; m/s there.
    pub motor_speed: f64,
    /// Currents, A; 0 if the actuator has none.
    pub current: Dq,
    /// Torque of the motor, N·m; its force, N, there.
    pub torque: f64,
    /// What the sensors show: the above where they are perfect.
    pub measured: Measured,
    /// What the controller commands for the cycle.
    pub command: Command,
    /// What the compensator added.
    pub correction: Correction,
    /// What an excitation added to the command, in the command's unit
    /// ([`ClosedLoop::with_excitation`](crate::ClosedLoop::with_excitation)).
    pub excitation: f64,
}

/// What controller and actuator ask for in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Speed reference of the motor, rad/s; 0 if there is no speed loop.
    pub speed_ref: f64,
    /// Command of the actuator, in its unit: q current reference, torque, force, voltage.
    pub effort: f64,
    /// Voltage that the actuator's controllers ask for, V; 0 if it has none.
    pub voltage: Dq,
    /// Whether a limit was active.
    pub saturated: bool,
}

/// What the sensors show at a sampling instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Position of the load, m or rad.
    pub position: f64,
    /// Motor angle, rad.
    pub motor_angle: f64,
    /// Motor speed, rad/s.
    pub motor_speed: f64,
    /// Currents, A.
    pub current: Dq,
}

impl Cycle {
    /// Tracking error S_ref − S, m or rad.
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
        /// What the load was doing then.
        at: Stop,
    },
}

/// Why a run was given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopReason {
    /// A state is no longer a finite number.
    NotFinite,
    /// The tracking error is beyond the axis' limit, m or rad.
    FollowingError(f64, Freedom),
    /// The load has left its stroke, or the mechanism's reach.
    LeftStroke,
    /// No friction is consistent with the load's motion at the end of a
    /// step.
    LoadNotFound,
    /// The motion takes so many internal steps, more than [`MOST_STEPS`]: it
    /// was not begun.
    TooLong(f64),
}

/// The state in which a run was given up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stop {
    /// Position of the load, m or rad.
    pub position: f64,
    /// Tracking error, m or rad.
    pub error: f64,
    /// Motor speed, rad/s, or m/s of a motor that moves along a line.
    pub motor_speed: f64,
    /// Motor torque, N·m, or force, N.
    pub torque: f64,
    /// How the load moves.
    pub freedom: Freedom,
    /// How the motor moves.
    pub motor: Freedom,
    /// Where the load may be: the stroke, as far as the mechanism reaches, m or rad.
    pub stroke: [f64; 2],
}

/// A run that did not come to its end.
#[derive(Clone, Copy, Debug, Error)]
#[error(
    "the simulation stopped at t = {} s because {reason}: load at {} {unit}, tracking error {} {unit}, motor speed {} {speed}, motor {force} {} {force_unit}; valid: {}",
    SixDigits(*.time), SixDigits(.at.position), SixDigits(.at.error), SixDigits(.at.motor_speed), SixDigits(.at.torque),
    .reason.valid(.at),
    unit = .at.freedom.unit(), speed = .at.motor.speed_unit(), force = .at.motor.force()[0], force_unit = .at.motor.force()[1]
)]
pub struct RunStopped {
    /// When, s.
    pub time: f64,
    /// Why.
    pub reason: StopReason,
    /// What the load was doing then.
    pub at: Stop,
}

impl StopReason {
    /// What would not have been given up for this reason.
    fn valid(&self, at: &Stop) -> String {
        match self {
            Self::NotFinite => {
                "a loop that is stable (smaller gains in [control]), or a shorter step in [simulation]"
                    .to_owned()
            }
            Self::FollowingError(..) => {
                "a loop that is stable, a motion that the motor can follow, or a greater limit".to_owned()
            }
            Self::LeftStroke => {
                let [from, to] = at.stroke.map(SixDigits);
                format!(
                    "a motion from {from} to {to} {}, where the load may be ([stroke]), and a load that the \
                     motor can hold there",
                    at.freedom.unit()
                )
            }
            Self::LoadNotFound => {
                "a shorter step in [simulation], a greater mass of the load, or effects of the load that are \
                 smaller or steadier"
                    .to_owned()
            }
            Self::TooLong(_) => format!(
                "at most {} internal steps, by a shorter motion, a lower control frequency or a longer step",
                SixDigits(MOST_STEPS)
            ),
        }
    }
}

impl std::fmt::Display for StopReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotFinite => f.write_str("a state is no longer a finite number"),
            Self::FollowingError(limit, freedom) => write!(
                f,
                "the tracking error passed {} {}, the following_error_limit of the axis file's [control] (an unstable loop, or a motion too fast for the motor)",
                SixDigits(1e3 * limit),
                match freedom {
                    Freedom::Linear => "mm",
                    Freedom::Rotary => "mrad",
                }
            ),
            Self::LeftStroke => f.write_str("the load left its stroke"),
            Self::LoadNotFound => f.write_str(
                "no friction force is consistent with the load's motion at the end of a step (a load that jumps or falls with the speed, or a step too long for the load's mass)",
            ),
            Self::TooLong(steps) => write!(
                f,
                "the motion takes {} internal steps, more than {}",
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
    /// [`RunStopped`] if the run was given up.
    pub fn completed(self) -> Result<(), RunStopped> {
        match self {
            Self::Completed => Ok(()),
            Self::Stopped { time, reason, at } => Err(RunStopped { time, reason, at }),
        }
    }
}
