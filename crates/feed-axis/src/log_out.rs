//! Where a log goes that grows while a run goes on: to a file, or as CSV to standard output.

use std::ffi::OsString;
use std::io::{self, BufWriter, Stdout, Write};
use std::path::{Path, PathBuf};

use axis_log::{CsvSink, Log, LogFile, LogSink, WriteProblem};
use clap::builder::{OsStringValueParser, TypedValueParser};
use miette::{IntoDiagnostic, Result, WrapErr, miette};

use crate::exit::{not_out, wrong_use};
use crate::out_file;
use crate::output;
use crate::terminal::{Format, Terminal};

/// Reads where a log goes: `-`, or the name of a file.
pub fn log() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|name: OsString| match name.to_str() {
        Some(PIPED) => Ok(name.into()),
        _ => out_file::named(name, "log.csv"),
    })
}

/// The name of standard output.
const PIPED: &str = "-";

/// A log on its way.
pub enum LogOut {
    /// Written aside, and put in place whole.
    File(LogFile),
    /// CSV, row by row. Results then go to standard error.
    Piped(CsvSink<BufWriter<Stdout>>),
}

impl LogOut {
    /// Begins a log at `path`, `-` for standard output.
    ///
    /// # Errors
    /// A format that is none; a folder that cannot be written to; `--format json`, which has standard output for itself.
    pub fn begin(path: &Path) -> Result<Self> {
        if !is_piped(path) {
            let file = LogFile::create(path).map_err(|e| match e.problem {
                WriteProblem::Extension { .. } => wrong_use(format!("--log {e}")),
                _ => miette!(e),
            });
            return Ok(Self::File(file.wrap_err_with(|| unwritten(path))?));
        }
        if Terminal::get().format == Format::Json {
            return Err(wrong_use(
                "--log - and --format json both write to standard output; give the log a file, such as --log log.csv",
            ));
        }
        output::results_aside();
        Ok(Self::Piped(CsvSink::new(BufWriter::new(io::stdout()))))
    }
}

/// Whether a log at `path` goes to standard output.
pub fn is_piped(path: &Path) -> bool {
    path == Path::new(PIPED)
}

/// Names the log in what its writing came to.
///
/// # Errors
/// That of `written`.
pub fn written(path: &Path, written: io::Result<()>) -> Result<()> {
    match is_piped(path) {
        true => written.map_err(|e| not_out(&e)),
        false => written.into_diagnostic().wrap_err_with(|| unwritten(path)),
    }
}

impl LogSink for LogOut {
    type End = ();

    fn write(&mut self, block: &Log) -> io::Result<()> {
        match self {
            Self::File(file) => file.write(block),
            Self::Piped(csv) => csv.write(block),
        }
    }

    fn note(&mut self, name: &str, text: &str) -> io::Result<()> {
        match self {
            Self::File(file) => file.note(name, text),
            Self::Piped(csv) => csv.note(name, text),
        }
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        match *self {
            Self::File(file) => Box::new(file).finish(),
            Self::Piped(csv) => Box::new(csv).finish()?.flush(),
        }
    }
}

fn unwritten(path: &Path) -> String {
    format!("cannot write the log {}", path.display())
}
