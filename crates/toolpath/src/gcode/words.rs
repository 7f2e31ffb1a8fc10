//! Lines of a program as words.

use super::GcodeError;

/// A letter and its number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Word {
    pub(super) letter: char,
    pub(super) value: f64,
    pub(super) text: String,
}

/// The words of a line, without comments: `( … )`, and from `;` to the end.
pub(super) fn words(number: usize, line: &str) -> Result<Vec<Word>, GcodeError> {
    let refuse = |word: &str, valid| {
        Err(GcodeError::Word {
            line: number,
            word: word.to_owned(),
            valid,
        })
    };
    let mut plain = String::with_capacity(line.len());
    let mut comment = String::new();
    for c in line.chars() {
        match (c, comment.is_empty()) {
            (';', true) => break,
            (')', true) => return refuse(")", "a comment from ( to )"),
            ('(', true) => comment.push(c),
            (')', false) => comment.clear(),
            (_, false) => comment.push(c),
            (c, true) if c.is_whitespace() => {}
            (c, true) => plain.push(c.to_ascii_uppercase()),
        }
    }
    if !comment.is_empty() {
        return refuse(&comment, "a comment from ( to ) within one line");
    }
    if plain == "%" {
        return Ok(Vec::new());
    }
    let mut words = Vec::new();
    let mut rest = plain.as_str();
    while let Some(letter) = rest.chars().next() {
        let after = &rest[letter.len_utf8()..];
        let end = after.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c)));
        let (number_text, next) = after.split_at(end.unwrap_or(after.len()));
        let text = format!("{letter}{number_text}");
        if !letter.is_ascii_alphabetic() {
            return refuse(&text, "a letter and a number, such as X-1.5");
        }
        let Ok(value) = number_text.parse::<f64>() else {
            return refuse(&text, "a letter and a number, such as X-1.5");
        };
        words.push(Word {
            letter,
            value,
            text,
        });
        rest = next;
    }
    Ok(words)
}
