//! Captures since 2.9: a table with the sampling period above it.
//!
//! ```text
//! # Sampling period is 1000000 ns
//! joint.0.motor-pos-cmd;joint.0.motor-pos-fb
//! # Position: 0.500000;0.500000
//! # Scale: 3;-2
//! 1.00000000000000;0.99900000000000
//! ```
//!
//! The lines of positions and scales on the screen are there since 2.10.

use super::super::names::distinct;
use super::{PERIOD, period, text};
use crate::csv_table::CsvTable;
use crate::log::TIME_CHANNEL;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Head, Holes, Note, Table};

/// Whether a file begins as these.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    let line = bytes.split(|byte| *byte == b'\n').next();
    line.is_some_and(|line| behind(std::str::from_utf8(line).unwrap_or_default()).is_some())
}

/// What stands behind the words for the period.
fn behind(line: &str) -> Option<&str> {
    line.strip_prefix('#')?.trim_start().strip_prefix(PERIOD)
}

/// A capture; the time is its first column, the others are those of the table.
pub(super) struct Capture<'a> {
    heads: Vec<Head>,
    table: CsvTable<'a>,
    /// s.
    period: f64,
}

impl<'a> Capture<'a> {
    pub(super) fn read(bytes: &'a [u8]) -> Result<Self, ReadProblem> {
        let first = text(bytes)?.lines().next().unwrap_or_default();
        let period = period(behind(first).unwrap_or_default())?;
        let table = CsvTable::with_semicolons(bytes)?;
        let pins = table.names();
        let names = pins.iter().map(|pin| [pin.as_str(), ""]);
        let names = distinct(&names.collect::<Vec<_>>());
        let table = table.with_names(names.clone());
        let time = std::iter::once(TIME_CHANNEL.to_owned());
        Ok(Self {
            heads: time.chain(names).map(Head::new).collect(),
            table,
            period,
        })
    }
}

impl Table for Capture<'_> {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn looks_like(&self) -> String {
        self.table.looks_like()
    }

    fn notes(&self) -> Vec<Note> {
        self.table.notes()
    }

    fn read(&mut self, wanted: &[usize], holes: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        // The first column of the table stands in for the time, which has its rows.
        let inside: Vec<usize> = wanted.iter().map(|k| k.saturating_sub(1)).collect();
        let mut columns = self.table.read(&inside, holes)?;
        for (column, _) in columns.iter_mut().zip(wanted).filter(|(_, k)| **k == 0) {
            let rows = column.len();
            *column = (0..rows).map(|row| row as f64 * self.period).collect();
        }
        Ok(columns)
    }

    fn place(&self, row: usize, column: usize) -> Place {
        self.table.place(row, column.saturating_sub(1))
    }
}
