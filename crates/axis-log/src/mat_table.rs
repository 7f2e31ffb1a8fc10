//! MAT version 5 as a table.

use std::borrow::Cow;

use miniz_oxide::inflate::{TINFLStatus, decompress_to_vec_zlib_with_limit};

use crate::csv_text::MAX_COLUMNS;
use crate::mat_element::{Array, Content, MATRIX, TAG, array};
use crate::mat_path::{Slice, Vectors};
use crate::read_error::{Place, ReadProblem};
use crate::table::{Budget, Head, Holes, Table};

/// Length of the file header.
const HEADER: usize = 128;
/// Type of an element that holds another one deflated.
const COMPRESSED: u32 = 15;
/// What is inflated of an array to see what it is: more than any head takes.
const HEAD: usize = 4096;

pub(crate) struct MatTable<'a> {
    big: bool,
    heads: Vec<Head>,
    /// Number of the element, and where in it the numbers of each head are.
    slices: Vec<(usize, Option<Slice>)>,
    elements: Vec<Element<'a>>,
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
            slices: Vec::new(),
            elements,
            file: bytes.len(),
            unreadable: 0,
        };
        for element in 0..table.elements.len() {
            let Some(vectors) = table.vectors(element) else {
                table.unreadable += 1;
                continue;
            };
            table.unreadable += vectors.damaged;
            for (head, slice) in vectors.found {
                table.heads.push(head);
                table.slices.push((element, slice));
            }
            if table.heads.len() > MAX_COLUMNS {
                let found = table.heads.len();
                return Err(too_many(found));
            }
        }
        Ok(table)
    }

    /// What is in an element; `None` if it is damaged. What may be inflated of a struct is bound
    /// as what is read of a file: its arrays are only seen where all before them is there.
    fn vectors(&self, element: usize) -> Option<Vectors> {
        let element = &self.elements[element];
        let content = element.array(HEAD)?;
        let top = array(&content, 0, self.big).filter(|top| !top.name.is_empty())?;
        let is_nested =
            |top: &Array| matches!(top.content, Content::Struct(..) | Content::Cells(_));
        if element.kind == MATRIX || !is_nested(&top) {
            return Some(Vectors::of(&content, top, self.big));
        }
        let content = element.array(Budget::of(self.file).numbers().saturating_mul(8))?;
        let top = array(&content, 0, self.big)?;
        Some(Vectors::of(&content, top, self.big))
    }
}

fn too_many(found: usize) -> ReadProblem {
    ReadProblem::Mat {
        reason: format!("it has {found} arrays, at most {MAX_COLUMNS} are read"),
    }
}

impl Table for MatTable<'_> {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn unreadable(&self) -> usize {
        self.unreadable
    }

    fn looks_like(&self) -> String {
        "MAT version 5".to_owned()
    }

    fn read(&mut self, wanted: &[usize], _: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let mut budget = Budget::of(self.file);
        let of = |&index: &usize| {
            let (element, slice) = &self.slices[index];
            Some((&self.elements[*element], slice.as_ref()?))
        };
        for (element, slice) in wanted.iter().filter_map(of) {
            budget.keep(slice.count as u64);
            // All of a matrix is decoded for one of its columns.
            let whole = (slice.count as u64 != slice.numbers.count).then_some(slice.numbers.count);
            let inflated = (element.kind == COMPRESSED).then_some(slice.numbers.end());
            budget.aside(inflated.unwrap_or(0) + 8 * whole.unwrap_or(0));
        }
        budget.check()?;
        let numbers = |index: &usize| {
            let damaged = || ReadProblem::Mat {
                reason: format!(
                    "the numbers of \"{}\" are damaged or cut off; save it again with -v7",
                    self.heads[*index].name
                ),
            };
            let (element, slice) = of(index).ok_or_else(damaged)?;
            let length = usize::try_from(slice.numbers.end()).map_err(|_| damaged())?;
            let content = element.array(length + TAG).ok_or_else(damaged)?;
            let all = slice
                .numbers
                .values(&content, self.big)
                .ok_or_else(damaged)?;
            if slice.count == all.len() {
                return Ok(all);
            }
            let own = all.into_iter().skip(slice.first).step_by(slice.step);
            Ok(own.take(slice.count).collect())
        };
        wanted.iter().map(numbers).collect()
    }

    fn place(&self, row: usize, _: usize) -> Place {
        Place::Row { row: row + 1 }
    }
}

impl<'a> Element<'a> {
    /// What stands behind the tag of the array in it, to `most` bytes at least where
    /// there are as many; `None` if it is no array or damaged.
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
        return Err(too_many(elements.len()));
    }
    Ok((big, elements))
}
