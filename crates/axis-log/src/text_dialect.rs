//! Tables of text as programs write them: their encoding, and what stands between fields.

use std::borrow::Cow;

use crate::csv_text::{COMMENT, Text};
use crate::error::CsvProblem;

/// A whole text and the byte between its fields.
pub(crate) struct Dialect<'a> {
    text: Cow<'a, str>,
    separator: u8,
}

/// What may stand between fields, the surest first: a decimal comma is no separator.
const SEPARATORS: [u8; 3] = [b';', b'\t', b','];

impl<'a> Dialect<'a> {
    /// Told from the names and the first row.
    pub(crate) fn of(bytes: &'a [u8]) -> Result<Self, CsvProblem> {
        let mut text = decoded(bytes)?;
        if let Some(mark) = names_in_comment(&text) {
            let mut owned = text.into_owned();
            owned.replace_range(mark..=mark, " ");
            text = Cow::Owned(owned);
        }
        let separator = separator(&text);
        if separator.is_none() && is_blank_separated(&text) {
            // As many lines as before, so that errors name the right one.
            return Ok(Self {
                text: Cow::Owned(text.split_inclusive('\n').map(joined).collect()),
                separator: b'\t',
            });
        }
        Ok(Self {
            text,
            separator: separator.unwrap_or(b','),
        })
    }

    pub(crate) fn text(&self) -> Text<'_> {
        Text::of(&self.text, self.separator)
    }

    /// Whether a comma may stand in a number.
    pub(crate) fn allows_decimal_comma(&self) -> bool {
        self.separator != b','
    }
}

/// UTF-8; UTF-16 where a byte-order mark says so; else what Windows and drives write for the
/// signs of Western languages (ISO 8859-1), as long as it is text at all.
fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, CsvProblem> {
    let wide = |unit: fn([u8; 2]) -> u16| {
        let units = bytes[2..].chunks_exact(2);
        let units: Vec<u16> = units.map(|pair| unit([pair[0], pair[1]])).collect();
        String::from_utf16(&units).map(Cow::Owned)
    };
    let not_text = |at: usize| CsvProblem::NotText {
        line: 1 + bytes[..at].iter().filter(|&&b| b == b'\n').count() as u64,
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes).map_err(|_| not_text(0)),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes).map_err(|_| not_text(0)),
        _ => {
            if let Some(at) = bytes.iter().position(|&b| b == 0) {
                return Err(not_text(at));
            }
            Ok(match std::str::from_utf8(bytes) {
                Ok(text) => Cow::Borrowed(text.strip_prefix('\u{feff}').unwrap_or(text)),
                Err(_) => Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect()),
            })
        }
    }
}

/// Lines that hold something, comments or not.
fn filled(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| !line.trim().is_empty())
}

fn is_comment(line: &str) -> bool {
    line.as_bytes().first() == Some(&COMMENT)
}

/// The first two lines that are no comments: names and a row.
fn first_lines(text: &str) -> Option<[&str; 2]> {
    let mut lines = filled(text).filter(|line| !is_comment(line));
    Some([lines.next()?, lines.next()?])
}

/// Where `#` stands before the names, as numerical programs write them: in the last comment
/// before rows that begin without any, with a name for each number.
fn names_in_comment(text: &str) -> Option<usize> {
    let row = filled(text).find(|line| !is_comment(line))?;
    let numbers = words(row);
    if numbers.is_empty() || !numbers.iter().all(|word| is_number(word)) {
        return None;
    }
    let comment = filled(text)
        .take_while(|line| is_comment(line))
        .last()
        .filter(|comment| words(&comment[1..]).len() == numbers.len())?;
    // Both are parts of one text.
    Some(comment.as_ptr() as usize - text.as_ptr() as usize)
}

/// Words between any separators.
fn words(line: &str) -> Vec<&str> {
    let between = |c: char| c.is_whitespace() || c == ';' || c == ',';
    line.split(between)
        .filter(|word| !word.is_empty())
        .collect()
}

/// The separator that names and first row have equally often; of those that do not agree, one
/// that the names have.
fn separator(text: &str) -> Option<u8> {
    let lines = first_lines(text);
    let agrees = |s: &u8| {
        lines.is_some_and(|[names, row]| {
            let found = count(names, *s);
            found > 0 && found == count(row, *s)
        })
    };
    let names = filled(text).find(|line| !is_comment(line)).unwrap_or("");
    let is_there = |s: &u8| count(names, *s) > 0;
    let mut all = SEPARATORS.into_iter();
    all.find(agrees)
        .or_else(|| [b',', b';', b'\t'].into_iter().find(is_there))
}

/// How often a byte stands outside of quotes.
fn count(line: &str, byte: u8) -> usize {
    let mut quoted = false;
    let outside = |b: &u8| {
        quoted ^= *b == b'"';
        !quoted && *b == byte
    };
    line.bytes().filter(outside).count()
}

/// Whether each name and each number stands between blanks.
fn is_blank_separated(text: &str) -> bool {
    first_lines(text).is_some_and(|[names, row]| {
        let (names, mut row) = (names.split_whitespace().count(), row.split_whitespace());
        names > 1 && row.clone().count() == names && row.all(is_number)
    })
}

fn is_number(word: &str) -> bool {
    word.replace(',', ".").parse::<f64>().is_ok()
}

/// A line with a tab between its words, its end as it was.
fn joined(line: &str) -> String {
    if is_comment(line) {
        return line.to_owned();
    }
    let end = if line.ends_with('\n') { "\n" } else { "" };
    line.split_whitespace().collect::<Vec<_>>().join("\t") + end
}
