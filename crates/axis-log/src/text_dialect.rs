//! Tables of text as programs write them: their encoding, and what stands between fields.

use std::borrow::Cow;

use crate::csv_text::Text;
use crate::error::CsvProblem;
use crate::text_lines::{SEPARATORS, count, filled, is_comment, is_number, names_between_blanks};
use crate::text_titles::without_titles;

/// A whole text, the byte between its fields, and whether its columns have names.
pub(crate) struct Dialect<'a> {
    text: Cow<'a, str>,
    separator: u8,
    is_named: bool,
    titles: Vec<String>,
}

impl<'a> Dialect<'a> {
    /// Recognised from the names and the first row, or from a line `sep=;` before them.
    pub(crate) fn of(bytes: &'a [u8]) -> Result<Self, CsvProblem> {
        let text = Self::text_of(bytes)?;
        let (text, said) = without_separator_line(text);
        let (text, titles) = without_titles(text, said);
        Ok(Self {
            titles,
            ..Self::told(text, said)
        })
    }

    /// The same of a program that always writes this byte between fields.
    pub(crate) fn separated_by(bytes: &'a [u8], separator: u8) -> Result<Self, CsvProblem> {
        let text = Cow::Borrowed(Self::text_of(bytes)?);
        Ok(Self::told(text, Some(separator)))
    }

    fn text_of(bytes: &'a [u8]) -> Result<&'a str, CsvProblem> {
        let zero = bytes.iter().position(|&b| b == 0);
        let text = std::str::from_utf8(bytes).map_err(|e| e.valid_up_to());
        let text = zero.map_or(text, Err);
        text.map_err(|at| CsvProblem::NotText {
            line: 1 + bytes[..at].iter().filter(|&&b| b == b'\n').count() as u64,
        })
    }

    fn told(mut text: Cow<'a, str>, said: Option<u8>) -> Self {
        if let Some(mark) = names_in_comment(&text) {
            let mut owned = text.into_owned();
            owned.replace_range(mark..=mark, " ");
            text = Cow::Owned(owned);
        }
        let names = blank_separated(&text).filter(|_| said.is_none());
        let separator = said.or_else(|| separator(&text));
        let (text, separator) = match (separator, names) {
            (None | Some(b','), Some(names)) => {
                // As many lines as before, so that errors name the right one.
                let mut names = Some(names);
                let lines = text.split_inclusive('\n');
                let lines = lines.map(|line| joined(line, &mut names));
                (Cow::Owned(lines.collect()), b'\t')
            }
            _ => (text, separator.unwrap_or(b',')),
        };
        let is_named = has_names(&text, separator);
        Self {
            text,
            separator,
            is_named,
            titles: Vec::new(),
        }
    }

    pub(crate) fn text(&self) -> Text<'_> {
        Text::of(&self.text, self.separator)
    }

    /// Whether the first line holds names, not numbers.
    pub(crate) fn is_named(&self) -> bool {
        self.is_named
    }

    /// Lines above the names that are no part of the table.
    pub(crate) fn titles(&self) -> &[String] {
        &self.titles
    }

    /// What stands between fields, in words.
    pub(crate) fn separator_in_words(&self) -> &'static str {
        match self.separator {
            b';' => "semicolons",
            b'\t' => "tabs or blanks",
            b',' => "commas",
            _ => "other separators",
        }
    }

    /// Whether a comma may stand in a number.
    pub(crate) fn allows_decimal_comma(&self) -> bool {
        self.separator != b','
    }
}

/// The text without the line `sep=;` that Excel puts first, and the byte that it names. The line
/// becomes a comment, so that others keep their numbers.
fn without_separator_line(text: &str) -> (Cow<'_, str>, Option<u8>) {
    let line = text.lines().next().unwrap_or_default();
    let bare = line.trim().trim_matches('"');
    let is_it = bare
        .get(..4)
        .is_some_and(|key| key.eq_ignore_ascii_case("sep="));
    match (is_it, bare.get(4..).map(str::as_bytes)) {
        (true, Some(&[separator])) => {
            let rest = &text[line.len()..];
            (Cow::Owned(format!("#{rest}")), Some(separator))
        }
        // A tab at the end of the line was trimmed.
        (true, _) => (Cow::Owned(format!("#{}", &text[line.len()..])), Some(b'\t')),
        _ => (Cow::Borrowed(text), None),
    }
}

/// Whether the first line that is no comment has a field that is no number, so that it holds
/// names.
fn has_names(text: &str, separator: u8) -> bool {
    let Some(line) = filled(text).find(|line| !is_comment(line)) else {
        return true;
    };
    let fields = line.split(char::from(separator));
    let mut fields = fields
        .map(|field| field.trim().trim_matches('"').trim())
        .filter(|field| !field.is_empty())
        .peekable();
    fields.peek().is_none() || !fields.all(is_number)
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
    // Names are apart as numbers are: a remark of as many words is none.
    let apart = |line: &str| SEPARATORS.map(|separator| count(line, separator) > 0);
    let are_names = |comment: &&str| {
        let names = &comment[1..];
        words(names).len() == numbers.len() && apart(names) == apart(row)
    };
    let comment = filled(text)
        .take_while(|line| is_comment(line))
        .last()
        .filter(are_names)?;
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

/// The names, where names and numbers stand between blanks. A comma behind a word is between
/// fields.
fn blank_separated(text: &str) -> Option<Vec<String>> {
    let [names, row] = first_lines(text)?;
    let row: Vec<&str> = row.split_whitespace().collect();
    let ends_in_comma = |word: &str| word.ends_with(',');
    let mut words = names.split_whitespace().chain(row.iter().copied());
    if row.len() < 2 || !row.iter().copied().all(is_number) || words.any(ends_in_comma) {
        return None;
    }
    names_between_blanks(names, row.len())
}

/// A line with a tab between its words, its end as it was; the first that is no comment has these
/// names.
fn joined(line: &str, names: &mut Option<Vec<String>>) -> String {
    if is_comment(line) || line.trim().is_empty() {
        return line.to_owned();
    }
    let end = if line.ends_with('\n') { "\n" } else { "" };
    match names.take() {
        Some(names) => names.join("\t") + end,
        None => line.split_whitespace().collect::<Vec<_>>().join("\t") + end,
    }
}
