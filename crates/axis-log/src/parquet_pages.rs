//! The pages of a Parquet column, one after another: what they claim is checked against the bytes
//! that are there before anything is asked for, and what is in them before it is decoded. The
//! decoder takes their word for both.

use bytes::Bytes;
use parquet::basic::{Compression, Encoding};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};

use crate::parquet_codec::decompressed;
use crate::parquet_hybrid::all;
use crate::thrift::{Integers, integers};

/// What the pages of one column chunk hold.
#[derive(Default)]
pub(crate) struct Claims {
    /// Values, nulls included.
    pub values: u64,
    /// Bytes of the largest page once decompressed.
    pub largest: u64,
}

/// A column chunk.
pub(crate) struct Pages {
    rest: Bytes,
    /// Where the rest stands in the chunk.
    at: usize,
    codec: Compression,
    /// Bytes of a value.
    width: u64,
    /// Whether a value may be missing.
    optional: bool,
    /// Values of the dictionary, where one was met.
    dictionary: Option<u64>,
}

impl Pages {
    pub(crate) fn of(chunk: Bytes, codec: Compression, width: u64, optional: bool) -> Self {
        Self {
            rest: chunk,
            at: 0,
            codec,
            width,
            optional,
            dictionary: None,
        }
    }

    /// What all pages claim; none is decompressed.
    pub(crate) fn claims(mut self) -> std::result::Result<Claims, String> {
        let mut found = Claims::default();
        while let Some((head, _)) = self.next_raw()? {
            if head.kind != Kind::Dictionary {
                found.values += head.values;
            }
            found.largest = found.largest.max(head.plain);
        }
        Ok(found)
    }

    fn refused(&self, what: &str) -> String {
        format!("the page at byte {} of its column {what}", self.at)
    }

    /// The next page that holds values, as it is stored.
    fn next_raw(&mut self) -> std::result::Result<Option<(Head, Bytes)>, String> {
        while !self.rest.is_empty() {
            let damaged = || self.refused("has a damaged header");
            let (header, body) = integers(&self.rest).ok_or_else(damaged)?;
            let head = Head::of(&header).ok_or_else(damaged)?;
            let (start, stored) = (self.rest.len() - body.len(), head.stored as usize);
            if stored > body.len() {
                return Err(self.refused("is cut off"));
            }
            let page = self.rest.slice(start..start + stored);
            self.check(&head)?;
            self.rest = self.rest.slice(start + stored..);
            let at = self.at + start + stored;
            match head.kind {
                Kind::Other => self.at = at,
                _ => {
                    if head.kind == Kind::Dictionary {
                        self.dictionary = Some(head.values);
                    }
                    self.at = at;
                    return Ok(Some((head, page)));
                }
            }
        }
        Ok(None)
    }

    fn check(&self, head: &Head) -> std::result::Result<(), String> {
        let apart = u64::from(head.levels[0]) + u64::from(head.levels[1]);
        if apart > head.stored.min(head.plain) {
            return Err(self.refused("claims more bytes than can be in it"));
        }
        if head.kind == Kind::Dictionary {
            if head.values.saturating_mul(self.width) > head.plain {
                return Err(self.refused("claims more values than can be in it"));
            }
        } else if head.by_dictionary() && self.dictionary.is_none() {
            return Err(self.refused("needs a dictionary, and none is there"));
        }
        Ok(())
    }

    fn page(&mut self) -> std::result::Result<Option<Page>, String> {
        let Some((head, stored)) = self.next_raw()? else {
            return Ok(None);
        };
        let bytes = self.plain(&head, &stored)?;
        let damaged = || self.refused("holds other values than it says");
        let encoding = encoding(head.encoding).ok_or_else(damaged)?;
        let count = |n: u64| u32::try_from(n).map_err(|_| damaged());
        let num_values = count(head.values)?;
        if head.kind == Kind::Dictionary {
            return Ok(Some(Page::DictionaryPage {
                buf: bytes,
                num_values,
                encoding,
                is_sorted: false,
            }));
        }
        self.check_values(&head, &bytes).ok_or_else(damaged)?;
        Ok(Some(match head.kind {
            Kind::Second => Page::DataPageV2 {
                buf: bytes,
                num_values,
                encoding,
                num_nulls: count(head.nulls)?,
                num_rows: count(head.rows)?,
                def_levels_byte_len: head.levels[0],
                rep_levels_byte_len: head.levels[1],
                is_compressed: false,
                statistics: None,
            },
            _ => Page::DataPage {
                buf: bytes,
                num_values,
                encoding,
                def_level_encoding: Encoding::RLE,
                rep_level_encoding: Encoding::RLE,
                statistics: None,
            },
        }))
    }

    /// The bytes of a page, decompressed. Levels of the second kind of page never are compressed.
    fn plain(&self, head: &Head, stored: &Bytes) -> std::result::Result<Bytes, String> {
        let apart = (head.levels[0] + head.levels[1]) as usize;
        if self.codec == Compression::UNCOMPRESSED || !head.is_compressed {
            return Ok(stored.clone());
        }
        let (levels, body) = stored.split_at(apart);
        if body.is_empty() && head.plain as usize == apart {
            return Ok(stored.clone());
        }
        let body = decompressed(self.codec, body, head.plain as usize - apart);
        let body = body.map_err(|what| self.refused(&what))?;
        Ok(match levels.is_empty() {
            true => body.into(),
            false => [levels, &body].concat().into(),
        })
    }

    /// Whether the levels and the places in a dictionary are what a decoder can take.
    fn check_values(&self, head: &Head, bytes: &[u8]) -> Option<()> {
        let mut present = head.values;
        let mut rest = bytes;
        if self.optional {
            let levels;
            (levels, rest) = match head.kind {
                Kind::Second => bytes.split_at_checked(head.levels[0] as usize)?,
                _ if head.level_encoding == RLE => {
                    let (length, rest) = bytes.split_first_chunk::<4>()?;
                    rest.split_at_checked(u32::from_le_bytes(*length) as usize)?
                }
                // Packed by an old writer.
                _ => return None,
            };
            present = 0;
            all(levels, 1, head.values, |level, run| {
                present += level * run;
                level <= 1
            })?;
        }
        match encoding(head.encoding)? {
            Encoding::PLAIN => {
                (present.saturating_mul(self.width) <= rest.len() as u64).then_some(())
            }
            Encoding::PLAIN_DICTIONARY | Encoding::RLE_DICTIONARY if present > 0 => {
                let (&bits, places) = rest.split_first()?;
                let most = self.dictionary?;
                all(places, bits, present, |place, _| place < most)
            }
            _ => Some(()),
        }
    }
}

impl Iterator for Pages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        self.page().map_err(ParquetError::General)
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        // Nothing is skipped, so nobody asks.
        Ok(None)
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.next_raw().map(drop).map_err(ParquetError::General)
    }
}

/// Number of the encoding of levels that is read.
const RLE: i64 = 3;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    First,
    Second,
    Dictionary,
    Other,
}

/// What the header of a page says.
///
/// Field numbers are those of parquet.thrift
/// (github.com/apache/parquet-format/blob/master/src/main/thrift/parquet.thrift).
struct Head {
    kind: Kind,
    plain: u64,
    stored: u64,
    values: u64,
    nulls: u64,
    rows: u64,
    encoding: i64,
    level_encoding: i64,
    /// Bytes of the definition and the repetition levels, where they are not compressed.
    levels: [u32; 2],
    is_compressed: bool,
}

impl Head {
    fn of(header: &Integers) -> Option<Self> {
        let number = |value: Option<i64>| u32::try_from(value?).ok().map(u64::from);
        let inside = |outer, inner| number(header.inside(outer, inner));
        let kind = match number(header.get(1))? {
            0 => Kind::First,
            2 => Kind::Dictionary,
            3 => Kind::Second,
            _ => Kind::Other,
        };
        let (outer, encoding) = match kind {
            Kind::First | Kind::Other => (5, 2),
            Kind::Dictionary => (7, 2),
            Kind::Second => (8, 4),
        };
        let second = |inner| match kind {
            Kind::Second => inside(8, inner),
            _ => Some(0),
        };
        let values = match kind {
            Kind::Other => 0,
            _ => inside(outer, 1)?,
        };
        let least = |n: u64| u32::try_from(n).ok().filter(|n| *n <= i32::MAX as u32);
        Some(Self {
            kind,
            plain: u64::from(least(number(header.get(2))?)?),
            stored: u64::from(least(number(header.get(3))?)?),
            values: u64::from(least(values)?),
            nulls: second(2)?,
            rows: second(3)?,
            encoding: header.inside(outer, encoding).unwrap_or(0),
            level_encoding: header.inside(5, 3).unwrap_or(RLE),
            levels: [least(second(5)?)?, least(second(6)?)?],
            is_compressed: kind != Kind::Second || header.inside(8, 7) != Some(0),
        })
    }

    fn by_dictionary(&self) -> bool {
        matches!(self.encoding, 2 | 8)
    }
}

/// An encoding by its number, where it is one of numbers.
fn encoding(number: i64) -> Option<Encoding> {
    Some(match number {
        0 => Encoding::PLAIN,
        2 => Encoding::PLAIN_DICTIONARY,
        5 => Encoding::DELTA_BINARY_PACKED,
        8 => Encoding::RLE_DICTIONARY,
        9 => Encoding::BYTE_STREAM_SPLIT,
        _ => return None,
    })
}
