//! Why a loop has no margins, or no gains.

use axis_sim::{PlanModelError, SetupError};
use feed_dynamics::DriveError;
use frequency_response::ResponseError;
use thiserror::Error;

/// Why a loop cannot be analysed or tuned.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoopError {
    /// The axis makes no linear model.
    #[error(transparent)]
    Model(#[from] PlanModelError),
    /// A part does not fit the axis.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The load cannot be at a position.
    #[error("the load cannot be at {position}: {error}")]
    Position {
        /// m or rad.
        position: f64,
        /// Why not.
        error: DriveError,
    },
    /// A position is not on the axis' stroke.
    #[error(
        "position {position} is outside the axis' stroke; valid: from {least} to {most} (m or rad)"
    )]
    OutsideStroke {
        /// m or rad.
        position: f64,
        /// Least position of the stroke.
        least: f64,
        /// Greatest.
        most: f64,
    },
    /// The control has no loop that could be cut.
    #[error(
        "the axis has no loop whose margins are known ([control] is {kind}); valid: kind = \"p-pi\" or \"p-p\", a position controller over a speed controller, or \"pid\" with proportional and derivative above 0"
    )]
    Control {
        /// Its kind.
        kind: &'static str,
    },
    /// A setting is not valid.
    #[error("{name} is {value}; valid: {valid}")]
    Setting {
        /// Of the setting.
        name: &'static str,
        /// As given.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// No gains keep the constraints.
    #[error(
        "no gains were found that keep the sensitivity at {most} and at {most_late} with one more cycle of delay: the best have {found:.3} and {found_late:.3}; valid: a larger limit, a narrower range of mass, or a drive with less delay"
    )]
    NoGains {
        /// Limit of the sensitivity.
        most: f64,
        /// With one more cycle.
        most_late: f64,
        /// What the best have.
        found: f64,
        /// With one more cycle.
        found_late: f64,
    },
    /// A log has not what a response is estimated from.
    #[error("the log cannot be used for a frequency response: {0}")]
    Log(String),
    /// A response cannot be estimated.
    #[error("no frequency response: {0}")]
    Response(#[from] ResponseError),
    /// A measured response must not be tuned on.
    #[error("gains cannot be tuned on measured response {number}: {what}")]
    Measured {
        /// Of the response, from 1.
        number: usize,
        /// What is wrong with it.
        what: String,
    },
    /// The nonlinear simulation shows what the linear model does not.
    #[error(
        "with the tuned gains the simulated axis {what}, and it does not with those of the file; the limit of the sensitivity was lowered to {most:.3}, which did not help. Effects of the axis file that the linear model lacks (a body that swings, backlash) may be the cause: remove them, or tune with a lower limit"
    )]
    Simulation {
        /// What it does.
        what: String,
        /// Lowest limit that was tried.
        most: f64,
    },
}
