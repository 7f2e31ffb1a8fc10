//! Elements of a MAT file of version 5, little-endian, as "MAT-File Format" (MathWorks) lays
//! them out; [`mat_element`](crate::mat_element) reads them.

use std::io;

use super::invalid;
use crate::mat_element::{MATRIX, TAG};

/// Types of elements.
const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const UTF16: u32 = 17;
/// Classes of arrays.
const STRUCT_CLASS: u32 = 2;
const CHAR_CLASS: u32 = 4;
const DOUBLE_CLASS: u32 = 6;
/// Most bytes of an element: MATLAB reads lengths of version 5 as signed.
const MOST: usize = i32::MAX as usize;
/// Length of a field's name with its zero; MATLAB from 7.6 on also reads the long one.
const FIELD: [usize; 2] = [32, 64];

/// The header of a file. It has no date: the same log is the same bytes.
pub(super) fn header() -> Vec<u8> {
    let mut bytes = b"MATLAB 5.0 MAT-file, written by axis-log".to_vec();
    // Text, and no place of data of subsystems.
    bytes.resize(116, b' ');
    bytes.resize(124, 0);
    // Version, and the mark that tells the order of bytes.
    bytes.extend_from_slice(&[0, 1, b'I', b'M']);
    bytes
}

/// A column of numbers.
pub(super) fn column(name: &str, samples: &[f64]) -> io::Result<Vec<u8>> {
    let length = samples.len().saturating_mul(8);
    if length > MOST - 256 {
        return Err(invalid(format!(
            "channel \"{name}\" has {} samples: a variable of MAT version 5 holds 2 GB; save \
             the log as Parquet",
            samples.len()
        )));
    }
    let mut content = array(DOUBLE_CLASS, [samples.len(), 1], name);
    content.reserve_exact(TAG + length);
    tag(&mut content, DOUBLE, length);
    for sample in samples {
        content.extend_from_slice(&sample.to_le_bytes());
    }
    Ok(matrix(content))
}

/// A struct of texts.
pub(super) fn texts(name: &str, fields: &[(&str, &str)]) -> Vec<u8> {
    let longest = fields.iter().map(|(name, _)| name.len()).max();
    let width = match longest {
        Some(longest) if longest >= FIELD[0] => FIELD[1],
        _ => FIELD[0],
    };
    let mut content = array(STRUCT_CLASS, [1, 1], name);
    // The one element that must stand in its tag.
    content.extend_from_slice(&(4 << 16 | INT32).to_le_bytes());
    content.extend_from_slice(&(width as u32).to_le_bytes());
    let mut names = Vec::with_capacity(width * fields.len());
    for (k, (name, _)) in fields.iter().enumerate() {
        names.extend_from_slice(name.as_bytes());
        names.resize((k + 1) * width, 0);
    }
    element(&mut content, INT8, &names);
    for (_, value) in fields {
        content.extend_from_slice(&text(value));
    }
    matrix(content)
}

/// A text in UTF-16, without a name.
fn text(text: &str) -> Vec<u8> {
    let units: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let mut content = array(CHAR_CLASS, [1, units.len() / 2], "");
    element(&mut content, UTF16, &units);
    matrix(content)
}

/// What stands before the numbers of an array.
fn array(class: u32, size: [usize; 2], name: &str) -> Vec<u8> {
    let mut content = Vec::new();
    let words = |words: [u32; 2]| words.map(u32::to_le_bytes).concat();
    element(&mut content, UINT32, &words([class, 0]));
    element(&mut content, INT32, &words(size.map(|n| n as u32)));
    element(&mut content, INT8, name.as_bytes());
    content
}

fn matrix(content: Vec<u8>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(TAG + content.len());
    element(&mut bytes, MATRIX, &content);
    bytes
}

/// Tag and data, padded to 8 bytes.
fn element(to: &mut Vec<u8>, kind: u32, data: &[u8]) {
    tag(to, kind, data.len());
    to.extend_from_slice(data);
    to.resize(to.len().next_multiple_of(TAG), 0);
}

fn tag(to: &mut Vec<u8>, kind: u32, length: usize) {
    to.extend_from_slice(&kind.to_le_bytes());
    to.extend_from_slice(&(length as u32).to_le_bytes());
}
