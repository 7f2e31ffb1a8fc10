//! What can be wrong with a log, in memory or in a file.

use thiserror::Error;

use crate::unit::suffix_list;

/// A log that cannot be built, or a channel that is not in it.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LogError {
    /// No channel, or channels without samples.
    #[error("the log is empty: it needs the channel \"t_s\" with at least one sample")]
    Empty,
    /// The first channel is not the time.
    #[error("the first channel is \"{found}\": it must be \"t_s\", the time in seconds")]
    TimeNotFirst {
        /// Name of the channel that stands first.
        found: String,
    },
    /// The name of a channel does not end in a known unit.
    #[error(
        "channel \"{name}\" has no known unit suffix: end the name in one of {}",
        suffix_list()
    )]
    UnitSuffix {
        /// Name of the channel.
        name: String,
    },
    /// The unit given and the suffix of the name disagree.
    #[error("channel \"{name}\" says unit \"{unit}\", but its suffix stands for \"{expected}\"")]
    UnitMismatch {
        /// Name of the channel.
        name: String,
        /// Unit that the channel carries.
        unit: String,
        /// Unit that the suffix stands for.
        expected: &'static str,
    },
    /// Two channels of one name.
    #[error("channel \"{name}\" occurs twice: every name must be unique")]
    Duplicate {
        /// The name.
        name: String,
    },
    /// A channel with more or fewer samples than the time.
    #[error("channel \"{name}\" has {found} samples: it must have {expected}, as \"t_s\" has")]
    Length {
        /// Name of the channel.
        name: String,
        /// Its number of samples.
        found: usize,
        /// Number of instants of the log.
        expected: usize,
    },
    /// A sample that is NaN or infinite.
    #[error("channel \"{name}\", sample {index}: {value} is not a finite number")]
    NotFinite {
        /// Name of the channel.
        name: String,
        /// Index of the sample, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Time that stands still or runs backwards.
    #[error(
        "channel \"t_s\", sample {index}: {value} s does not come after {previous} s: \
         time must increase strictly"
    )]
    TimeNotIncreasing {
        /// Index of the later sample, from 0.
        index: usize,
        /// Time of the sample before, s.
        previous: f64,
        /// Time of this sample, s.
        value: f64,
    },
    /// A channel that was asked for and is not there.
    #[error("no channel \"{name}\": the log has {}", quoted(available))]
    MissingChannel {
        /// The name that was asked for.
        name: String,
        /// The names that exist.
        available: Vec<String>,
    },
    /// Decimation by zero.
    #[error("cannot keep every {every}th sample: the factor must be 1 or more")]
    Decimation {
        /// The factor that was given.
        every: usize,
    },
}

/// A CSV file that cannot be read or written: which one, and why.
#[derive(Debug, Error)]
#[error("{file}: {problem}")]
pub struct CsvError {
    /// Path of the file, or the name given to the reader.
    pub file: String,
    /// What is wrong, with line and column where there is one.
    pub problem: CsvProblem,
}

/// What is wrong in a CSV file. Lines and columns are counted from 1.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CsvProblem {
    /// No header line.
    #[error("the file is empty: its first line must name the columns, \"t_s\" among them")]
    NoHeader,
    /// A header, and no rows.
    #[error("line {line}: no data after the header: at least one row is needed")]
    NoRows {
        /// Line of the header.
        line: u64,
    },
    /// A required column is not in the header.
    #[error(
        "line {line}: no column \"{column}\": the header has {}",
        quoted(available)
    )]
    MissingColumn {
        /// Line of the header.
        line: u64,
        /// The column that is required.
        column: String,
        /// The columns that exist.
        available: Vec<String>,
    },
    /// The header names a column twice.
    #[error(
        "line {line}, column {first} and column {second}: \"{}\" occurs twice",
        clip(name)
    )]
    DuplicateColumn {
        /// Line of the header.
        line: u64,
        /// The name.
        name: String,
        /// Number of the first column of that name.
        first: usize,
        /// Number of the second column of that name.
        second: usize,
    },
    /// A column name without a known unit.
    #[error(
        "line {line}, column {column}: \"{}\" has no known unit suffix: end the name in \
         one of {}",
        clip(name),
        suffix_list()
    )]
    UnitSuffix {
        /// Line of the header.
        line: u64,
        /// Number of the column.
        column: usize,
        /// The name.
        name: String,
    },
    /// More columns than a log has.
    #[error("line {line}: {found} columns: at most {most} are read")]
    TooManyColumns {
        /// Line of the header.
        line: u64,
        /// Its columns.
        found: usize,
        /// How many are read.
        most: usize,
    },
    /// A row with more or fewer fields than the header.
    #[error("line {line}: {found} fields: the header has {expected}")]
    Ragged {
        /// Line of the row.
        line: u64,
        /// Fields of the row.
        found: usize,
        /// Fields of the header.
        expected: usize,
    },
    /// A field that does not hold a number.
    #[error(
        "line {line}, column {column} (\"{}\"): \"{}\" is not a number",
        clip(name),
        clip(text)
    )]
    NotANumber {
        /// Line of the row.
        line: u64,
        /// Number of the column.
        column: usize,
        /// Name of the column.
        name: String,
        /// The field.
        text: String,
    },
    /// A field that holds NaN, an infinity, or a number too large for `f64`.
    #[error(
        "line {line}, column {column} (\"{}\"): \"{}\" is not a finite number",
        clip(name),
        clip(text)
    )]
    NotFinite {
        /// Line of the row.
        line: u64,
        /// Number of the column.
        column: usize,
        /// Name of the column.
        name: String,
        /// The field.
        text: String,
    },
    /// Time that stands still or runs backwards.
    #[error(
        "line {line}, column {column} (\"t_s\"): {value} s does not come after {previous} s: \
         time must increase strictly"
    )]
    TimeNotIncreasing {
        /// Line of the later row.
        line: u64,
        /// Number of the column.
        column: usize,
        /// Time of the row before, s.
        previous: f64,
        /// Time of this row, s.
        value: f64,
    },
    /// Bytes that are not UTF-8, or no text.
    #[error("line {line}: not UTF-8 text: save it as that")]
    NotText {
        /// Line of the first such byte.
        line: u64,
    },
    /// The parser failed.
    #[error("{0}")]
    Csv(#[from] csv::Error),
    /// The file cannot be opened, read, written or put in place.
    #[error("cannot {action}: {source}")]
    Io {
        /// What was being done.
        action: &'static str,
        /// Why it failed.
        source: std::io::Error,
    },
}

/// How many names a message lists.
const LISTED: usize = 30;
/// How many characters of a name or field a message shows.
const SHOWN: usize = 60;

pub(crate) fn quoted(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    let quoted = names.iter().take(LISTED);
    let quoted: Vec<String> = quoted.map(|n| format!("\"{}\"", clip(n))).collect();
    match names.len().saturating_sub(LISTED) {
        0 => quoted.join(", "),
        more => format!("{} and {more} more", quoted.join(", ")),
    }
}

/// What the extension of a file's name is, in words.
pub(crate) fn extension(found: &str) -> String {
    match found {
        "" => "the name has no extension".to_owned(),
        found => format!("the extension is \"{}\"", clip(found)),
    }
}

/// What a message shows of a text from a file: its beginning, without control characters.
pub(crate) fn clip(text: &str) -> String {
    let mut shown: String = (text.chars().take(SHOWN))
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect();
    if text.chars().nth(SHOWN).is_some() {
        shown.push('…');
    }
    shown
}
