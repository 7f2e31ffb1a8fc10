//! Why nothing was learned.

use thiserror::Error;

use crate::CompensatorError;

/// Why nothing was learned of a log; the model stays as it was.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum AdaptError {
    /// The model or the prior is not valid.
    #[error(transparent)]
    Setting(#[from] CompensatorError),
    /// The log is too short to be smoothed.
    #[error("the log has {samples} samples, too few to learn from: it takes at least {least}")]
    TooShort {
        /// Its samples.
        samples: usize,
        /// How many it takes.
        least: usize,
    },
    /// A value that no sensor shows.
    #[error("sample {sample}: {what} = {value} is not valid: it must be from -1e9 to 1e9")]
    Value {
        /// Which sample, from 0.
        sample: usize,
        /// Which channel.
        what: &'static str,
        /// The value.
        value: f64,
    },
    /// The axis hardly moved.
    #[error(
        "the load moved by {travel} (m or rad): learning takes at least {least}, several times what friction needs to break away"
    )]
    Standstill {
        /// Greatest distance between two measured positions, m or rad.
        travel: f64,
        /// How much it takes, m or rad.
        least: f64,
    },
    /// The command was at its limit.
    #[error(
        "the command was at its limit in {share:.0} % of the samples: the torque is not known there"
    )]
    Saturated {
        /// Share of the samples near one whose command was at its limit, %.
        share: f64,
    },
    /// Nothing of the model can be adapted.
    #[error("nothing to adapt: every deviation of the prior is 0, or the model has no such part")]
    Nothing,
    /// The motion and the torque do not belong together as in the model.
    #[error(
        "the model explains too little of the log: a residual of {residual} N·m RMS remains of {torque} N·m; the log may belong to another axis, or the model is far off"
    )]
    Unexplained {
        /// RMS of what is left, N·m.
        residual: f64,
        /// RMS of the torque, N·m.
        torque: f64,
    },
    /// Prior and earlier moves hold the parameters where this log is explained worse.
    #[error(
        "the log disagrees with what was learned before: the torque left unexplained would rise from {before} to {after} N·m; forget() or step_back() would let it be learned"
    )]
    NoBetter {
        /// RMS of what was left before, N·m.
        before: f64,
        /// And after, N·m.
        after: f64,
    },
}
