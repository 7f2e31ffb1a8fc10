//! The vectors in an array of a MAT file, by their paths: `data.q(2)` is the second column of the
//! field `q` of `data`, `run(3).t` the field `t` of the third element of `run`, `c{1}` the first cell of `c`.

use crate::csv_text::MAX_COLUMNS;
use crate::mat_element::{Array, Content, Fields, Numbers, array, inside};
use crate::table::{Fault, Head};

/// Structs and cells within each other that are looked into.
const MOST_DEEP: usize = 16;
/// Structs or cells in an array that are looked into: signals, not samples.
const MOST_ELEMENTS: u64 = 256;
const VALID: &str = "a real vector, or a column or row of a real matrix,";

/// Numbers of an array that stand `step` apart.
#[derive(Clone)]
pub(crate) struct Slice {
    pub numbers: Numbers,
    pub first: usize,
    pub step: usize,
    pub count: usize,
}

/// What was found in an array.
#[derive(Default)]
pub(crate) struct Vectors {
    /// A column, and where its numbers are where it has any.
    pub found: Vec<(Head, Option<Slice>)>,
    /// Parts that cannot be read as they should.
    pub damaged: usize,
}

/// What arrays are read from.
#[derive(Clone, Copy)]
struct Bytes<'a> {
    content: &'a [u8],
    /// Whether the first byte of a number is its greatest.
    big: bool,
}

impl Vectors {
    /// Those of an array that stands behind its tag at the start of `content`.
    pub(crate) fn of(content: &[u8], top: Array, big: bool) -> Self {
        let mut vectors = Self::default();
        let name = top.name.clone();
        vectors.walk(Bytes { content, big }, top, name, 0);
        vectors
    }

    fn walk(&mut self, bytes: Bytes<'_>, array: Array, path: String, deep: usize) {
        if deep > MOST_DEEP || self.found.len() > MAX_COLUMNS {
            return;
        }
        let elements = array.size.iter().product::<u64>();
        if elements > MOST_ELEMENTS && !matches!(array.content, Content::Numbers(_)) {
            return self.push(path, Err(format!("an array of {elements} parts")));
        }
        match array.content {
            Content::Other(found) => self.push(path, Err(found.to_owned())),
            Content::Numbers(numbers) => self.numbers(path, &array.size, &numbers),
            Content::Struct(names, fields) => {
                let path = |k: u64, name: &String| match elements {
                    1 => format!("{path}.{name}"),
                    _ => format!("{path}({}).{name}", k + 1),
                };
                let all = (0..elements).flat_map(|k| names.iter().map(move |name| (k, name)));
                self.inside(bytes, fields, all.map(|(k, n)| path(k, n)), deep);
            }
            Content::Cells(fields) => {
                let all = (0..elements).map(|k| format!("{path}{{{}}}", k + 1));
                self.inside(bytes, fields, all, deep);
            }
        }
    }

    /// The arrays one behind the other, under these paths. A damaged one hides those behind it.
    fn inside(
        &mut self,
        bytes: Bytes<'_>,
        fields: Fields,
        paths: impl Iterator<Item = String>,
        deep: usize,
    ) {
        let Bytes { content, big } = bytes;
        let mut at = fields.start;
        for path in paths {
            let Some((start, next)) = inside(content, at, big) else {
                self.damaged += 1;
                return;
            };
            at = next;
            match start.map(|start| array(content, start, big)) {
                // An empty field has no array in it.
                None => {}
                Some(Some(array)) => self.walk(bytes, array, path, deep + 1),
                Some(None) => self.damaged += 1,
            }
        }
    }

    /// A vector as it is; of a matrix the columns, or the rows where these are longer.
    fn numbers(&mut self, path: String, size: &[u64], numbers: &Numbers) {
        let wide: Vec<usize> = size
            .iter()
            .filter(|&&n| n != 1)
            .map(|&n| usize::try_from(n).unwrap_or(usize::MAX))
            .collect();
        if numbers.complex {
            return self.push(path, Err("complex".to_owned()));
        }
        let count = usize::try_from(numbers.count).unwrap_or(usize::MAX);
        let slice = |first, step, count| Slice {
            numbers: numbers.clone(),
            first,
            step,
            count,
        };
        match wide[..] {
            [] | [_] => self.push(path, Ok(slice(0, 1, count))),
            [rows, columns] if rows.min(columns) > MAX_COLUMNS => {
                self.push(path, Err(format!("an array of {rows} × {columns}")));
            }
            [rows, columns] if rows >= columns => {
                for k in 0..columns {
                    self.push(format!("{path}({})", k + 1), Ok(slice(k * rows, 1, rows)));
                }
            }
            [rows, columns] => {
                for k in 0..rows {
                    self.push(format!("{path}({})", k + 1), Ok(slice(k, rows, columns)));
                }
            }
            _ => {
                let all: Vec<String> = size.iter().map(u64::to_string).collect();
                self.push(path, Err(format!("an array of {}", all.join(" × "))));
            }
        }
    }

    fn push(&mut self, path: String, found: Result<Slice, String>) {
        let mut head = Head::new(path);
        let slice = match found {
            Ok(slice) => Some(slice),
            Err(found) => {
                head.fault = Some(Fault {
                    found,
                    valid: VALID,
                });
                None
            }
        };
        self.found.push((head, slice));
    }
}
