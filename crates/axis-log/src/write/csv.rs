//! Log to CSV.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use atomic_write_file::AtomicWriteFile;

use super::columns::Names;
use super::{LogSink, in_a_line, invalid};
use crate::error::{CsvError, CsvProblem};
use crate::log::Log;

/// Writes a log as a CSV file that [`read_csv`](crate::read_csv) reads back to
/// the same bits, whatever the file's extension, unless samples are
/// [missing](Log::missing): they are `NaN`, which [`intake`](crate::intake) reads.
///
/// The file appears whole or not at all: the text is written to a temporary
/// file in the same folder, flushed to the disk and renamed, and the folder is
/// flushed; a file of that name is replaced, and its mode kept. A process that is
/// killed may leave the temporary file, `.<name>.<six letters or digits>`, and so
/// does a rename that fails, on a folder of that name.
///
/// # Errors
/// A [`CsvError`] with the path: folder missing or not writable, disk full. A
/// file that stood there before is then unchanged.
pub fn write_csv(path: impl AsRef<Path>, log: &Log) -> Result<(), CsvError> {
    let path = path.as_ref();
    write_whole(path, log).map_err(|problem| CsvError {
        file: path.display().to_string(),
        problem,
    })
}

/// Writes a log as CSV text: one header line, one line for each instant.
///
/// Numbers take the fewest digits that read back to the same `f64`; a [missing](Log::missing)
/// sample is `NaN`.
///
/// # Errors
/// Those of the writer.
pub fn write_csv_to(writer: impl Write, log: &Log) -> io::Result<()> {
    let mut sink = CsvSink::new(writer);
    sink.write(log)?;
    Box::new(sink).finish().map(drop)
}

/// CSV text that grows block by block: the header once, then a line for each instant.
#[derive(Debug)]
pub struct CsvSink<W> {
    writer: W,
    names: Names,
}

impl<W: Write> CsvSink<W> {
    /// Text to `writer`, in large pieces.
    pub fn new(writer: W) -> Self {
        let names = Names::default();
        Self { writer, names }
    }
}

impl<W: Write> LogSink for CsvSink<W> {
    type End = W;

    fn write(&mut self, block: &Log) -> io::Result<()> {
        let is_first = self.names.take(block)?;
        let mut out = BufWriter::new(&mut self.writer);
        if is_first {
            write_header(&mut out, block)?;
        }
        let columns: Vec<_> = block
            .channels()
            .iter()
            .map(|c| block.with_holes(c))
            .collect();
        for k in 0..block.len() {
            for (index, samples) in columns.iter().enumerate() {
                if index > 0 {
                    out.write_all(b",")?;
                }
                write_number(&mut out, samples[k])?;
            }
            out.write_all(b"\n")?;
        }
        out.flush()
    }

    fn note(&mut self, name: &str, text: &str) -> io::Result<()> {
        writeln!(self.writer, "# {name}: {}", in_a_line(text))
    }

    fn finish(mut self: Box<Self>) -> io::Result<W> {
        if self.names.are_empty() {
            return Err(invalid("no instants: a log has at least one"));
        }
        self.writer.flush()?;
        Ok(self.writer)
    }
}

fn write_header(out: &mut impl Write, log: &Log) -> io::Result<()> {
    let names = log.channels().iter().map(|c| c.name.as_str());
    let mut text = csv::WriterBuilder::new().from_writer(out);
    text.write_record(names)?;
    text.flush()
}

/// Both forms are the shortest that round-trip; the exponent form keeps very
/// small and very large magnitudes from becoming rows of zeros.
fn write_number(out: &mut impl Write, value: f64) -> io::Result<()> {
    let magnitude = value.abs();
    if value.is_nan() || magnitude == 0.0 || (1e-5..1e16).contains(&magnitude) {
        write!(out, "{value}")
    } else {
        write!(out, "{value:e}")
    }
}

fn write_whole(path: &Path, log: &Log) -> Result<(), CsvProblem> {
    let io = |action| move |source| CsvProblem::Io { action, source };
    let file = AtomicWriteFile::open(path).map_err(io("create a file in its folder"))?;
    write_csv_to(file.as_file(), log).map_err(io("write it"))?;
    super::in_place::in_place(file).map_err(io("put it in place"))
}
