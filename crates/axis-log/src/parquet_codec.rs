//! How pages of a Parquet file are compressed.
//!
//! All in Rust, and none asks for more memory than the page's header claims, which was checked.
//! Field meanings are those of
//! [Compression.md](https://github.com/apache/parquet-format/blob/master/Compression.md).

use std::io::Read;

use parquet::basic::Compression;

/// The `plain` bytes that a page of these bytes holds; why not in words.
pub(crate) fn decompressed(
    codec: Compression,
    stored: &[u8],
    plain: usize,
) -> Result<Vec<u8>, String> {
    let bytes = match codec {
        Compression::UNCOMPRESSED => Some(stored.to_vec()),
        Compression::SNAPPY => snappy(stored, plain),
        Compression::GZIP(_) => read(flate2::read::MultiGzDecoder::new(stored), plain),
        Compression::ZSTD(_) => zstd(stored, plain),
        Compression::BROTLI(_) => read(
            brotli_decompressor::Decompressor::new(stored, BUFFER),
            plain,
        ),
        Compression::LZ4_RAW => block(stored, plain),
        Compression::LZ4 => hadoop(stored, plain).or_else(|| block(stored, plain)),
        Compression::LZO => {
            return Err(
                "is compressed by LZO: save it with Snappy, zstd, gzip, LZ4 or Brotli".to_owned(),
            );
        }
    };
    let whole = bytes.filter(|bytes| bytes.len() == plain);
    whole.ok_or_else(|| "does not hold what its header says, so it is damaged".to_owned())
}

/// Bytes that Brotli's reader takes at a time.
const BUFFER: usize = 4096;

/// What a reader gives, to one byte beyond what it should.
fn read(from: impl Read, plain: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(plain);
    let most = plain as u64 + 1;
    from.take(most).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

fn snappy(stored: &[u8], plain: usize) -> Option<Vec<u8>> {
    let claimed = snap::raw::decompress_len(stored).ok()?;
    let mut bytes = vec![0; plain];
    let length = (claimed == plain).then(|| {
        snap::raw::Decoder::new()
            .decompress(stored, &mut bytes)
            .ok()
    })?;
    bytes.truncate(length?);
    Some(bytes)
}

/// Frames one behind the other, as a writer may make of long pages.
fn zstd(mut stored: &[u8], plain: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(plain);
    while !stored.is_empty() && bytes.len() <= plain {
        let most = (plain - bytes.len()) as u64 + 1;
        let frame = ruzstd::decoding::StreamingDecoder::new(&mut stored).ok()?;
        frame.take(most).read_to_end(&mut bytes).ok()?;
    }
    Some(bytes)
}

fn block(stored: &[u8], plain: usize) -> Option<Vec<u8>> {
    let mut bytes = vec![0; plain];
    let length = lz4_flex::block::decompress_into(stored, &mut bytes).ok()?;
    bytes.truncate(length);
    Some(bytes)
}

/// LZ4 as Hadoop frames it: before each block its length plain and stored, the great end first.
fn hadoop(mut stored: &[u8], plain: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(plain);
    while !stored.is_empty() {
        let (lengths, rest) = stored.split_first_chunk::<8>()?;
        let [a, b, c, d, e, f, g, h] = *lengths;
        let own = u32::from_be_bytes([a, b, c, d]) as usize;
        let length = u32::from_be_bytes([e, f, g, h]) as usize;
        if own > plain - bytes.len() || length > rest.len() {
            return None;
        }
        let (body, rest) = rest.split_at(length);
        bytes.extend(block(body, own).filter(|body| body.len() == own)?);
        stored = rest;
    }
    Some(bytes)
}
