//! MAT version 5 as a table.

use std::borrow::Cow;

use miniz_oxide::inflate::{TINFLStatus, decompress_to_vec_zlib_with_limit};

use crate::csv_text::MAX_COLUMNS;
use crate::mat_element::{ArrayHead, MATRIX, TAG, head};
use crate::read_error::{Place, ReadProblem};
use crate::table::{Budget, Fault, Head, Holes, Table};

/// Length of the file header.
const HEADER: usize = 128;
/// Type of an element that holds another one deflated.
const COMPRESSED: u32 = 15;
/// What is inflated of an array to see what it is: more than any head takes.
const HEAD: usize = 4096;

pub(crate) struct MatTable<'a> {
    big: bool,
    heads: Vec<Head>,
    arrays: Vec<(Element<'a>, ArrayHead)>,
    file: usize,
    unreadable: usize,
}

/// A top-level element: its type and what stands behind its tag.
struct Element<'a> {
    kind: u32,
    content: &'a [u8],
}

impl<'a> MatTable<'a> {
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Self, ReadProblem> {
        let (big, elements) = split(bytes)?;
        let mut table = Self {
            big,
            heads: Vec::new(),
            arrays: Vec::new(),
            file: bytes.len(),
            unreadable: 0,
        };
        for element in elements {
            let found = element.array(HEAD).and_then(|content| head(&content, big));
            match found {
                Some(array) => table.push(element, array),
                None => table.unreadable += 1,
            }
        }
        Ok(table)
    }

    fn push(&mut self, element: Element<'a>, array: ArrayHead) {
        let vector = array.size.iter().filter(|&&n| n != 1).count() <= 1;
        let found = match (vector, array.complex) {
            (false, _) => Some(format!("an array of {}", size(&array))),
            (_, true) => Some("complex".to_owned()),
            _ => None,
        };
        self.heads.push(Head {
            name: array.name.clone(),
            fault: found.map(|found| Fault {
                found,
                valid: "a real vector, n × 1 or 1 × n,",
            }),
            address: None,
            unit: None,
        });
        self.arrays.push((element, array));
    }
}

impl Table for MatTable<'_> {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn unreadable(&self) -> usize {
        self.unreadable
    }

    fn read(&mut self, wanted: &[usize], _: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let mut budget = Budget::of(self.file);
        for (element, array) in wanted.iter().map(|&index| &self.arrays[index]) {
            budget.keep(array.count);
            if element.kind == COMPRESSED {
                budget.aside(array.end());
            }
        }
        budget.check()?;
        let numbers = |&index: &usize| {
            let (element, array) = &self.arrays[index];
            let length = usize::try_from(array.end()).ok();
            length
                .and_then(|length| element.array(length + TAG))
                .and_then(|content| array.numbers(&content, self.big))
                .ok_or_else(|| ReadProblem::Mat {
                    reason: format!(
                        "the numbers of \"{}\" are damaged or cut off; save it again with -v7",
                        array.name
                    ),
                })
        };
        wanted.iter().map(numbers).collect()
    }

    fn place(&self, row: usize, _: usize) -> Place {
        Place::Row { row: row + 1 }
    }
}

impl<'a> Element<'a> {
    /// What stands behind the tag of the array in it, to `most` bytes at least where
    /// there are as many; `None` where it is no array or damaged.
    fn array(&self, most: usize) -> Option<Cow<'a, [u8]>> {
        if self.kind == MATRIX {
            return Some(self.content.into());
        }
        let mut whole = match decompress_to_vec_zlib_with_limit(self.content, most) {
            Ok(whole) => whole,
            Err(e) if e.status == TINFLStatus::HasMoreOutput => e.output,
            Err(_) => return None,
        };
        // The type is 14 in the first or the fourth byte, by the file's byte order.
        let tag = whole.get(..4)?;
        if tag != MATRIX.to_le_bytes() && tag != MATRIX.to_be_bytes() {
            return None;
        }
        whole.drain(..TAG.min(whole.len()));
        Some(whole.into())
    }
}

/// Whether the numbers are big-endian, and the top-level elements that hold arrays.
fn split(bytes: &[u8]) -> Result<(bool, Vec<Element<'_>>), ReadProblem> {
    let refuse = |reason: &str| ReadProblem::Mat {
        reason: reason.to_owned(),
    };
    if bytes.starts_with(b"MATLAB 7.3") || bytes.starts_with(b"\x89HDF") {
        return Err(refuse("it is version 7.3 (HDF5): save it with -v7"));
    }
    let (header, mut rest) = bytes
        .split_at_checked(HEADER)
        .ok_or_else(|| refuse("it is shorter than the header, 128 bytes"))?;
    let big = match &header[124..] {
        [0, 1, b'I', b'M'] => false,
        [1, 0, b'M', b'I'] => true,
        _ => return Err(refuse("the header has no version 5 mark: save it with -v7")),
    };
    let number = if big {
        u32::from_be_bytes
    } else {
        u32::from_le_bytes
    };
    let mut elements = Vec::new();
    while let Some((&[a, b, c, d, e, f, g, h], after)) = rest.split_first_chunk::<TAG>() {
        let length = number([e, f, g, h]) as usize;
        let (content, after) = after.split_at_checked(length).ok_or_else(|| {
            let (at, left) = (bytes.len() - rest.len(), after.len());
            refuse(&format!(
                "it is cut off: the element at byte {at} should hold {length} bytes, {left} are left; save it again with -v7"
            ))
        })?;
        let kind = number([a, b, c, d]);
        if matches!(kind, MATRIX | COMPRESSED) {
            elements.push(Element { kind, content });
        }
        // Plain elements are padded to 8 bytes.
        let padding = if kind == COMPRESSED {
            0
        } else {
            length.wrapping_neg() % TAG
        };
        rest = after.get(padding..).unwrap_or_default();
    }
    if !rest.is_empty() {
        return Err(refuse(
            "it is cut off inside the tag of its last element: save it again with -v7",
        ));
    }
    if elements.len() > MAX_COLUMNS {
        let found = elements.len();
        return Err(refuse(&format!(
            "it has {found} arrays, at most {MAX_COLUMNS} are read"
        )));
    }
    Ok((big, elements))
}

fn size(array: &ArrayHead) -> String {
    let all: Vec<String> = array.size.iter().map(u64::to_string).collect();
    all.join(" × ")
}
