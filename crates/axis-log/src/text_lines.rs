//! Lines of a text and what stands in them.

use crate::csv_text::COMMENT;

/// What may stand between fields, the surest first: a decimal comma is no separator.
pub(crate) const SEPARATORS: [u8; 3] = [b';', b'\t', b','];

/// Lines that hold something, comments or not.
pub(crate) fn filled(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| !line.trim().is_empty())
}

pub(crate) fn is_comment(line: &str) -> bool {
    line.as_bytes().first() == Some(&COMMENT)
}

/// How often a byte stands outside of quotes.
pub(crate) fn count(line: &str, byte: u8) -> usize {
    let mut quoted = false;
    let outside = |b: &u8| {
        quoted ^= *b == b'"';
        !quoted && *b == byte
    };
    line.bytes().filter(outside).count()
}

/// The names in a line with blanks between them, if they can be that many: words, words with
/// brackets behind them, or what is apart by two blanks.
pub(crate) fn names_between_blanks(line: &str, many: usize) -> Option<Vec<String>> {
    let single = line.split_whitespace().map(str::to_owned).collect();
    [single, with_brackets(line), apart_by_two(line)]
        .into_iter()
        .find(|names: &Vec<String>| names.len() == many)
}

/// Words, a unit in brackets with the one before it.
fn with_brackets(line: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for word in line.split_whitespace() {
        match names.last_mut().filter(|_| word.starts_with(['[', '('])) {
            Some(name) => *name += &format!(" {word}"),
            None => names.push(word.to_owned()),
        }
    }
    names
}

/// What stands between two blanks or more.
fn apart_by_two(line: &str) -> Vec<String> {
    let names = line
        .split("  ")
        .map(str::trim)
        .filter(|name| !name.is_empty());
    names.map(str::to_owned).collect()
}

pub(crate) fn is_number(word: &str) -> bool {
    word.replace(',', ".").parse::<f64>().is_ok()
}
