//! Log to CSV.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::error::{CsvError, CsvProblem};
use crate::log::Log;

/// Writes a log as a CSV file that [`read_csv`](crate::read_csv) reads back to
/// the same bits.
///
/// The file appears whole or not at all: the text is written to a temporary
/// file in the same folder, flushed to the disk and renamed; a file of that
/// name is replaced. Its mode is 0644 on Unix.
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
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let file = NamedTempFile::new_in(folder).map_err(io("create a file in its folder"))?;
    write_csv_to(file.as_file(), log).map_err(io("write it"))?;
    make_readable(file.as_file()).map_err(io("set its mode"))?;
    file.as_file()
        .sync_all()
        .map_err(io("flush it to the disk"))?;
    match file.persist(path) {
        Ok(_) => Ok(()),
        Err(failed) => Err(io("put it in place")(failed.error)),
    }
}

/// Temporary files are created with mode 0600; a result is for all to read.
#[cfg(unix)]
fn make_readable(file: &File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_: &File) -> io::Result<()> {
    Ok(())
}
