//! What can be wrong with a log file of any format.

use std::fmt;

use thiserror::Error;

use crate::error::{CsvProblem, LogError, clip, extension, quoted};
use crate::mapping_error::MappingError;

/// A log file that cannot be read: which one, and why.
#[derive(Debug, Error)]
#[error("{file}: {problem}")]
pub struct ReadError {
    /// Path of the file.
    pub file: String,
    /// What is wrong, with line or row where there is one.
    pub problem: ReadProblem,
}

/// Where in a file a sample stands. All numbers count from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// In text.
    Line {
        /// Line of the file, comments and blank lines counted.
        line: u64,
        /// Number of the column.
        column: usize,
    },
    /// In a binary file.
    Row {
        /// Number of the sample.
        row: usize,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line { line, column } => write!(f, "line {line}, column {column}"),
            Self::Row { row } => write!(f, "row {row}"),
        }
    }
}

/// What is wrong with a log file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadProblem {
    /// A file of no known format.
    #[error(
        "{}: it must be .parquet, .mat, or of text .csv, .tsv, .txt, .dat or .asc",
        extension(found)
    )]
    Extension {
        /// The extension, without the point.
        found: String,
    },
    /// A format that this build of the crate leaves out.
    #[error(
        "this program was built without {format}: save the log as CSV, or build axis-log \
         with its feature \"{feature}\""
    )]
    LeftOut {
        /// Name of the format.
        format: &'static str,
        /// Feature of the crate that reads it.
        feature: &'static str,
    },
    /// A file that would take more memory than one of its size should.
    #[error(
        "the columns that are read claim {needed} bytes of memory, at most {most} \
         are taken for a file of {file} bytes: it is damaged; if it is not, split it or save \
         it as CSV"
    )]
    TooLarge {
        /// Bytes that the columns take in memory.
        needed: u64,
        /// Bytes that are taken for a file of that size.
        most: u64,
        /// Size of the file, bytes.
        file: usize,
    },
    /// A delay in the mapping, and a reader that does not take it out.
    #[error(
        "the mapping gives \"{channel}\" a delay: this reader does not move channels in time; \
         use axis_log::intake::prepare"
    )]
    Delay {
        /// The channel.
        channel: String,
    },
    /// The file cannot be opened or read.
    #[error("cannot {action}: {source}")]
    Io {
        /// What was being done.
        action: &'static str,
        /// Why it failed.
        source: std::io::Error,
    },
    /// The mapping is wrong, whatever the file.
    #[error("mapping: {0}")]
    Mapping(#[from] MappingError),
    /// Not CSV: no header, a ragged row, not text.
    #[error(transparent)]
    Csv(#[from] CsvProblem),
    /// Not Parquet, or Parquet of a kind that is not read.
    #[error("not readable as Parquet: {reason}; save it again, or as CSV")]
    Parquet {
        /// What the parser says.
        reason: String,
    },
    /// A file of another program of a kind that is not read, or damaged.
    #[error("not readable as {format}: {reason}")]
    Import {
        /// What the file seems to be.
        format: &'static str,
        /// What is wrong, with its place where there is one.
        reason: String,
    },
    /// Not a MAT file of version 5.
    #[error("not readable as MAT version 5: {reason}")]
    Mat {
        /// What is wrong.
        reason: String,
    },
    /// A required channel has no column.
    #[error(
        "no column for \"{channel}\"{}: the file has {}{}",
        mapped(channel, column), quoted(available), rest(*unreadable)
    )]
    MissingColumn {
        /// The channel that is required.
        channel: String,
        /// The column that the mapping names for it; its own name without one.
        column: String,
        /// The columns that exist.
        available: Vec<String>,
        /// Parts of a MAT file that are damaged.
        unreadable: usize,
    },
    /// Neither a time column nor a sample rate.
    #[error(
        "no time: map a column to \"t_s\" or give sample_rate_hz; the file has {}{}",
        quoted(available), rest(*unreadable)
    )]
    NoTime {
        /// The columns that exist.
        available: Vec<String>,
        /// Parts of a MAT file that are damaged.
        unreadable: usize,
    },
    /// A column whose name says another unit than the file says beside it.
    #[error(
        "column \"{}\": its name says {named}, the file says {} below it: map it, with the unit that is right",
        clip(name),
        clip(said)
    )]
    TwoUnits {
        /// Name of the column.
        name: String,
        /// The unit that stands beside the name.
        said: String,
        /// The one that its name ends in.
        named: &'static str,
    },
    /// Two columns of one name, and the name is wanted.
    #[error(
        "column {first} and column {second} are both named \"{}\": one must go",
        clip(name)
    )]
    DuplicateColumn {
        /// The name.
        name: String,
        /// Number of the first.
        first: usize,
        /// Number of the second.
        second: usize,
    },
    /// A wanted column that does not hold real numbers, one for each instant.
    #[error("column \"{}\" is {found}: {valid} is needed", clip(name))]
    Unreadable {
        /// Name of the column.
        name: String,
        /// What it is.
        found: String,
        /// What can be read.
        valid: &'static str,
    },
    /// Columns of different lengths (MAT).
    #[error(
        "\"{}\" has {found} samples: \"{}\" has {expected}, and they must agree",
        clip(name),
        clip(other)
    )]
    Length {
        /// Name of the column.
        name: String,
        /// Its samples.
        found: usize,
        /// Name of the column that sets the length: the time, if there is one.
        other: String,
        /// Its samples.
        expected: usize,
    },
    /// Columns, and no rows.
    #[error("no samples: at least one row is needed")]
    NoRows,
    /// A field or value that is not there.
    #[error(
        "{place} (\"{}\"): the value is missing: every row needs one",
        clip(name)
    )]
    MissingValue {
        /// Where.
        place: Place,
        /// Name of the column.
        name: String,
    },
    /// A field that does not hold a number.
    #[error("{place} (\"{}\"): \"{}\" is not a number", clip(name), clip(text))]
    NotANumber {
        /// Where.
        place: Place,
        /// Name of the column.
        name: String,
        /// The field.
        text: String,
    },
    /// NaN or an infinity, in the file or after scaling.
    #[error("{place} (\"{}\"): {value} is not a finite number", clip(name))]
    NotFinite {
        /// Where.
        place: Place,
        /// Name of the column.
        name: String,
        /// The value, in the unit of the channel.
        value: f64,
    },
    /// Time that stands still.
    #[error(
        "{place} (\"{}\"): the time {value} s is repeated: time must increase strictly",
        clip(name)
    )]
    TimeRepeated {
        /// Where, the later of the two.
        place: Place,
        /// Name of the column.
        name: String,
        /// The time, s.
        value: f64,
    },
    /// Time that runs backwards.
    #[error(
        "{place} (\"{}\"): the time falls from {previous} s to {value} s: rows must be \
         sorted by time",
        clip(name)
    )]
    TimeUnsorted {
        /// Where, the later of the two.
        place: Place,
        /// Name of the column.
        name: String,
        /// Time of the row before, s.
        previous: f64,
        /// Time of this row, s.
        value: f64,
    },
    /// The channels do not make a log.
    #[error(transparent)]
    Log(#[from] LogError),
}

fn mapped(channel: &str, column: &str) -> String {
    if channel == column {
        String::new()
    } else {
        format!(" (mapped from \"{}\")", clip(column))
    }
}

fn rest(unreadable: usize) -> String {
    match unreadable {
        0 => String::new(),
        1 => ", and one part that is damaged".to_owned(),
        n => format!(", and {n} parts that are damaged"),
    }
}
