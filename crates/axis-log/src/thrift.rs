//! The integers in a structure of Thrift's compact protocol, as Parquet's page
//! headers are written
//! (github.com/apache/thrift/blob/master/doc/specs/thrift-compact-protocol.md).

/// Structures inside one another; a page header has three.
const MAX_DEPTH: usize = 8;

/// The integers and booleans of a structure and of those directly in it.
#[derive(Default)]
pub(crate) struct Integers(Vec<([i16; 2], i64)>);

impl Integers {
    /// The number of field `id`.
    pub(crate) fn get(&self, id: i16) -> Option<i64> {
        self.at([id, 0])
    }

    /// The number of field `inner` of the structure in field `outer`.
    pub(crate) fn inside(&self, outer: i16, inner: i16) -> Option<i64> {
        self.at([outer, inner])
    }

    fn at(&self, path: [i16; 2]) -> Option<i64> {
        // A field that is given twice counts as it stands last.
        let mut found = self.0.iter().rev();
        found.find(|(p, _)| *p == path).map(|&(_, value)| value)
    }
}

/// The integers of the structure at the start of `bytes`, and what follows it;
/// `None` if it is cut off or no such structure.
pub(crate) fn integers(bytes: &[u8]) -> Option<(Integers, &[u8])> {
    let mut reader = Reader { rest: bytes };
    let mut found = Integers::default();
    reader.structure(0, 0, &mut found)?;
    Some((found, reader.rest))
}

struct Reader<'a> {
    rest: &'a [u8],
}

impl Reader<'_> {
    fn structure(&mut self, outer: i16, depth: usize, found: &mut Integers) -> Option<()> {
        let mut id = 0_i16;
        loop {
            let head = self.byte()?;
            let (delta, kind) = (head >> 4, head & 0xf);
            if kind == 0 {
                return Some(());
            }
            id = match delta {
                0 => i16::try_from(self.zigzag()?).ok()?,
                delta => id.checked_add(i16::from(delta))?,
            };
            let path = if depth == 0 { [id, 0] } else { [outer, id] };
            match kind {
                1 | 2 => found.0.push((path, i64::from(kind == 1))),
                4..=6 => found.0.push((path, self.zigzag()?)),
                12 if depth == 0 => self.structure(id, 1, found)?,
                kind => self.skip(kind, depth)?,
            }
        }
    }

    fn skip(&mut self, kind: u8, depth: usize) -> Option<()> {
        if depth > MAX_DEPTH {
            return None;
        }
        match kind {
            1..=3 => self.byte().map(drop),
            4..=6 => self.zigzag().map(drop),
            7 => self.take(8),
            8 => {
                let length = self.varint()?;
                self.take(usize::try_from(length).ok()?)
            }
            9 | 10 => {
                let head = self.byte()?;
                let count = match head >> 4 {
                    15 => self.varint()?,
                    count => u64::from(count),
                };
                // Each element takes a byte at least, so this ends with the bytes.
                (0..count).try_for_each(|_| self.skip(head & 0xf, depth + 1))
            }
            12 => self.structure(-1, depth + 1, &mut Integers::default()),
            13 => self.take(16),
            _ => None,
        }
    }

    fn byte(&mut self) -> Option<u8> {
        let (&first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(first)
    }

    fn take(&mut self, length: usize) -> Option<()> {
        self.rest = self.rest.get(length..)?;
        Some(())
    }

    fn varint(&mut self) -> Option<u64> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }

    fn zigzag(&mut self) -> Option<i64> {
        let value = self.varint()?;
        Some((value >> 1) as i64 ^ -((value & 1) as i64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_written_by_hand_is_read() {
        // 1: i32 0; 2: i32 24; 5: { 1: i32 3, 5: { 1: binary "ab" } }; 6: list of two i32.
        let header = [
            0x15, 0x00, 0x15, 0x30, 0x3c, 0x15, 0x06, 0x4c, 0x18, 0x02, b'a', b'b', 0x00, 0x00,
            0x19, 0x25, 0x02, 0x04, 0x00, 0xff,
        ];
        let (found, rest) = integers(&header).unwrap();
        assert_eq!([found.get(1), found.get(2)], [Some(0), Some(24)]);
        assert_eq!(found.inside(5, 1), Some(3));
        assert_eq!(found.get(3), None);
        assert_eq!(rest, [0xff]);
        for end in 0..header.len() - 1 {
            assert!(integers(&header[..end]).is_none(), "{end}");
        }
    }

    #[test]
    fn lengths_beyond_the_bytes_are_refused() {
        let huge = [0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f];
        for head in [&[0x18][..], &[0x19, 0xf5], &[0x19, 0xfc]] {
            let bytes = [head, &huge, &[0; 20]].concat();
            assert!(integers(&bytes).is_none(), "{head:?}");
        }
        assert!(integers(&[0x1c; 1000]).is_none());
    }
}
