//! CSV text and the parser's settings, as both CSV readers use them.

use csv::{Position, Reader, StringRecord};

use crate::error::CsvProblem;

const COMMENT: u8 = b'#';

/// The whole text, without byte-order mark.
#[derive(Clone, Copy)]
pub(crate) struct Text<'a>(&'a str);

impl<'a> Text<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Result<Self, CsvProblem> {
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Self(text.strip_prefix('\u{feff}').unwrap_or(text))),
            Err(e) => Err(CsvProblem::NotText {
                line: 1 + newlines(&bytes[..e.valid_up_to()]),
            }),
        }
    }

    pub(crate) fn parser(self) -> Reader<&'a [u8]> {
        csv::ReaderBuilder::new()
            .has_headers(false)
            // Ragged rows are refused by the readers, with the line, not inside
            // the parser.
            .flexible(true)
            .comment(Some(COMMENT))
            .trim(csv::Trim::All)
            .from_reader(self.0.as_bytes())
    }

    /// Line of a record, from 1.
    pub(crate) fn line_of(self, record: &StringRecord) -> u64 {
        self.line_at(record.position().map_or(0, Position::byte))
    }

    /// Line, from 1, of the record that the parser looked for from that byte on.
    /// The parser's own count is of that byte, before any blank lines and
    /// comments.
    pub(crate) fn line_at(self, offset: u64) -> u64 {
        let mut start = usize::try_from(offset).unwrap_or(0).min(self.0.len());
        for line in self.0.as_bytes()[start..].split_inclusive(|&b| b == b'\n') {
            let blank = line.iter().all(|b| matches!(b, b'\r' | b'\n'));
            if !blank && line[0] != COMMENT {
                break;
            }
            start += line.len();
        }
        1 + newlines(&self.0.as_bytes()[..start])
    }
}

fn newlines(bytes: &[u8]) -> u64 {
    bytes.iter().filter(|&&b| b == b'\n').count() as u64
}
