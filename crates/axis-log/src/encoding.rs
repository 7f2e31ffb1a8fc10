//! The bytes of a text as UTF-8, however a program wrote it.

use crate::error::CsvProblem;

/// A text as UTF-8 without byte-order mark, its lines ended by `\n` or `\r\n`; anything that is no
/// text as it is.
///
/// UTF-16 is told by its byte-order mark, or by a zero in every other of the first four bytes.
/// What is not UTF-8 either is ISO 8859-1, which Windows and drives write for the signs of Western
/// languages. A file with a zero byte is not text.
pub(crate) fn plain(bytes: Vec<u8>) -> Result<Vec<u8>, CsvProblem> {
    if let Some((skip, unit)) = wide(&bytes) {
        let units = bytes[skip..].chunks_exact(2);
        let units: Vec<u16> = units.map(|pair| unit([pair[0], pair[1]])).collect();
        let text = String::from_utf16(&units).map_err(|_| CsvProblem::NotText { line: 1 })?;
        return Ok(with_line_ends(text.into_bytes()));
    }
    if bytes.starts_with(PARQUET) || bytes.contains(&0) {
        return Ok(bytes);
    }
    let mut bytes = bytes;
    if bytes.starts_with(MARK) {
        bytes.drain(..MARK.len());
    }
    if std::str::from_utf8(&bytes).is_err() {
        let text: String = bytes.iter().map(|&b| char::from(b)).collect();
        bytes = text.into_bytes();
    }
    Ok(with_line_ends(bytes))
}

const MARK: &[u8] = "\u{feff}".as_bytes();
const PARQUET: &[u8] = b"PAR1";

/// How two bytes of a UTF-16 text make a unit.
type Unit = fn([u8; 2]) -> u16;

/// How many bytes a UTF-16 text's mark takes, and how two of its bytes make a unit.
fn wide(bytes: &[u8]) -> Option<(usize, Unit)> {
    match bytes {
        [0xff, 0xfe, ..] => Some((2, u16::from_le_bytes)),
        [0xfe, 0xff, ..] => Some((2, u16::from_be_bytes)),
        [a, 0, b, 0, ..] if *a != 0 && *b != 0 => Some((0, u16::from_le_bytes)),
        [0, a, 0, b, ..] if *a != 0 && *b != 0 => Some((0, u16::from_be_bytes)),
        _ => None,
    }
}

/// A return without a line feed ends a line too, as old programs of Apple's computers wrote it.
fn with_line_ends(mut bytes: Vec<u8>) -> Vec<u8> {
    for k in 0..bytes.len() {
        if bytes[k] == b'\r' && bytes.get(k + 1) != Some(&b'\n') {
            bytes[k] = b'\n';
        }
    }
    bytes
}
