//! Captures up to 2.8: names and values in turn.
//!
//! ```text
//! Sampling period is 1000000 nSec
//!
//! joint.0.motor-pos-cmd +1.00000000000000 joint.0.motor-pos-fb +0.99900000000000
//! ```
//!
//! A line each sample, and no line end behind the last. Decimals have the mark of the user's
//! locale. The program's loop runs one line beyond the samples that were captured
//! (`n <= samples`), so the last line is not a sample and is left out.

use super::super::names::distinct;
use super::{PERIOD, period, text};
use crate::csv_text::MAX_COLUMNS;
use crate::error::CsvProblem;
use crate::log::TIME_CHANNEL;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Head, Holes, Table};

/// A capture; the time is its first column.
pub(super) struct Capture {
    heads: Vec<Head>,
    columns: Vec<Vec<f64>>,
    /// Line of each sample, from 1.
    lines: Vec<u64>,
}

impl Capture {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, ReadProblem> {
        let text = text(bytes)?;
        let first = text.lines().next().unwrap_or_default();
        let period = period(first.strip_prefix(PERIOD).unwrap_or_default())?;
        let mut lines = text.lines().zip(1_u64..).skip(1);
        let mut rows: Vec<(&str, u64)> = lines
            .by_ref()
            .filter(|(line, _)| !line.trim().is_empty())
            .collect();
        // Behind the samples.
        rows.pop();
        let Some((first, line)) = rows.first() else {
            return Err(ReadProblem::NoRows);
        };
        let pins: Vec<&str> = pairs(first).map(|(name, _)| name).collect();
        if pins.len() > MAX_COLUMNS {
            return Err(ReadProblem::Csv(CsvProblem::TooManyColumns {
                line: *line,
                found: pins.len(),
                most: MAX_COLUMNS,
            }));
        }
        let mut capture = Self {
            heads: Vec::new(),
            columns: vec![Vec::with_capacity(rows.len()); pins.len() + 1],
            lines: Vec::with_capacity(rows.len()),
        };
        for (row, &(text, line)) in rows.iter().enumerate() {
            capture.columns[0].push(row as f64 * period);
            capture.push(text, line, &pins)?;
        }
        let names = pins.iter().map(|pin| [*pin, ""]).collect::<Vec<_>>();
        let time = std::iter::once(TIME_CHANNEL.to_owned());
        capture.heads = time.chain(distinct(&names)).map(Head::new).collect();
        Ok(capture)
    }

    fn push(&mut self, text: &str, line: u64, pins: &[&str]) -> Result<(), ReadProblem> {
        let found = pairs(text).count();
        if found != pins.len() || pairs(text).zip(pins).any(|((name, _), own)| name != *own) {
            return Err(ReadProblem::Csv(CsvProblem::Ragged {
                line,
                found: 2 * found,
                expected: 2 * pins.len(),
            }));
        }
        let columns = self.columns.iter_mut().skip(1).zip(pairs(text));
        for (k, (column, (name, value))) in columns.enumerate() {
            column.push(number(value).ok_or_else(|| ReadProblem::NotANumber {
                place: Place::Line {
                    line,
                    column: 2 * k + 2,
                },
                name: name.to_owned(),
                text: value.to_owned(),
            })?);
        }
        self.lines.push(line);
        Ok(())
    }
}

/// A number with either decimal mark: `printf` writes no other sign into it.
fn number(text: &str) -> Option<f64> {
    text.parse()
        .or_else(|_| text.replacen(',', ".", 1).parse())
        .ok()
}

/// Names and values in turn; a name without a value has an empty one.
fn pairs(line: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut words = line.split_whitespace();
    std::iter::from_fn(move || Some((words.next()?, words.next().unwrap_or(""))))
}

impl Table for Capture {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn looks_like(&self) -> String {
        "text, names and values in turn".to_owned()
    }

    fn read(&mut self, wanted: &[usize], _: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        Ok(wanted.iter().map(|&k| self.columns[k].clone()).collect())
    }

    fn place(&self, row: usize, column: usize) -> Place {
        Place::Line {
            line: self.lines.get(row).copied().unwrap_or(1),
            column: 2 * column.max(1),
        }
    }
}
