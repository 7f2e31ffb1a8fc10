//! Parquet files written byte by byte, so that pages may be compressed by what the library that
//! writes the others was not built with. Field numbers are those of parquet.thrift.

use std::io::Write;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Codec {
    Plain = 0,
    Snappy = 1,
    Gzip = 2,
    Brotli = 4,
    Lz4Hadoop = 5,
    Zstd = 6,
    Lz4 = 7,
}

impl Codec {
    pub const ALL: [Self; 7] = [
        Self::Plain,
        Self::Snappy,
        Self::Gzip,
        Self::Brotli,
        Self::Lz4Hadoop,
        Self::Zstd,
        Self::Lz4,
    ];

    fn compressed(self, plain: &[u8]) -> Vec<u8> {
        match self {
            Self::Plain => plain.to_vec(),
            Self::Snappy => snap::raw::Encoder::new().compress_vec(plain).unwrap(),
            Self::Gzip => {
                let mut to = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::new(6));
                to.write_all(plain).unwrap();
                to.finish().unwrap()
            }
            Self::Brotli => stored_brotli(plain),
            Self::Zstd => ruzstd::encoding::compress_to_vec(
                plain,
                ruzstd::encoding::CompressionLevel::Fastest,
            ),
            Self::Lz4 => lz4_flex::block::compress(plain),
            Self::Lz4Hadoop => {
                let block = lz4_flex::block::compress(plain);
                let lengths = [plain.len() as u32, block.len() as u32].map(u32::to_be_bytes);
                [&lengths.concat()[..], &block].concat()
            }
        }
    }
}

/// Brotli with its bytes as they are (RFC 7932, section 9.2): a window of 16 bits, a meta-block that
/// is stored, an empty last one. Bits come the least first.
fn stored_brotli(plain: &[u8]) -> Vec<u8> {
    assert!((1..=1 << 16).contains(&plain.len()));
    // WBITS 16: 0. ISLAST 0, MNIBBLES 4: 00, MLEN − 1 in 16 bits, ISUNCOMPRESSED 1.
    let head = ((plain.len() as u32 - 1) << 4) | (1 << 20);
    let mut bytes = head.to_le_bytes()[..3].to_vec();
    bytes.extend(plain);
    // ISLAST 1, ISLASTEMPTY 1.
    bytes.push(0b11);
    bytes
}

/// A column, each of whose values may be missing.
#[derive(Clone)]
pub enum Stored {
    Doubles(Vec<Option<f64>>),
    /// Time stamps of "ms", "us" or "ns".
    Stamps(Vec<i64>, &'static str),
}

/// A file of one row group and one page a column, of the second kind where asked.
pub fn file(columns: &[(&str, Stored)], codec: Codec, second: bool) -> Vec<u8> {
    let mut bytes = b"PAR1".to_vec();
    let mut chunks = Vec::new();
    for (name, stored) in columns {
        let start = bytes.len() as i64;
        let page = page(stored, codec, second);
        bytes.extend(&page);
        chunks.push(chunk(name, stored, codec, start, page.len() as i64));
    }
    let rows = rows(&columns[0].1) as i64;
    let mut schema = vec![
        Thrift::default()
            .text(4, "schema")
            .int(5, columns.len() as i64),
    ];
    schema.extend(columns.iter().map(|(name, stored)| schema_of(name, stored)));
    let total = bytes.len() as i64;
    let group = Thrift::default()
        .list(1, &chunks)
        .int(2, total)
        .int(3, rows);
    let footer = Thrift::default()
        .int(1, 2)
        .list(2, &schema)
        .int(3, rows)
        .list(4, &[group])
        .end();
    bytes.extend(&footer);
    bytes.extend((footer.len() as u32).to_le_bytes());
    bytes.extend(b"PAR1");
    bytes
}

fn rows(stored: &Stored) -> usize {
    match stored {
        Stored::Doubles(values) => values.len(),
        Stored::Stamps(values, _) => values.len(),
    }
}

fn kind(stored: &Stored) -> i64 {
    match stored {
        Stored::Doubles(_) => 5,
        Stored::Stamps(..) => 2,
    }
}

fn schema_of(name: &str, stored: &Stored) -> Thrift {
    let column = Thrift::default()
        .int(1, kind(stored))
        .int(3, 1)
        .text(4, name);
    let Stored::Stamps(_, unit) = stored else {
        return column;
    };
    let number = match *unit {
        "ms" => 1,
        "us" => 2,
        _ => 3,
    };
    // LogicalType.TIMESTAMP: not in UTC, and its unit.
    let unit = Thrift::default().inside(number, Thrift::default());
    let stamp = Thrift::default().no(1).inside(2, unit);
    column.inside(10, Thrift::default().inside(8, stamp))
}

fn chunk(name: &str, stored: &Stored, codec: Codec, start: i64, length: i64) -> Thrift {
    let data = Thrift::default()
        .int(1, kind(stored))
        .ints(2, &[0, 3])
        .texts(3, &[name])
        .int(4, codec as i64)
        .int(5, rows(stored) as i64)
        .int(6, length)
        .int(7, length)
        .int(9, start);
    Thrift::default().int(2, start).inside(3, data)
}

fn page(stored: &Stored, codec: Codec, second: bool) -> Vec<u8> {
    let rows = rows(stored);
    let (present, values): (Vec<bool>, Vec<u8>) = match stored {
        Stored::Doubles(all) => (
            all.iter().map(Option::is_some).collect(),
            all.iter().flatten().flat_map(|v| v.to_le_bytes()).collect(),
        ),
        Stored::Stamps(all, _) => (
            vec![true; rows],
            all.iter().flat_map(|v| v.to_le_bytes()).collect(),
        ),
    };
    // One bit a value, in groups of eight.
    let groups = rows.div_ceil(8);
    let mut levels = varint((groups as u64) << 1 | 1);
    levels.extend(present.chunks(8).map(|eight| {
        let bit = |(k, p): (usize, &bool)| u8::from(*p) << k;
        eight.iter().enumerate().map(bit).sum::<u8>()
    }));
    let nulls = present.iter().filter(|p| !**p).count() as i64;
    let (body, plain, header) = if second {
        let body = [&levels[..], &codec.compressed(&values)].concat();
        let header = Thrift::default()
            .int(1, rows as i64)
            .int(2, nulls)
            .int(3, rows as i64)
            .int(4, 0)
            .int(5, levels.len() as i64)
            .int(6, 0);
        (body, levels.len() + values.len(), header)
    } else {
        let length = (levels.len() as u32).to_le_bytes();
        let plain = [&length[..], &levels, &values].concat();
        let header = Thrift::default()
            .int(1, rows as i64)
            .int(2, 0)
            .int(3, 3)
            .int(4, 3);
        (codec.compressed(&plain), plain.len(), header)
    };
    let (kind, field) = if second { (3, 8) } else { (0, 5) };
    let head = Thrift::default()
        .int(1, kind)
        .int(2, plain as i64)
        .int(3, body.len() as i64)
        .inside(field, header)
        .end();
    [head, body].concat()
}

fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

fn zigzag(value: i64) -> Vec<u8> {
    varint((value << 1 ^ value >> 63) as u64)
}

/// A structure of Thrift's compact protocol, its fields in rising order.
#[derive(Default, Clone)]
struct Thrift {
    bytes: Vec<u8>,
    last: i16,
}

impl Thrift {
    fn field(mut self, id: i16, kind: u8, content: &[u8]) -> Self {
        assert!((1..16).contains(&(id - self.last)));
        self.bytes.push(((id - self.last) as u8) << 4 | kind);
        self.bytes.extend(content);
        self.last = id;
        self
    }

    fn int(self, id: i16, value: i64) -> Self {
        // i64 and i32 are written alike; the reader asks for either by the field.
        self.field(id, 5, &zigzag(value))
    }

    fn no(self, id: i16) -> Self {
        self.field(id, 2, &[])
    }

    fn text(self, id: i16, text: &str) -> Self {
        let content = [varint(text.len() as u64), text.as_bytes().to_vec()].concat();
        self.field(id, 8, &content)
    }

    fn inside(self, id: i16, inner: Self) -> Self {
        self.field(id, 12, &inner.end())
    }

    fn list(self, id: i16, all: &[Self]) -> Self {
        let items: Vec<u8> = all.iter().flat_map(|one| one.clone().end()).collect();
        let content = [list_head(all.len(), 12), items].concat();
        self.field(id, 9, &content)
    }

    fn ints(self, id: i16, all: &[i64]) -> Self {
        let items: Vec<u8> = all.iter().flat_map(|n| zigzag(*n)).collect();
        self.field(id, 9, &[list_head(all.len(), 5), items].concat())
    }

    fn texts(self, id: i16, all: &[&str]) -> Self {
        let item = |t: &&str| [varint(t.len() as u64), t.as_bytes().to_vec()].concat();
        let items: Vec<u8> = all.iter().flat_map(item).collect();
        self.field(id, 9, &[list_head(all.len(), 8), items].concat())
    }

    fn end(mut self) -> Vec<u8> {
        self.bytes.push(0);
        self.bytes
    }
}

fn list_head(length: usize, kind: u8) -> Vec<u8> {
    match length {
        0..15 => vec![(length as u8) << 4 | kind],
        _ => [vec![0xf0 | kind], varint(length as u64)].concat(),
    }
}
