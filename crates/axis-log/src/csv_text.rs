//! CSV text and the parser's settings, as both CSV readers use them.

use csv::{Position, Reader, StringRecord};

use crate::error::CsvProblem;

pub(crate) const COMMENT: u8 = b'#';
/// Most columns of a file of any format: a header that names more is damaged, or no log.
pub(crate) const MAX_COLUMNS: usize = 4096;

/// The whole text, without byte-order mark.
#[derive(Clone, Copy)]
pub(crate) struct Text<'a> {
    text: &'a str,
    /// Between fields.
    separator: u8,
}

impl<'a> Text<'a> {
    /// Of UTF-8 with commas between fields.
    pub(crate) fn new(bytes: &'a [u8]) -> Result<Self, CsvProblem> {
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Self::of(
                text.strip_prefix('\u{feff}').unwrap_or(text),
                b',',
            )),
            Err(e) => Err(CsvProblem::NotText {
                line: 1 + newlines(&bytes[..e.valid_up_to()]),
            }),
        }
    }

    pub(crate) fn of(text: &'a str, separator: u8) -> Self {
        Self { text, separator }
    }

    pub(crate) fn as_str(self) -> &'a str {
        self.text
    }

    pub(crate) fn parser(self) -> Reader<&'a [u8]> {
        csv::ReaderBuilder::new()
            .has_headers(false)
            // Ragged rows are refused by the readers, with the line, not inside
            // the parser.
            .flexible(true)
            .comment(Some(COMMENT))
            .trim(csv::Trim::All)
            .delimiter(self.separator)
            .from_reader(self.text.as_bytes())
    }

    /// Most rows that a file with that many columns can hold: a row has a byte for each
    /// column at least, its comma or line end.
    pub(crate) fn most_rows(self, columns: usize) -> usize {
        let lines = 1 + self
            .text
            .bytes()
            .filter(|b| matches!(b, b'\n' | b'\r'))
            .count();
        lines.min(1 + self.text.len() / columns.max(1))
    }

    /// Whether something stands behind the last line end: the file may have been cut inside a
    /// number, of which what is left may still read as one.
    pub(crate) fn ends_open(self) -> bool {
        !self.text.is_empty() && !self.text.ends_with(['\n', '\r'])
    }

    /// Refuses more than [`MAX_COLUMNS`] columns.
    pub(crate) fn check_width(self, header: &StringRecord) -> Result<(), CsvProblem> {
        if header.len() <= MAX_COLUMNS {
            return Ok(());
        }
        Err(CsvProblem::TooManyColumns {
            line: self.line_of(header),
            found: header.len(),
            most: MAX_COLUMNS,
        })
    }

    /// Line of a record, from 1.
    pub(crate) fn line_of(self, record: &StringRecord) -> u64 {
        self.line_at(record.position().map_or(0, Position::byte))
    }

    /// Line, from 1, of the record that the parser looked for from that byte on.
    /// The parser's own count is of that byte, before any blank lines and
    /// comments.
    pub(crate) fn line_at(self, offset: u64) -> u64 {
        let mut start = usize::try_from(offset).unwrap_or(0).min(self.text.len());
        for line in self.text.as_bytes()[start..].split_inclusive(|&b| b == b'\n') {
            let blank = line.iter().all(|b| matches!(b, b'\r' | b'\n'));
            if !blank && line[0] != COMMENT {
                break;
            }
            start += line.len();
        }
        1 + newlines(&self.text.as_bytes()[..start])
    }
}

fn newlines(bytes: &[u8]) -> u64 {
    bytes.iter().filter(|&&b| b == b'\n').count() as u64
}
