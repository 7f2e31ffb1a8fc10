//! The rows of values.

use super::header::Header;
use super::line::{fields, key};
use super::refused;
use crate::csv_text::Text;
use crate::error::CsvProblem;
use crate::read_error::{Place, ReadProblem};

/// What may stand behind the last row.
const END: &str = "EOF";

/// A row, blank fields empty.
pub(super) struct Row<'a> {
    pub line: u64,
    pub fields: Vec<&'a str>,
}

impl<'a> Row<'a> {
    /// A field; empty if the row has ended.
    pub(super) fn field(&self, index: usize) -> &'a str {
        self.fields.get(index).copied().unwrap_or_default()
    }

    pub(super) fn place(&self, field: usize) -> Place {
        Place::Line {
            line: self.line,
            column: field + 1,
        }
    }
}

/// All rows, each as wide as the header allows.
pub(super) struct Rows<'a> {
    text: &'a str,
    separator: char,
    width: usize,
    /// Lines above the first.
    above: usize,
}

impl<'a> Rows<'a> {
    /// Refuses rows of another width than the header's.
    pub(super) fn behind(text: Text<'a>, header: &Header<'_>) -> Result<Self, ReadProblem> {
        let rows = Self {
            text: text.as_str(),
            separator: header.separator,
            width: header.width,
            above: header.lines,
        };
        let mut is_first = true;
        for (line, text) in rows.lines() {
            rows.check(line, text, header, is_first)?;
            is_first = false;
        }
        if is_first {
            return Err(ReadProblem::NoRows);
        }
        Ok(rows)
    }

    /// Whether the last row may have been cut: it has no line end, and no mark is behind it.
    pub(super) fn end_open(&self) -> bool {
        let mut all = self.text.lines().skip(self.above);
        !self.text.ends_with('\n') && !all.any(|line| self.is_end(line))
    }

    fn is_end(&self, line: &str) -> bool {
        key(line, self.separator) == END
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Row<'a>> {
        let (separator, width) = (self.separator, self.width);
        self.lines().map(move |(line, text)| Row {
            line,
            fields: fields(text, separator).take(width).collect(),
        })
    }

    /// Number, from 1, and text of each line that is not blank, to the mark of the end.
    fn lines(&self) -> impl Iterator<Item = (u64, &'a str)> {
        let lines = self.text.lines().zip(1_u64..).skip(self.above);
        let rows = lines.take_while(|(line, _)| !self.is_end(line));
        let rows = rows.filter(|(line, _)| !line.trim().is_empty());
        rows.map(|(line, number)| (number, line))
    }

    fn check(
        &self,
        line: u64,
        text: &str,
        header: &Header<'_>,
        is_first: bool,
    ) -> Result<(), ReadProblem> {
        let starts = |found| {
            header
                .groups
                .binary_search_by_key(&found, |group| group.start)
        };
        let fits = |found| found == self.width || starts(found).is_ok();
        let mut all = fields(text, self.separator);
        let mut found = all.clone().count();
        // Older versions end rows with a separator.
        if !fits(found) && all.next_back() == Some("") {
            found -= 1;
        }
        // Where two timelines begin, a row of two values without time would look like one that
        // has ended.
        if is_first && found != self.width && found == header.names.len() {
            return Err(without_time(line, found));
        }
        match fits(found) {
            true => Ok(()),
            false => Err(self.ragged(line, found)),
        }
    }

    fn ragged(&self, line: u64, found: usize) -> ReadProblem {
        let expected = self.width;
        if self.separator != ',' || found < expected {
            return ReadProblem::Csv(CsvProblem::Ragged {
                line,
                found,
                expected,
            });
        }
        let reason = format!(
            "{found} fields, the header has {expected}: if the decimal mark is a comma, export with a tab or \";\" between fields"
        );
        refused(line, &reason)
    }
}

fn without_time(line: u64, found: usize) -> ReadProblem {
    let reason = format!(
        "{found} values for {found} channels, so without time: export with timelines (\"All\" or \"For each sampletime\"), and only channels that have samples"
    );
    refused(line, &reason)
}
