//! Logs to files, by their extension.

#[cfg(feature = "parquet")]
mod arrow_schema;
mod columns;
mod csv;
mod file;
mod in_place;
#[cfg(feature = "mat")]
mod mat;
#[cfg(feature = "mat")]
mod mat_bytes;
#[cfg(feature = "parquet")]
mod parquet;

use std::io;
use std::path::Path;

use thiserror::Error;

use crate::error::extension;

pub use csv::{CsvSink, write_csv, write_csv_to};
pub use file::LogFile;

use crate::log::Log;

/// Where a log goes in pieces, one behind the other.
pub trait LogSink {
    /// What is left when all is written.
    type End;

    /// Adds the instants of `block` behind those before. Every block has the channels of the
    /// first one, in its order. [Missing](Log::missing) samples are NaN.
    ///
    /// # Errors
    /// The writer's; [`io::ErrorKind::InvalidData`] if the channels are others.
    fn write(&mut self, block: &Log) -> io::Result<()>;

    /// Says something of the whole log inside the file, behind the blocks, such as why its run stopped: in CSV
    /// a last line `# name: text`, in Parquet an entry of the key-value metadata, in MAT a text in the struct
    /// `notes`. `name` is one of a variable.
    ///
    /// # Errors
    /// The writer's.
    fn note(&mut self, name: &str, text: &str) -> io::Result<()>;

    /// Ends the file.
    ///
    /// # Errors
    /// The writer's; [`io::ErrorKind::InvalidData`] if there was no block, or where the
    /// format cannot hold what there was.
    fn finish(self: Box<Self>) -> io::Result<Self::End>;
}

/// Writes a log as CSV, Parquet or MAT version 5, by the extension of the file (`.csv`,
/// `.parquet`, `.mat`, in any case). [`read_log`](crate::read_log) reads it back to the same
/// bits. [Missing](Log::missing) samples are NaN in all three: `read_log` refuses such a file,
/// [`intake`](crate::intake) reads it with the same marks.
///
/// - **CSV**: the units are the suffixes of the names.
/// - **Parquet** (feature `parquet`): a required `DOUBLE` a channel, Snappy, row groups of
///   65 536 instants. The file's key-value metadata hold `axis-log`, the version of the
///   layout ([`LAYOUT`]), and `ARROW:schema`, in which each field has its unit under the
///   metadata key `unit` ([Arrow columnar format](https://arrow.apache.org/docs/format/Columnar.html#schema-message)).
/// - **MAT version 5** (feature `mat`): an N × 1 `double` a channel under its name, a 1 × 1
///   struct `units` with a text a channel, and `axis_log_version`; not compressed
///   ([MAT-File Format](https://www.mathworks.com/help/pdf_doc/matlab/matfile_format.pdf)).
///   A channel's name must be one of a variable: letters, digits, `_`, a letter first, at
///   most 63 characters.
///
/// The file appears whole or not at all, as with [`write_csv`].
///
/// # Errors
/// A [`WriteError`] with the path: another extension, a format that was left out, a channel
/// or size that the format cannot hold, folder missing or not writable, disk full. A file
/// that stood there before is then unchanged.
///
/// ```
/// use axis_log::{Channel, Log, Mapping, read_log, write};
///
/// let log = Log::new(vec![
///     Channel::new("t_s", vec![0.0, 1e-3])?,
///     Channel::new("position_m", vec![0.6, 0.601])?,
/// ])?;
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("run.csv");
/// write(&path, &log)?;
/// assert_eq!(read_log(&path, &Mapping::default(), &[])?, log);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(path: impl AsRef<Path>, log: &Log) -> Result<(), WriteError> {
    let path = path.as_ref();
    let mut file = LogFile::create(path)?;
    file.write(log)
        .and_then(|()| Box::new(file).finish())
        .map_err(|source| WriteError::io(path, "write it", source))
}

/// Version of the layout of Parquet and MAT files, as they say themselves. A change that
/// readers of the one before would not understand raises it.
pub const LAYOUT: u32 = 1;

/// A log file that cannot be written: which one, and why.
#[derive(Debug, Error)]
#[error("{file}: {problem}")]
pub struct WriteError {
    /// Path of the file.
    pub file: String,
    /// What is wrong.
    pub problem: WriteProblem,
}

/// Why a log file cannot be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteProblem {
    /// A file of no known format.
    #[error("{}: it must be {valid}", extension(found))]
    Extension {
        /// The extension, without the point.
        found: String,
        /// The extensions that there are.
        valid: String,
    },
    /// A format that this build of the crate leaves out.
    #[error(
        "this program was built without it: save the log as CSV, or build axis-log with its \
         feature \"{feature}\""
    )]
    LeftOut {
        /// Feature of the crate that writes it.
        feature: &'static str,
    },
    /// The file cannot be written or put in place.
    #[error("cannot {action}: {source}")]
    Io {
        /// What was being done.
        action: &'static str,
        /// Why it failed.
        source: io::Error,
    },
}

impl WriteError {
    fn of(path: &Path, problem: WriteProblem) -> Self {
        let file = path.display().to_string();
        Self { file, problem }
    }

    fn io(path: &Path, action: &'static str, source: io::Error) -> Self {
        Self::of(path, WriteProblem::Io { action, source })
    }
}

/// A text of one line.
fn in_a_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What a format cannot hold.
fn invalid(what: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what.into())
}
