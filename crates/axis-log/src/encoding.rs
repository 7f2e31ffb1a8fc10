//! The bytes of a text as UTF-8, however a program wrote it.

use std::io::Read;
use std::path::Path;

use crate::error::CsvProblem;

/// A text as UTF-8 without byte-order mark, its lines ended by `\n` or `\r\n`; anything that is no
/// text as it is.
///
/// UTF-16 is told by its byte-order mark, or by a zero in every other of the first four bytes.
/// What is not UTF-8 either is ISO 8859-1, which Windows and drives write for the signs of Western
/// languages. A file with a zero byte is not text.
pub(crate) fn plain(bytes: Vec<u8>) -> Result<Vec<u8>, CsvProblem> {
    if bytes.starts_with(PARQUET) {
        return Ok(bytes);
    }
    let bytes = unmarked(bytes).ok_or(CsvProblem::NotText { line: 1 })?;
    if bytes.contains(&0) {
        return Ok(bytes);
    }
    let bytes = match String::from_utf8(bytes) {
        Ok(text) => text.into_bytes(),
        Err(other) => {
            let text: String = other.as_bytes().iter().map(|&b| char::from(b)).collect();
            text.into_bytes()
        }
    };
    Ok(with_line_ends(bytes))
}

/// Reads a text file of settings, such as TOML, JSON or a G-code program: UTF-8, or UTF-16 as Notepad and
/// PowerShell's `>` write it, with or without a byte-order mark, which is left out. At most `limit` bytes (whole MiB), if
/// there is a limit.
///
/// Other than of a log's text, the encoding of what is not UTF-8 is not guessed: a wrong letter in a name or in a path of
/// a file would be found late.
///
/// # Errors
/// The system's, and `InvalidData` with the line and how to save the file.
pub fn read_text(path: &Path, limit: Option<u64>) -> std::io::Result<String> {
    let mut bytes = Vec::new();
    let limit = limit.unwrap_or(u64::MAX);
    let file = std::fs::File::open(path)?;
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        return Err(invalid(format!("it is larger than {} MiB", limit >> 20)));
    }
    text_of(bytes)
}

/// As [`read_text`], of the bytes of such a file.
///
/// # Errors
/// `InvalidData`, with the line and how to save the file.
pub fn text_of(bytes: Vec<u8>) -> std::io::Result<String> {
    let bytes = unmarked(bytes)
        .ok_or_else(|| invalid(format!("it begins as UTF-16, but is none; {SAVE}")))?;
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
        invalid(format!("line {line} is no text in UTF-8; {SAVE}"))
    })
}

const SAVE: &str =
    "save it as UTF-8 (Notepad: Save as, Encoding: UTF-8; PowerShell: Set-Content -Encoding utf8)";

fn invalid(what: String) -> std::io::Error {
    std::io::Error::new(std::io::ErrorKind::InvalidData, what)
}

/// The bytes without byte-order mark, those of UTF-16 as UTF-8; `None` if they begin as UTF-16 and are none.
fn unmarked(mut bytes: Vec<u8>) -> Option<Vec<u8>> {
    let Some((skip, unit)) = wide(&bytes) else {
        if bytes.starts_with(MARK) {
            bytes.drain(..MARK.len());
        }
        return Some(bytes);
    };
    let units = bytes[skip..].chunks_exact(2);
    if !units.remainder().is_empty() {
        return None;
    }
    let units: Vec<u16> = units.map(|pair| unit([pair[0], pair[1]])).collect();
    String::from_utf16(&units).ok().map(String::into_bytes)
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
