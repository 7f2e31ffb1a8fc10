//! One array of a MAT file of version 5, as "MAT-File Format" (MathWorks) lays it out:
//! elements of a tag and data, padded to 8 bytes, all in the byte order of the file.

/// Type of the element that holds an array.
pub(crate) const MATRIX: u32 = 14;
/// Length of an element's tag.
pub(crate) const TAG: usize = 8;
/// Classes of full numeric arrays: double, single, and the integers.
const NUMERIC: std::ops::RangeInclusive<u32> = 6..=15;
/// Flag of an array with imaginary parts.
const COMPLEX: u32 = 0x0800;

/// An array: its name, its size, and what is in it.
#[derive(Debug)]
pub(crate) struct Array {
    pub name: String,
    pub size: Vec<u64>,
    pub content: Content,
}

#[derive(Debug)]
pub(crate) enum Content {
    Numbers(Numbers),
    /// Where the arrays in each field stand, the fields of the first element before those of the
    /// second.
    Struct(Vec<String>, Fields),
    Cells(Fields),
    /// What has no numbers, in words.
    Other(&'static str),
}

/// From where on the arrays of a struct or of cells stand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fields {
    pub start: usize,
}

/// How the numbers of an array are stored.
#[derive(Debug, Clone)]
pub(crate) struct Numbers {
    pub complex: bool,
    /// Number of values.
    pub count: u64,
    /// How each value is stored.
    kind: u32,
    /// Where the real parts stand, from the beginning of what was parsed.
    start: usize,
}

/// An array, from what stands behind its tag, which is at `start` of `content`; numbers
/// themselves need not be there. `None` if it is damaged.
pub(crate) fn array(content: &[u8], start: usize, big: bool) -> Option<Array> {
    let mut reader = Reader {
        content,
        at: start,
        big,
    };
    let (flags_kind, flags) = reader.element()?;
    let flags = reader.word(flags.get(..4)?)?;
    let class = flags & 0xff;
    if flags_kind != 6 {
        return None;
    }
    if class == OPAQUE {
        // It has no size: what it is stands in names of its own.
        let (_, name) = reader.element()?;
        return Some(Array {
            name: text(name)?,
            size: Vec::new(),
            content: Content::Other("an object"),
        });
    }
    let (size_kind, size) = reader.element()?;
    let (name_kind, name) = reader.element()?;
    if size_kind != 5 || name_kind != 1 {
        return None;
    }
    let word = |bytes| reader.word(bytes).filter(|&n| n <= i32::MAX as u32);
    let size: Option<Vec<u64>> = (size.chunks(4)).map(|n| word(n).map(u64::from)).collect();
    let size = size.filter(|size| size.len() >= 2)?;
    let count = (size.iter()).try_fold(1_u64, |product, &n| product.checked_mul(n))?;
    let content = match class {
        1 => Content::Cells(Fields { start: reader.at }),
        2 => {
            let (_, length) = reader.element()?;
            let length = reader.word(length.get(..4)?)? as usize;
            let (_, names) = reader.element()?;
            let fields: Option<Vec<String>> = match length {
                0 => Some(Vec::new()),
                _ => names.chunks(length).map(text).collect(),
            };
            Content::Struct(fields?, Fields { start: reader.at })
        }
        4 => Content::Other("text"),
        5 => Content::Other("a sparse array"),
        3 => Content::Other("an object"),
        16 => Content::Other("a function"),
        class if NUMERIC.contains(&class) => {
            let (kind, start, length) = reader.tag()?;
            // The length is of 32 bits, so this cannot overflow what it is compared with.
            if count.checked_mul(width(kind)? as u64)? != length as u64 {
                return None;
            }
            Content::Numbers(Numbers {
                complex: flags & COMPLEX != 0,
                count,
                kind,
                start,
            })
        }
        _ => Content::Other("of a class that is not known"),
    };
    let name = text(name)?;
    Some(Array {
        name,
        size,
        content,
    })
}

/// Class of what MATLAB alone can read: strings, tables, objects of classes.
const OPAQUE: u32 = 17;

/// A name, to the first zero behind it.
fn text(bytes: &[u8]) -> Option<String> {
    let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
    String::from_utf8(bytes[..end].to_vec()).ok()
}

/// The next array of a struct or of cells: where it stands behind its tag, `None` of an empty one;
/// and where the one after it begins.
pub(crate) fn inside(content: &[u8], at: usize, big: bool) -> Option<(Option<usize>, usize)> {
    let mut reader = Reader { content, at, big };
    let (kind, start, length) = reader.tag()?;
    let end = start.checked_add(length)?;
    if kind != MATRIX || end > content.len() {
        return None;
    }
    Some(((length > 0).then_some(start), end.next_multiple_of(TAG)))
}

impl Numbers {
    /// Where the real parts end.
    pub(crate) fn end(&self) -> u64 {
        self.start as u64 + self.count * width(self.kind).unwrap_or(0) as u64
    }

    /// The real parts, from what they were parsed of; `None` if they are cut off.
    pub(crate) fn values(&self, content: &[u8], big: bool) -> Option<Vec<f64>> {
        let length = usize::try_from(self.count).ok()? * width(self.kind)?;
        let bytes = content.get(self.start..self.start.checked_add(length)?)?;
        macro_rules! as_numbers {
            ($number:ty) => {{
                let one = |chunk: &[u8]| {
                    // Chunks have the number's length.
                    let bytes = chunk.try_into().unwrap_or_default();
                    if big {
                        <$number>::from_be_bytes(bytes) as f64
                    } else {
                        <$number>::from_le_bytes(bytes) as f64
                    }
                };
                bytes.chunks_exact(size_of::<$number>()).map(one).collect()
            }};
        }
        Some(match self.kind {
            1 => as_numbers!(i8),
            2 => as_numbers!(u8),
            3 => as_numbers!(i16),
            4 => as_numbers!(u16),
            5 => as_numbers!(i32),
            6 => as_numbers!(u32),
            7 => as_numbers!(f32),
            9 => as_numbers!(f64),
            12 => as_numbers!(i64),
            13 => as_numbers!(u64),
            _ => return None,
        })
    }
}

/// Bytes of a stored number: any numeric type may hold the values of any class.
fn width(kind: u32) -> Option<usize> {
    Some(match kind {
        1 | 2 => 1,
        3 | 4 => 2,
        5..=7 => 4,
        9 | 12 | 13 => 8,
        _ => return None,
    })
}

struct Reader<'a> {
    content: &'a [u8],
    at: usize,
    big: bool,
}

impl<'a> Reader<'a> {
    fn word(&self, bytes: &[u8]) -> Option<u32> {
        let bytes = bytes.try_into().ok()?;
        Some(if self.big {
            u32::from_be_bytes(bytes)
        } else {
            u32::from_le_bytes(bytes)
        })
    }

    /// Type, start and length of the data of the next element; goes behind its tag.
    fn tag(&mut self) -> Option<(u32, usize, usize)> {
        let first = self.word(self.content.get(self.at..self.at + 4)?)?;
        // Up to four bytes of data may stand in the tag itself.
        if first >> 16 != 0 {
            let (start, length) = (self.at + 4, (first >> 16) as usize);
            self.at += TAG;
            return (length <= 4).then_some((first & 0xffff, start, length));
        }
        let length = self.word(self.content.get(self.at + 4..self.at + TAG)?)?;
        self.at += TAG;
        Some((first, self.at, length as usize))
    }

    /// Type and data of the next element; goes behind it.
    fn element(&mut self) -> Option<(u32, &'a [u8])> {
        let (kind, start, length) = self.tag()?;
        let data = self.content.get(start..start.checked_add(length)?)?;
        if start == self.at {
            self.at = start + length.next_multiple_of(TAG);
        }
        Some((kind, data))
    }
}
