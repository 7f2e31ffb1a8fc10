//! What the pages of a Parquet column claim, checked against the bytes that are
//! there: the decoder takes their word, and would ask for any amount of memory.

use crate::thrift::{Integers, integers};

/// Snappy stores 64 bytes in 3 at best.
const MOST_EXPANSION: u64 = 32;

/// What the pages of one column chunk hold.
#[derive(Default)]
pub(crate) struct Pages {
    /// Values, nulls included.
    pub values: u64,
    /// Bytes of the largest page once decompressed.
    pub largest: u64,
}

/// Walks the pages of a column chunk whose values take `width` bytes each.
///
/// Field numbers are those of parquet.thrift
/// (github.com/apache/parquet-format/blob/master/src/main/thrift/parquet.thrift).
pub(crate) fn pages(chunk: &[u8], width: u64) -> Result<Pages, String> {
    let mut rest = chunk;
    let mut found = Pages::default();
    let mut dictionary = false;
    while !rest.is_empty() {
        let at = chunk.len() - rest.len();
        let refuse = |what: &str| format!("the page at byte {at} of its column {what}");
        let (header, body) = integers(rest).ok_or_else(|| refuse("has a damaged header"))?;
        let number = |value: Option<i64>| {
            let number = value.and_then(|v| i32::try_from(v).ok());
            (number.and_then(|v| u64::try_from(v).ok()))
                .ok_or_else(|| refuse("has a damaged header"))
        };
        let (plain, stored) = (number(header.get(2))?, number(header.get(3))?);
        if stored > body.len() as u64 {
            return Err(refuse("is cut off"));
        }
        if plain > MOST_EXPANSION * (stored + 2) {
            return Err(refuse("claims more bytes than can be in it"));
        }
        match number(header.get(1))? {
            2 => {
                if number(header.inside(7, 1))?.saturating_mul(width) > plain.max(stored) {
                    return Err(refuse("claims more values than can be in it"));
                }
                dictionary = true;
            }
            0 => found.values += number(header.inside(5, 1))?,
            3 => found.values += number(header.inside(8, 1))?,
            _ => {}
        }
        if by_dictionary(&header) && !dictionary {
            return Err(refuse("needs a dictionary, and none is there"));
        }
        found.largest = found.largest.max(plain);
        rest = &body[stored as usize..];
    }
    Ok(found)
}

fn by_dictionary(header: &Integers) -> bool {
    let encoding = header.inside(5, 2).or(header.inside(8, 4));
    matches!(encoding, Some(2 | 8))
}
