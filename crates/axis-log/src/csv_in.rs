//! CSV to log.

use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use csv::StringRecord;

use crate::channel::Channel;
use crate::csv_text::Text;
use crate::error::{CsvError, CsvProblem};
use crate::log::{Log, TIME_CHANNEL};
use crate::unit::unit_of;

/// Reads a log from a CSV file.
///
/// The first line names the columns, each name ending in its unit
/// ([`unit_of`](crate::unit_of)); `t_s` must be among them and comes first in
/// the log, wherever it stands in the file. `required` lists further columns
/// without which the file is refused. Fields are separated by commas; blank
/// lines, lines that start with `#`, spaces around a field and a byte-order
/// mark are passed over.
///
/// # Errors
/// A [`CsvError`] with file, line and column: file not readable, empty, a
/// missing or doubled column, more than 4096 columns, an unknown unit, a ragged row,
/// a field that is not a finite number, a time that does not increase.
pub fn read_csv(path: impl AsRef<Path>, required: &[&str]) -> Result<Log, CsvError> {
    let path = path.as_ref();
    let file = path.display().to_string();
    match File::open(path) {
        Ok(reader) => read_csv_from(reader, &file, required),
        Err(source) => Err(CsvError {
            file,
            problem: CsvProblem::Io {
                action: "open it",
                source,
            },
        }),
    }
}

/// Reads a log from CSV text; `source` is the name that errors give to it.
///
/// Reads the text to its end first, and then as [`read_csv`] does.
///
/// # Errors
/// As for [`read_csv`].
pub fn read_csv_from(reader: impl Read, source: &str, required: &[&str]) -> Result<Log, CsvError> {
    read(reader, required).map_err(|problem| CsvError {
        file: source.to_owned(),
        problem,
    })
}

fn read(mut reader: impl Read, required: &[&str]) -> Result<Log, CsvProblem> {
    let mut bytes = Vec::new();
    reader
        .read_to_end(&mut bytes)
        .map_err(|source| CsvProblem::Io {
            action: "read it",
            source,
        })?;
    let text = Text::new(&bytes)?;
    let mut rows = text.parser();
    let mut record = StringRecord::new();
    if !rows.read_record(&mut record)? {
        return Err(CsvProblem::NoHeader);
    }
    let header = Header::parse(text, &record, required)?;
    let most = text.most_rows(header.names.len());
    let mut columns: Vec<Vec<f64>> = (header.names.iter())
        .map(|_| Vec::with_capacity(most))
        .collect();
    while rows.read_record(&mut record)? {
        header.append(&record, &mut columns)?;
    }
    if columns[0].is_empty() {
        return Err(CsvProblem::NoRows { line: header.line });
    }
    Ok(header.into_log(columns))
}

struct Header<'a> {
    text: Text<'a>,
    line: u64,
    names: Vec<String>,
    /// Index of the time column.
    time: usize,
}

impl<'a> Header<'a> {
    fn parse(text: Text<'a>, record: &StringRecord, required: &[&str]) -> Result<Self, CsvProblem> {
        text.check_width(record)?;
        let line = text.line_of(record);
        let names: Vec<String> = record.iter().map(str::to_owned).collect();
        let mut seen = HashMap::new();
        for (index, name) in names.iter().enumerate() {
            if unit_of(name).is_none() {
                return Err(CsvProblem::UnitSuffix {
                    line,
                    column: index + 1,
                    name: name.clone(),
                });
            }
            if let Some(first) = seen.insert(name.as_str(), index) {
                return Err(CsvProblem::DuplicateColumn {
                    line,
                    name: name.clone(),
                    first: first + 1,
                    second: index + 1,
                });
            }
        }
        let find = |column: &str| {
            seen.get(column)
                .copied()
                .ok_or_else(|| CsvProblem::MissingColumn {
                    line,
                    column: column.to_owned(),
                    available: names.clone(),
                })
        };
        let time = find(TIME_CHANNEL)?;
        for column in required {
            find(column)?;
        }
        Ok(Self {
            text,
            line,
            names,
            time,
        })
    }

    fn append(&self, record: &StringRecord, columns: &mut [Vec<f64>]) -> Result<(), CsvProblem> {
        if record.len() != self.names.len() {
            return Err(CsvProblem::Ragged {
                line: self.text.line_of(record),
                found: record.len(),
                expected: self.names.len(),
            });
        }
        for (index, text) in record.iter().enumerate() {
            let value = self.number(record, index, text)?;
            if index == self.time {
                self.check_time(record, columns[index].last().copied(), value)?;
            }
            columns[index].push(value);
        }
        Ok(())
    }

    fn number(&self, record: &StringRecord, index: usize, text: &str) -> Result<f64, CsvProblem> {
        let (column, name) = (index + 1, || self.names[index].clone());
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(CsvProblem::NotFinite {
                line: self.text.line_of(record),
                column,
                name: name(),
                text: text.to_owned(),
            }),
            Err(_) => Err(CsvProblem::NotANumber {
                line: self.text.line_of(record),
                column,
                name: name(),
                text: text.to_owned(),
            }),
        }
    }

    fn check_time(
        &self,
        record: &StringRecord,
        previous: Option<f64>,
        value: f64,
    ) -> Result<(), CsvProblem> {
        match previous {
            Some(previous) if value <= previous => Err(CsvProblem::TimeNotIncreasing {
                line: self.text.line_of(record),
                column: self.time + 1,
                previous,
                value,
            }),
            _ => Ok(()),
        }
    }

    fn into_log(self, columns: Vec<Vec<f64>>) -> Log {
        let mut channels: Vec<Channel> = self
            .names
            .into_iter()
            .zip(columns)
            .map(|(name, samples)| Channel {
                unit: unit_of(&name).unwrap_or_default().to_owned(),
                name,
                samples,
            })
            .collect();
        // The time goes first, the others keep their order.
        channels[..=self.time].rotate_right(1);
        Log::from_checked(channels)
    }
}
