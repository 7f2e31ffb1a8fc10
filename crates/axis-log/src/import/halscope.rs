//! Captures of LinuxCNC's halscope.
//!
//! Halscope writes, as `write_log_file` in its
//! [source](https://github.com/LinuxCNC/linuxcnc/blob/master/src/hal/utils/scope_files.c) has it:
//!
//! ```text
//! Sampling period is 1000000 ns
//!
//! joint.0.motor-pos-cmd +1.00000000000000 joint.0.motor-pos-fb +0.99900000000000
//! ```
//!
//! a line each sample, name and value of each channel in turn, and no line end behind the last.
//! Its loop runs one line beyond the samples that were captured (`n <= samples`), so the last
//! line is not a sample and is left out.

use super::{Format, ProposedColumn};
use crate::csv_text::MAX_COLUMNS;
use crate::error::CsvProblem;
use crate::log::TIME_CHANNEL;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Head, Holes, Table};

pub(super) const FORMAT: Format = Format {
    name: "LinuxCNC halscope",
    is_it: |bytes| bytes.starts_with(PERIOD.as_bytes()),
    open: |bytes| Ok(Box::new(Capture::read(bytes)?)),
    columns: proposed,
    caution: "the pins of motion(9) are in the machine's units: mm (or inch, deg) as LINEAR_UNITS and ANGULAR_UNITS of its INI file say",
};

const PERIOD: &str = "Sampling period is ";

/// How pins of a joint end, what they are, and their unit on a machine in mm
/// (<https://manpages.ubuntu.com/manpages/noble/man9/motion.9.html>).
const PINS: &[(&str, &str, &str)] = &[
    (".motor-pos-cmd", "position_ref_m", "mm"),
    (".motor-pos-fb", "position_m", "mm"),
    (".vel-cmd", "velocity_ref_m_s", "mm/s"),
    (".acc-cmd", "acceleration_ref_m_s2", "mm/s²"),
];

/// The first pin of each ending: two joints would be one channel.
fn proposed(heads: &[&Head]) -> Vec<ProposedColumn> {
    let one = |(end, channel, unit): &(&str, &'static str, &'static str)| {
        let mut names = heads.iter().map(|head| &head.name);
        let source = names.find(|name| name.starts_with("joint.") && name.ends_with(end))?;
        Some(ProposedColumn {
            source: source.clone(),
            channel,
            unit,
        })
    };
    PINS.iter().filter_map(one).collect()
}

/// A capture; the time is its first column.
struct Capture {
    heads: Vec<Head>,
    columns: Vec<Vec<f64>>,
    /// Line of each sample, from 1.
    lines: Vec<u64>,
}

impl Capture {
    fn read(bytes: &[u8]) -> Result<Self, ReadProblem> {
        let text = std::str::from_utf8(bytes).map_err(|e| {
            let before = &bytes[..e.valid_up_to()];
            let line = 1 + before.iter().filter(|byte| **byte == b'\n').count() as u64;
            CsvProblem::NotText { line }
        })?;
        let period = period(text)?;
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
        let names: Vec<String> = pairs(first).map(|(name, _)| name.to_owned()).collect();
        if names.len() > MAX_COLUMNS {
            return Err(ReadProblem::Csv(CsvProblem::TooManyColumns {
                line: *line,
                found: names.len(),
                most: MAX_COLUMNS,
            }));
        }
        let mut capture = Self {
            heads: Vec::new(),
            columns: vec![Vec::with_capacity(rows.len()); names.len() + 1],
            lines: Vec::with_capacity(rows.len()),
        };
        for (row, (text, line)) in rows.into_iter().enumerate() {
            capture.columns[0].push(row as f64 * period);
            capture.push(text, line, &names)?;
        }
        let time = std::iter::once(TIME_CHANNEL.to_owned());
        capture.heads = time.chain(names).map(Head::new).collect();
        Ok(capture)
    }

    fn push(&mut self, text: &str, line: u64, names: &[String]) -> Result<(), ReadProblem> {
        let found = pairs(text).count();
        if found != names.len() || pairs(text).zip(names).any(|((name, _), own)| name != own) {
            return Err(ReadProblem::Csv(CsvProblem::Ragged {
                line,
                found: 2 * found,
                expected: 2 * names.len(),
            }));
        }
        let columns = self.columns.iter_mut().skip(1).zip(pairs(text));
        for (k, (column, (name, value))) in columns.enumerate() {
            column.push(value.parse().map_err(|_| ReadProblem::NotANumber {
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

/// Names and values in turn; a name without a value has an empty one.
fn pairs(line: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut words = line.split_whitespace();
    std::iter::from_fn(move || Some((words.next()?, words.next().unwrap_or(""))))
}

/// The sampling period, s.
fn period(text: &str) -> Result<f64, ReadProblem> {
    let first = text.lines().next().unwrap_or_default();
    let number = first.strip_prefix(PERIOD).unwrap_or_default();
    let number = number.trim().strip_suffix("ns").unwrap_or(number).trim();
    let period = number.parse::<u32>().ok().filter(|ns| *ns > 0);
    period
        .map(|ns| f64::from(ns) * 1e-9)
        .ok_or_else(|| ReadProblem::NotANumber {
            place: Place::Line { line: 1, column: 1 },
            name: PERIOD.trim().to_owned(),
            text: number.to_owned(),
        })
}

impl Table for Capture {
    fn heads(&self) -> &[Head] {
        &self.heads
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
