//! Samples on disk: written as a stream, read back whole and checked.
//!
//! ```text
//! magic "AXSMPL\0\0" | schema u32 | count u64 | fingerprint [u8; 64]
//! count rows of S, Ṡ, S̈, I_qr, S(k+1) − S(k) as f64
//! blake3 of everything before it, 32 bytes
//! ```
//!
//! All numbers little-endian, SI units. A million samples take 40 MB and no memory.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use atomic_write_file::AtomicWriteFile;
use axis_sim::CycleInput;
use thiserror::Error;

use crate::linear_map::input_row;
use crate::sampling::{SampleSet, Sampler};

const MAGIC: &[u8; 8] = b"AXSMPL\0\0";
const SCHEMA: u32 = 1;
const ROW: usize = 5 * 8;
/// Rows simulated and written at a time.
const CHUNK: usize = 1 << 16;

/// Why a sample file could not be written or was refused.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SampleFileError {
    /// The system refused.
    #[error("cannot {action} the sample file {path}: {reason}")]
    Io {
        /// What was tried.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's reason.
        reason: std::io::Error,
    },
    /// A sample could not be simulated.
    #[error("the samples of {path} cannot be simulated: {reason}")]
    Simulation {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: Box<crate::PipelineError>,
    },
    /// The content is not what a whole sample file holds.
    #[error("the sample file {path} is refused: {what}; make it anew with the command sample")]
    Refused {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
}

/// Simulates all samples of a plan and writes them, a chunk at a time, as [`Writer`] does.
/// `each` is told how many rows a chunk had.
///
/// # Errors
/// [`SampleFileError::Io`] if the folder is not writable or the disk full;
/// [`SampleFileError::Simulation`] if a sample cannot be simulated.
pub fn write(
    path: &Path,
    sampler: &Sampler,
    fingerprint: &str,
    mut each: impl FnMut(usize),
) -> Result<(), SampleFileError> {
    let mut writer = Writer::create(path, sampler.count(), fingerprint)?;
    for start in (0..sampler.count()).step_by(CHUNK) {
        let end = (start + CHUNK).min(sampler.count());
        let samples = sampler.rows(start..end).map_err(|reason| {
            let path = path.to_owned();
            SampleFileError::Simulation {
                path,
                reason: Box::new(reason),
            }
        })?;
        for (input, increment) in samples.inputs.iter().zip(&samples.increments) {
            writer.put(input, *increment)?;
        }
        each(end - start);
    }
    writer.finish()
}

/// Writes a sample file row by row. It appears whole or not at all; a process that is
/// killed may leave what it wrote aside, `.<name>.<six letters or digits>`.
pub struct Writer {
    path: PathBuf,
    out: Hashing<BufWriter<AtomicWriteFile>>,
}

impl Writer {
    /// Begins a file of `count` rows, made from the axis with this fingerprint.
    ///
    /// # Errors
    /// [`SampleFileError::Io`].
    pub fn create(path: &Path, count: usize, fingerprint: &str) -> Result<Self, SampleFileError> {
        let failed = |reason| failed(path, reason);
        let aside = AtomicWriteFile::open(path).map_err(failed)?;
        let mut out = Hashing {
            file: BufWriter::new(aside),
            hasher: blake3::Hasher::new(),
        };
        let mut header = MAGIC.to_vec();
        header.extend(SCHEMA.to_le_bytes());
        header.extend((count as u64).to_le_bytes());
        header.extend(fixed(fingerprint));
        out.put(&header).map_err(failed)?;
        Ok(Self {
            path: path.to_owned(),
            out,
        })
    }

    /// Adds a row; as many as were told in all.
    ///
    /// # Errors
    /// [`SampleFileError::Io`].
    pub fn put(&mut self, input: &CycleInput, increment: f64) -> Result<(), SampleFileError> {
        let mut bytes = [0; ROW];
        let values = input_row(input);
        let values = values.iter().chain([&increment]);
        for (place, value) in bytes.chunks_exact_mut(8).zip(values) {
            place.copy_from_slice(&value.to_le_bytes());
        }
        let put = self.out.put(&bytes);
        put.map_err(|reason| failed(&self.path, reason))
    }

    /// Ends the file and puts it in place.
    ///
    /// # Errors
    /// [`SampleFileError::Io`].
    pub fn finish(mut self) -> Result<(), SampleFileError> {
        let failed = |reason| failed(&self.path, reason);
        let hash = self.out.hasher.finalize();
        (self.out.file).write_all(hash.as_bytes()).map_err(failed)?;
        let aside = self.out.file.into_inner();
        let aside = aside.map_err(|e| failed(e.into_error()))?;
        // Before the commit, which leaves the file aside behind where flushing fails.
        aside.sync_all().map_err(failed)?;
        aside.commit().map_err(failed)
    }
}

fn failed(path: &Path, reason: std::io::Error) -> SampleFileError {
    SampleFileError::Io {
        action: "write",
        path: path.to_owned(),
        reason,
    }
}

/// Reads a sample file that was made from the axis with this fingerprint.
///
/// # Errors
/// [`SampleFileError::Refused`] for a file that is truncated, changed, of
/// another schema or from another axis.
pub fn read(path: &Path, fingerprint: &str) -> Result<SampleSet, SampleFileError> {
    let failed = |reason| SampleFileError::Io {
        action: "read",
        path: path.to_owned(),
        reason,
    };
    let refused = |what: &str| SampleFileError::Refused {
        path: path.to_owned(),
        what: what.to_owned(),
    };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(failed)?;
    BufReader::new(file)
        .read_to_end(&mut bytes)
        .map_err(failed)?;

    let header = MAGIC.len() + 4 + 8 + 64;
    if bytes.len() < header + 32 {
        return Err(refused("it is too short (truncated?)"));
    }
    if &bytes[..8] != MAGIC {
        return Err(refused("it is not a sample file"));
    }
    let schema = u32::from_le_bytes([bytes[8], bytes[9], bytes[10], bytes[11]]);
    if schema != SCHEMA {
        let what = format!("its schema is {schema}, this program reads {SCHEMA}");
        return Err(refused(&what));
    }
    let (body, hash) = bytes.split_at(bytes.len() - 32);
    if blake3::hash(body).as_bytes() != hash {
        return Err(refused(
            "its checksum does not match (truncated or changed)",
        ));
    }
    let count = u64::from_le_bytes(std::array::from_fn(|i| bytes[12 + i]));
    if body[20..header] != fixed(fingerprint) {
        return Err(refused("it was made from another axis file"));
    }
    let rows = &body[header..];
    if rows.len() as u64 != count.saturating_mul(ROW as u64) {
        return Err(refused("its length does not match its header"));
    }
    let mut samples = SampleSet::default();
    for row in rows.chunks_exact(ROW) {
        let value = |i: usize| f64::from_le_bytes(std::array::from_fn(|b| row[8 * i + b]));
        samples.inputs.push(CycleInput {
            position: value(0),
            speed: value(1),
            acceleration: value(2),
            command: value(3),
        });
        samples.increments.push(value(4));
    }
    Ok(samples)
}

/// The fingerprint in its 64 bytes.
fn fixed(fingerprint: &str) -> [u8; 64] {
    let mut bytes = [0; 64];
    let given = fingerprint.as_bytes();
    let length = given.len().min(64);
    bytes[..length].copy_from_slice(&given[..length]);
    bytes
}

struct Hashing<W> {
    file: W,
    hasher: blake3::Hasher,
}

impl<W: Write> Hashing<W> {
    fn put(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.hasher.update(bytes);
        self.file.write_all(bytes)
    }
}
