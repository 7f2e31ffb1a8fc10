//! Log to CSV.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use atomic_write_file::AtomicWriteFile;

use crate::error::{CsvError, CsvProblem};
use crate::log::Log;

/// Writes a log as a CSV file that [`read_csv`](crate::read_csv) reads back to
/// the same bits.
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
/// Numbers take the fewest digits that read back to the same `f64`.
///
/// # Errors
/// Those of the writer.
pub fn write_csv_to(writer: impl Write, log: &Log) -> io::Result<()> {
    let mut out = BufWriter::new(writer);
    let names: Vec<&str> = log.channels().iter().map(|c| c.name.as_str()).collect();
    let mut text = csv::WriterBuilder::new().from_writer(&mut out);
    text.write_record(&names)?;
    text.flush()?;
    drop(text);
    for k in 0..log.len() {
        for (index, channel) in log.channels().iter().enumerate() {
            if index > 0 {
                out.write_all(b",")?;
            }
            write_number(&mut out, channel.samples[k])?;
        }
        out.write_all(b"\n")?;
    }
    out.flush()
}

/// Both forms are the shortest that round-trip; the exponent form keeps very
/// small and very large magnitudes from becoming rows of zeros.
fn write_number(out: &mut impl Write, value: f64) -> io::Result<()> {
    let magnitude = value.abs();
    if magnitude == 0.0 || (1e-5..1e16).contains(&magnitude) {
        write!(out, "{value}")
    } else {
        write!(out, "{value:e}")
    }
}

fn write_whole(path: &Path, log: &Log) -> Result<(), CsvProblem> {
    let io = |action| move |source| CsvProblem::Io { action, source };
    let file = AtomicWriteFile::open(path).map_err(io("create a file in its folder"))?;
    write_csv_to(file.as_file(), log).map_err(io("write it"))?;
    // Before the commit, which leaves the file aside behind where flushing fails.
    file.sync_all().map_err(io("flush it to the disk"))?;
    file.commit().map_err(io("put it in place"))
}
