//! Why files cannot be made one log.

use thiserror::Error;

use crate::error::LogError;
use crate::read_error::ReadError;

/// Why files cannot be made one log. The message names the file first.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum IntakeError {
    /// No file was given.
    #[error("no file: give at least one")]
    None,
    /// A file that cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Too few rows to know the sampling period.
    #[error(
        "{file}: {rows} row(s): at least 2 are needed to move channels in time or to join files"
    )]
    TooShort {
        /// The file.
        file: String,
        /// Its rows.
        rows: usize,
    },
    /// Time stamps with longer gaps than samples.
    #[error(
        "{file}: its time stamps span {grid} sampling periods and have {rows} rows: most of it \
         is missing; split the file at its gaps"
    )]
    Sparse {
        /// The file.
        file: String,
        /// Its rows.
        rows: usize,
        /// Rows without the gaps.
        grid: usize,
    },
    /// Instants too far off an even grid to be moved to one.
    #[error(
        "{file}: the instant t_s = {time:.6} s is {:.0} % of a period ({period:.3e} s) off the \
         even grid: at most {:.0} % can be resampled; check the time column and its unit",
        100.0 * jitter, 100.0 * most
    )]
    Jitter {
        /// The file.
        file: String,
        /// The instant, s.
        time: f64,
        /// Its distance as a share of the period.
        jitter: f64,
        /// The period, s.
        period: f64,
        /// What can be resampled.
        most: f64,
    },
    /// Files that share no time.
    #[error(
        "{files}: their channels, moved by their delays, share {overlap:.4} s: at least two \
         periods of {period:.3e} s are needed; do the clocks start together? If not, set delay_ms of the columns of one file"
    )]
    NoOverlap {
        /// The files.
        files: String,
        /// What they share, s; negative where there is time between them.
        overlap: f64,
        /// The period of the joined log, s.
        period: f64,
    },
    /// A rate to resample to that is out of range.
    #[error(
        "the rate {rate} Hz cannot be resampled to: it must be finite, above 0, and at most {most:.6} Hz, that of the fastest file"
    )]
    Rate {
        /// The rate given, Hz.
        rate: f64,
        /// Rate of the fastest file, Hz.
        most: f64,
    },
    /// A channel that no file has, or columns that make no log.
    #[error("{file}: {problem}")]
    Log {
        /// The files.
        file: String,
        /// What is wrong.
        problem: LogError,
    },
}
