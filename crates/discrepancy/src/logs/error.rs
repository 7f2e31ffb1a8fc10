//! Why a log cannot be used.

use axis_log::intake::SHORT_GAP;
use axis_log::quality::SamplingError;
use axis_sim::BalanceError;
use thiserror::Error;

use super::standstill::REST_TIME;

/// Why a log cannot be used. The message names the file first.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LogSetError {
    /// Samples that are not uniform in time.
    #[error("{file}: {reason}")]
    Sampling {
        /// The log.
        file: String,
        /// What is wrong.
        reason: SamplingError,
    },
    /// No torque balance can be made of it.
    #[error("{file}: {reason}")]
    Balance {
        /// The log.
        file: String,
        /// What it lacks.
        reason: BalanceError,
    },
    /// A channel that never changes.
    #[error(
        "{file}: channel \"{channel}\" has the same value in every sample: it is not connected, or belongs to another axis; leave the column out, or map another one to it in a [[log.column]]"
    )]
    Constant {
        /// The log.
        file: String,
        /// Its channel.
        channel: String,
    },
    /// Position and reference differ by the factor between two units.
    #[error(
        "{file}: \"position_m\" is {factor:.4e} times \"position_ref_m\" ({guess}): give the column a scale in the axis file, [[log.column]] source = …, channel = \"position_m\", scale = {scale}"
    )]
    Unit {
        /// The log.
        file: String,
        /// Measured by reference.
        factor: f64,
        /// In words.
        guess: &'static str,
        /// What would correct it.
        scale: f64,
    },
    /// Nothing shows where the load of an axis is that has no sensor there.
    #[error(
        "{file}: neither \"motor_angle_rad\" nor \"{channel}\": the axis has no sensor at the load, so that one of them must show its motion; map a column to one of them in a [[log.column]]"
    )]
    NoPosition {
        /// The log.
        file: String,
        /// The channel of the load's position on this axis.
        channel: &'static str,
    },
    /// Samples too far apart for a replay.
    #[error(
        "{file}: {rate:.4} Hz: a replay of a controller needs {least} Hz at least, as slower samples do not show the reference that the controller followed; record faster, or, if the log has a torque, force or current, leave [control] out of the axis file (or use --balance)"
    )]
    TooSlow {
        /// The log.
        file: String,
        /// Its rate, Hz.
        rate: f64,
        /// What is needed, Hz.
        least: f64,
    },
    /// Too long a time without measurement.
    #[error(
        "{file}: \"{channel}\" was not measured for {samples} samples from t = {time:.4} s on: at most {SHORT_GAP} in a row can be bridged; split the log there"
    )]
    Hole {
        /// The log.
        file: String,
        /// Its channel.
        channel: String,
        /// Samples in a row.
        samples: usize,
        /// When they begin, s.
        time: f64,
    },
    /// Channels that do not agree with each other, by a unit, a sign or a zero.
    #[error("{file}: {what}; if that is so, these lines in the axis file correct it:\n{lines}")]
    Mapping {
        /// The log.
        file: String,
        /// Which channels, and what they look like.
        what: String,
        /// Lines for the axis file.
        lines: String,
    },
    /// Positions that the axis cannot take.
    #[error(
        "{file}: the {channel} is {position:.6} at t = {time:.4} s, outside the axis' stroke of {minimum} to {maximum} {unit}: the log belongs to another axis, is in another unit, or counts from another zero (offset of its [[log.column]])"
    )]
    OffStroke {
        /// The log.
        file: String,
        /// Its channel.
        channel: &'static str,
        /// Where, m or rad.
        position: f64,
        /// When, s.
        time: f64,
        /// Least position, m or rad.
        minimum: f64,
        /// Greatest position, m or rad.
        maximum: f64,
        /// Unit of the positions.
        unit: &'static str,
    },
    /// The load does not follow the reference at all.
    #[error(
        "{file}: at t = {time:.4} s the load is {error:.6} {unit} from its reference, more than a tenth of the motion's {travel:.6} {unit}: the two columns are not of one axis and one time"
    )]
    NotFollowing {
        /// The log.
        file: String,
        /// When, s.
        time: f64,
        /// Reference minus measured, m or rad.
        error: f64,
        /// Range of the reference, m or rad.
        travel: f64,
        /// Unit of both.
        unit: &'static str,
    },
    /// Nothing moves, or only one way.
    #[error(
        "{file}: the motion is too poor to tell effects apart: {missing}; record a move and its return, with a standstill between"
    )]
    Poor {
        /// The log.
        file: String,
        /// What it lacks.
        missing: &'static str,
    },
    /// It does not stand still before its last move, so a simulation cannot begin like it.
    #[error(
        "{file}: starts in motion, at {speed:.4} m/s, and does not stand still for {REST_TIME} s (reference, position and motor) before its last move: the log does not show the loop's state at its start; record from standstill, or pause for half a second"
    )]
    NeverRests {
        /// The log.
        file: String,
        /// At its start, m/s.
        speed: f64,
    },
    /// The same samples to fit and to check, or to test.
    #[error(
        "{check} holds the same samples as {fit}: check and test logs must be motion that no other log shows; give another log"
    )]
    SameLog {
        /// Given to fit.
        fit: String,
        /// Given to check.
        check: String,
    },
    /// A part of one log in the other.
    #[error(
        "{check} holds {samples} samples of {fit}, from t = {from:.4} to {to:.4} s: check and test logs must be motion that no other log shows; give another log, or cut that part out of one of them"
    )]
    SharedPart {
        /// Given to fit.
        fit: String,
        /// Given to check.
        check: String,
        /// Samples that both have.
        samples: usize,
        /// Where they begin and end in the check log, s.
        from: f64,
        /// See `from`.
        to: f64,
    },
}
