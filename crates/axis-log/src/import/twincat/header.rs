//! The lines above the values.

use std::collections::HashMap;
use std::ops::Range;

use super::super::names::distinct;
use super::blanks;
use super::keys::{KEYS, SYMBOL};
use super::line::{NAME, fields, key, separator};
use super::number::decimal;
use super::refused;
use crate::csv_text::MAX_COLUMNS;
use crate::error::CsvProblem;
use crate::read_error::ReadProblem;

/// Lines in which a header ends.
const MOST_LINES: usize = 1000;
const BLANKS: &str = "spaces separate the fields and also stand in names, so that fields cannot be separated: export with a tab or \";\"";

/// What the header tells of the values.
pub(super) struct Header<'a> {
    pub separator: char,
    /// Fields of a row.
    pub width: usize,
    /// The field with the time of each timeline, and those of its channels behind it.
    pub groups: Vec<Range<usize>>,
    /// Name of the column of each field that is a channel.
    pub names: HashMap<usize, String>,
    /// Fields of the line of names.
    found: Vec<&'a str>,
    /// Fields of the line of symbols; none if it is missing or does not fit.
    symbols: Vec<&'a str>,
    /// Number of the lines that stand above the values.
    pub lines: usize,
}

impl<'a> Header<'a> {
    pub(super) fn read(text: &'a str) -> Result<Self, ReadProblem> {
        let separator = separator(text.as_bytes()).unwrap_or_default();
        let mut lines = text.lines().enumerate().skip(1);
        let Some((at, line)) = lines.find(|(_, line)| key(line, separator) == NAME) else {
            let reason = "no second line \"Name\" with the channels: export with a header";
            return Err(refused(1, reason));
        };
        let names = match separator {
            ' ' => {
                let below: Vec<&str> = text.lines().skip(at + 1).take(MOST_LINES).collect();
                blanks::names(line, &below).ok_or_else(|| refused(at as u64 + 1, BLANKS))?
            }
            _ => names_of(line, separator, at as u64 + 1)?,
        };
        let mut header = Self::new(separator, names, at + 1);
        header.read_on(lines);
        header.name();
        Ok(header)
    }

    /// A comment of a symbol may go on over lines of its own, blank ones too, so that the header
    /// ends with the last of its keys before the first row that is complete.
    fn read_on(&mut self, lines: impl Iterator<Item = (usize, &'a str)>) {
        for (k, line) in lines {
            let (key, width) = (key(line, self.separator), self.most_fields(line));
            if width >= self.width && decimal(key).is_some() {
                return;
            }
            if KEYS.contains(&key) {
                self.lines = k + 1;
            }
            if key == SYMBOL && width == self.width {
                self.symbols = fields(line, self.separator).collect();
            }
        }
    }

    /// Fields of a line, as far as they tell whether there are as many as names.
    fn most_fields(&self, line: &str) -> usize {
        fields(line, self.separator).take(self.width + 1).count()
    }

    fn new(separator: char, found: Vec<&'a str>, lines: usize) -> Self {
        Self {
            separator,
            width: found.len(),
            groups: groups(&found),
            names: HashMap::new(),
            found,
            symbols: Vec::new(),
            lines,
        }
    }

    fn name(&mut self) {
        let channels = self.groups.iter().flat_map(|group| group.clone().skip(1));
        let channels: Vec<usize> = channels.collect();
        let both = |&k: &usize| [self.found[k], self.symbol(k).unwrap_or_default()];
        let names = distinct(&channels.iter().map(both).collect::<Vec<_>>());
        self.names = channels.into_iter().zip(names).collect();
    }

    /// What the program calls the channel of a field.
    pub(super) fn symbol(&self, field: usize) -> Option<&'a str> {
        let symbol = self.symbols.get(field).copied();
        symbol.filter(|symbol| !symbol.is_empty())
    }
}

/// The fields of the line of names, without an empty one that older versions put last.
fn names_of(line: &str, separator: char, number: u64) -> Result<Vec<&str>, ReadProblem> {
    let found = fields(line, separator).count();
    if found > MAX_COLUMNS {
        return Err(ReadProblem::Csv(CsvProblem::TooManyColumns {
            line: number,
            found,
            most: MAX_COLUMNS,
        }));
    }
    let mut names: Vec<&str> = fields(line, separator).collect();
    if names.last() == Some(&"") {
        names.pop();
    }
    match names.len() {
        0 | 1 => Err(refused(number, "no channel behind \"Name\"")),
        _ => Ok(names),
    }
}

/// A group begins where the key stands again.
fn groups(names: &[&str]) -> Vec<Range<usize>> {
    let mut groups: Vec<Range<usize>> = Vec::new();
    for (k, name) in names.iter().enumerate() {
        match groups.last_mut() {
            // Behind a key stands a channel, even one that is called as the key.
            Some(last) if last.len() == 1 || *name != NAME => last.end = k + 1,
            _ => groups.push(k..k + 1),
        }
    }
    groups
}
