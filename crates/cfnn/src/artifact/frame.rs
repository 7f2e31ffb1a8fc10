//! The frame around a payload, laid out byte by byte (little-endian):
//!
//! | bytes | content |
//! |---|---|
//! | 8 | magic `CFNN\r\n\x1a\n` (shows damage by text-mode copying) |
//! | 4 | kind, four ASCII letters |
//! | 4 | schema number of that kind |
//! | 8 | length of the payload |
//! | n | payload |
//! | 32 | BLAKE3 of everything before |

use std::string::String;
use std::vec::Vec;

use super::ArtifactError;

const MAGIC: [u8; 8] = *b"CFNN\r\n\x1a\n";
const HEADER: usize = 24;
const HASH: usize = 32;

/// Kind of an artifact, and a schema of it: the one to be written, or the newest
/// that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Format {
    pub kind: [u8; 4],
    pub schema: u32,
}

impl Format {
    /// The same kind in an older schema.
    pub fn older(self, schema: u32) -> Self {
        Self { schema, ..self }
    }
}

pub(super) fn wrap(format: Format, payload: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + payload.len() + HASH);
    bytes.extend_from_slice(&MAGIC);
    bytes.extend_from_slice(&format.kind);
    bytes.extend_from_slice(&format.schema.to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(payload);
    let hash = blake3::hash(&bytes);
    bytes.extend_from_slice(hash.as_bytes());
    bytes
}

/// Schema and payload, after length, hash, kind and schema have been checked, in an
/// order that gives the most telling error.
pub(super) fn unwrap(newest: Format, bytes: &[u8]) -> Result<(u32, &[u8]), ArtifactError> {
    let truncated = |expected: u64| ArtifactError::Truncated {
        found: bytes.len() as u64,
        expected,
    };
    let shown = bytes.len().min(MAGIC.len());
    if bytes[..shown] != MAGIC[..shown] {
        return Err(ArtifactError::NotAnArtifact);
    }
    let Some((header, rest)) = bytes.split_first_chunk::<HEADER>() else {
        return Err(truncated((HEADER + HASH) as u64));
    };
    let length = u64::from_le_bytes(part(header, 16));
    let expected = length.saturating_add((HEADER + HASH) as u64);
    let found = bytes.len() as u64;
    let Some((payload, hash)) = rest.split_last_chunk::<HASH>() else {
        return Err(truncated(expected));
    };
    let intact = blake3::hash(&bytes[..bytes.len() - HASH]) == blake3::Hash::from_bytes(*hash);
    match found.cmp(&expected) {
        // A damaged length field must not be reported as a missing part.
        _ if intact => {}
        core::cmp::Ordering::Less => return Err(truncated(expected)),
        core::cmp::Ordering::Greater => {
            return Err(ArtifactError::TrailingBytes { found, expected });
        }
        core::cmp::Ordering::Equal => return Err(ArtifactError::Damaged),
    }
    if found != expected {
        return Err(ArtifactError::Damaged);
    }
    let kind: [u8; 4] = part(header, 8);
    if kind != newest.kind {
        return Err(ArtifactError::WrongKind {
            found: name(kind),
            expected: name(newest.kind),
        });
    }
    let schema = u32::from_le_bytes(part(header, 12));
    if !(1..=newest.schema).contains(&schema) {
        return Err(ArtifactError::OtherSchema {
            found: schema,
            expected: newest.schema,
        });
    }
    Ok((schema, payload))
}

fn part<const N: usize>(header: &[u8; HEADER], start: usize) -> [u8; N] {
    let mut out = [0; N];
    out.copy_from_slice(&header[start..start + N]);
    out
}

fn name(kind: [u8; 4]) -> String {
    String::from_utf8_lossy(&kind).into_owned()
}
