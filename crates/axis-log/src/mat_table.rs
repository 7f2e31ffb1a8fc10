//! MAT version 5 as a table.

use std::panic::catch_unwind;

use matfile::{Array, MatFile, NumericData};

use crate::read_error::{Place, ReadProblem};
use crate::table::{Fault, Head, Table};

/// Length of the file header, of an element's tag.
const HEADER: usize = 128;
const TAG: usize = 8;
/// Types of the elements that hold an array: plain and deflated.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

pub(crate) struct MatTable {
    heads: Vec<Head>,
    arrays: Vec<Vec<f64>>,
    unreadable: usize,
}

impl MatTable {
    pub(crate) fn open(bytes: &[u8]) -> Result<Self, ReadProblem> {
        let (header, elements) = split(bytes)?;
        let mut table = Self {
            heads: Vec::new(),
            arrays: Vec::new(),
            unreadable: 0,
        };
        for element in elements {
            match parse(header, element) {
                Some(array) => table.push(&array),
                None => table.unreadable += 1,
            }
        }
        Ok(table)
    }

    fn push(&mut self, array: &Array) {
        let complex = is_complex(array.data());
        let vector = array.size().iter().filter(|&&n| n != 1).count() <= 1;
        let found = match (vector, complex) {
            (false, _) => Some(format!("an array of {}", size(array))),
            (_, true) => Some("complex".to_owned()),
            _ => None,
        };
        self.heads.push(Head {
            name: array.name().to_owned(),
            fault: found.map(|found| Fault {
                found,
                valid: "a real vector, n × 1 or 1 × n,",
            }),
        });
        self.arrays.push(numbers(array.data()));
    }
}

impl Table for MatTable {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn unreadable(&self) -> usize {
        self.unreadable
    }

    fn read(&mut self, wanted: &[usize]) -> Result<Vec<Vec<f64>>, ReadProblem> {
        // Each column is wanted once.
        let take = |&index: &usize| std::mem::take(&mut self.arrays[index]);
        Ok(wanted.iter().map(take).collect())
    }

    fn place(&self, row: usize, _: usize) -> Place {
        Place::Row { row: row + 1 }
    }
}

/// The header and the top-level elements, tags included.
fn split(bytes: &[u8]) -> Result<(&[u8], Vec<&[u8]>), ReadProblem> {
    let refuse = |reason: &str| ReadProblem::Mat {
        reason: reason.to_owned(),
    };
    if bytes.starts_with(b"MATLAB 7.3") || bytes.starts_with(b"\x89HDF") {
        return Err(refuse("it is version 7.3 (HDF5): save it with -v7"));
    }
    let (header, mut rest) = bytes
        .split_at_checked(HEADER)
        .ok_or_else(|| refuse("it is shorter than the header, 128 bytes"))?;
    let number = match &header[124..] {
        [0, 1, b'I', b'M'] => u32::from_le_bytes,
        [1, 0, b'M', b'I'] => u32::from_be_bytes,
        _ => return Err(refuse("the header has no version 5 mark: save it with -v7")),
    };
    let mut elements = Vec::new();
    while let Some(&[a, b, c, d, e, f, g, h]) = rest.first_chunk::<TAG>() {
        let length = number([e, f, g, h]) as usize;
        let (element, after) = rest.split_at_checked(TAG + length).ok_or_else(|| {
            let (at, left) = (bytes.len() - rest.len(), rest.len() - TAG);
            refuse(&format!(
                "it is cut off: the element at byte {at} should hold {length} bytes, {left} are left"
            ))
        })?;
        let kind = number([a, b, c, d]);
        if matches!(kind, MATRIX | COMPRESSED) {
            elements.push(element);
        }
        // Plain elements are padded to 8 bytes.
        let padding = if kind == COMPRESSED {
            0
        } else {
            length.wrapping_neg() % TAG
        };
        rest = after.get(padding..).unwrap_or_default();
    }
    if rest.is_empty() {
        return Ok((header, elements));
    }
    Err(refuse("it is cut off inside the tag of its last element"))
}

/// The array of one element, `None` where it is of another kind or damaged.
///
/// Elements are parsed one at a time because the parser gives up on the whole
/// file at the first kind of array that it does not know; and it may panic on a
/// damaged one (the product of the dimensions overflows).
fn parse(header: &[u8], element: &[u8]) -> Option<Array> {
    let alone = [header, element].concat();
    let parsed = catch_unwind(|| MatFile::parse(alone.as_slice()));
    let file = parsed.ok()?.ok()?;
    file.arrays().first().cloned()
}

fn size(array: &Array) -> String {
    let all: Vec<String> = array.size().iter().map(usize::to_string).collect();
    all.join(" × ")
}

fn is_complex(data: &NumericData) -> bool {
    use NumericData as N;
    match data {
        N::Int8 { imag, .. } => imag.is_some(),
        N::UInt8 { imag, .. } => imag.is_some(),
        N::Int16 { imag, .. } => imag.is_some(),
        N::UInt16 { imag, .. } => imag.is_some(),
        N::Int32 { imag, .. } => imag.is_some(),
        N::UInt32 { imag, .. } => imag.is_some(),
        N::Int64 { imag, .. } => imag.is_some(),
        N::UInt64 { imag, .. } => imag.is_some(),
        N::Single { imag, .. } => imag.is_some(),
        N::Double { imag, .. } => imag.is_some(),
    }
}

fn numbers(data: &NumericData) -> Vec<f64> {
    use NumericData as N;
    fn widen<T: Copy + Into<f64>>(values: &[T]) -> Vec<f64> {
        values.iter().map(|&v| v.into()).collect()
    }
    match data {
        N::Int8 { real, .. } => widen(real),
        N::UInt8 { real, .. } => widen(real),
        N::Int16 { real, .. } => widen(real),
        N::UInt16 { real, .. } => widen(real),
        N::Int32 { real, .. } => widen(real),
        N::UInt32 { real, .. } => widen(real),
        N::Int64 { real, .. } => real.iter().map(|&v| v as f64).collect(),
        N::UInt64 { real, .. } => real.iter().map(|&v| v as f64).collect(),
        N::Single { real, .. } => widen(real),
        N::Double { real, .. } => real.clone(),
    }
}
