//! A log file that is written aside and put in place whole.

use std::io;
use std::path::Path;

use atomic_write_file::AtomicWriteFile;

use super::csv::CsvSink;
use super::in_place::in_place;
use super::{LogSink, WriteError, WriteProblem};
use crate::log::Log;

type Sink = Box<dyn LogSink<End = AtomicWriteFile>>;

/// A format that logs are written in.
struct Format {
    /// Of its files, without the point; the name of its feature, where it has one.
    extension: &'static str,
    /// None if the feature is left out.
    sink: Option<fn(AtomicWriteFile) -> Sink>,
}

/// All formats, one line each.
const FORMATS: [Format; 3] = [
    Format::new("csv", Some(|file| Box::new(CsvSink::new(file)))),
    Format::new("parquet", PARQUET),
    Format::new("mat", MAT),
];

#[cfg(feature = "parquet")]
const PARQUET: Option<fn(AtomicWriteFile) -> Sink> =
    Some(|file| Box::new(super::parquet::ParquetSink::new(file)));
#[cfg(not(feature = "parquet"))]
const PARQUET: Option<fn(AtomicWriteFile) -> Sink> = None;

#[cfg(feature = "mat")]
const MAT: Option<fn(AtomicWriteFile) -> Sink> =
    Some(|file| Box::new(super::mat::MatSink::new(file)));
#[cfg(not(feature = "mat"))]
const MAT: Option<fn(AtomicWriteFile) -> Sink> = None;

impl Format {
    const fn new(extension: &'static str, sink: Option<fn(AtomicWriteFile) -> Sink>) -> Self {
        Self { extension, sink }
    }

    fn of(path: &Path) -> Result<fn(AtomicWriteFile) -> Sink, WriteProblem> {
        let found = path.extension().unwrap_or_default().to_string_lossy();
        let format = FORMATS
            .iter()
            .find(|format| found.eq_ignore_ascii_case(format.extension));
        let Some(format) = format else {
            let valid = FORMATS.map(|format| format!(".{}", format.extension));
            return Err(WriteProblem::Extension {
                found: found.into_owned(),
                valid: valid.join(" or "),
            });
        };
        format.sink.ok_or(WriteProblem::LeftOut {
            feature: format.extension,
        })
    }
}

/// A log file that grows block by block, in the format of its extension ([`write`](super::write)).
///
/// It is written to a temporary file in the same folder. [`finish`](LogSink::finish) puts it
/// in place; dropped before that, it leaves what stood there. CSV holds nothing in memory,
/// Parquet one row group, MAT all numbers, 8 bytes each: it says their count first.
pub struct LogFile {
    sink: Sink,
}

impl std::fmt::Debug for LogFile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LogFile").finish_non_exhaustive()
    }
}

impl LogFile {
    /// Begins a file.
    ///
    /// # Errors
    /// [`WriteProblem::Extension`], [`WriteProblem::LeftOut`], or [`WriteProblem::Io`] if
    /// nothing can be written to the folder.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, WriteError> {
        let path = path.as_ref();
        let sink = Format::of(path).map_err(|problem| WriteError::of(path, problem))?;
        let file = AtomicWriteFile::open(path)
            .map_err(|e| WriteError::io(path, "create a file in its folder", e))?;
        Ok(Self { sink: sink(file) })
    }
}

impl LogSink for LogFile {
    type End = ();

    fn write(&mut self, block: &Log) -> io::Result<()> {
        self.sink.write(block)
    }

    fn note(&mut self, name: &str, text: &str) -> io::Result<()> {
        self.sink.note(name, text)
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        in_place(self.sink.finish()?)
    }
}
