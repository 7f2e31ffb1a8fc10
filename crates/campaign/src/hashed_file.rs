//! A Parquet file that holds its own hash, so that no damaged one is decoded.
//!
//! The hash stands in the key-value metadata of the footer, behind a marker, and is taken
//! over the whole file with zeros in its place.

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result, Seek, SeekFrom, Write};

/// Key of the metadata.
pub(crate) const KEY: &str = "campaign-hash";
const MARKER: &str = "blake3-of-file-with-zeros-here:";
const DIGITS: usize = 2 * blake3::OUT_LEN;

/// The value to write under [`KEY`], before the hash is known.
pub(crate) fn blank() -> String {
    format!("{MARKER}{}", "0".repeat(DIGITS))
}

/// Puts the hash of a finished file in its place.
pub(crate) fn seal(file: &mut File) -> Result<()> {
    let (place, _, hash) = hash(file)?;
    file.seek(SeekFrom::Start(place))?;
    file.write_all(hash.as_bytes())
}

/// Whether a file is as it was sealed.
pub(crate) fn is_whole(file: &mut File) -> Result<bool> {
    match hash(file) {
        Ok((_, found, hash)) => Ok(found == hash.as_bytes()),
        Err(e) if matches!(e.kind(), ErrorKind::InvalidData | ErrorKind::UnexpectedEof) => {
            Ok(false)
        }
        Err(e) => Err(e),
    }
}

/// Where the hash stands, what stands there, and what should.
fn hash(file: &mut File) -> Result<(u64, Vec<u8>, String)> {
    let length = file.metadata()?.len();
    let strange = || Error::new(ErrorKind::InvalidData, "not a sealed Parquet file");
    let end = length.checked_sub(8).ok_or_else(strange)?;
    let mut last = [0; 8];
    file.seek(SeekFrom::Start(end))?;
    file.read_exact(&mut last)?;
    let [a, b, c, d, magic @ ..] = last;
    let footer = u64::from(u32::from_le_bytes([a, b, c, d]));
    let start = end.checked_sub(footer).ok_or_else(strange)?;
    if &magic != b"PAR1" {
        return Err(strange());
    }
    let mut tail = Vec::new();
    file.seek(SeekFrom::Start(start))?;
    file.read_to_end(&mut tail)?;
    let at = tail
        .windows(MARKER.len())
        .position(|w| w == MARKER.as_bytes())
        .map(|at| at + MARKER.len())
        .ok_or_else(strange)?;
    let digits = tail.get_mut(at..at + DIGITS).ok_or_else(strange)?;
    let found = digits.to_vec();
    digits.fill(b'0');
    let mut hasher = blake3::Hasher::new();
    file.seek(SeekFrom::Start(0))?;
    hasher.update_reader((&*file).take(start))?;
    hasher.update(&tail);
    let hash = hasher.finalize().to_hex().to_string();
    Ok((start + at as u64, found, hash))
}
