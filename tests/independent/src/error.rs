//! What can go wrong.

use std::path::PathBuf;

use thiserror::Error;

/// Why no log was made. The message says what would be valid.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum IndependentError {
    /// There is no such case.
    #[error("there is no case \"{name}\"; the cases are {valid}")]
    Case {
        /// What was asked for.
        name: String,
        /// Names that exist.
        valid: String,
    },
    /// Newton's method did not find the table's speed.
    #[error(
        "at t = {time:.6} s no speed of the table goes with the forces on it: a hidden effect is too steep for steps of 10 µs"
    )]
    NotConverged {
        /// When, s.
        time: f64,
    },
    /// The table left the screw.
    #[error(
        "at t = {time:.4} s the table is at {position:.4} m, off the screw of 0 to {length} m: the loop is unstable, or the motion too long"
    )]
    OffScrew {
        /// When, s.
        time: f64,
        /// Of the table, m.
        position: f64,
        /// Of the screw, m.
        length: f64,
    },
    /// A file could not be written.
    #[error("{path}: {reason}")]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}
