//! Recordings of SINUMERIK Data Recorder (SINUMERIK Edge, Analyze MyWorkpiece /Capture).
//!
//! [Siemens
//! describes](https://docs.industrial-operations-x.siemens.cloud/r/es-es/1.0.0/sinumerik-data-recorder/accessing-recorded-data/data-output-format/data-output-format-overview)
//! a JSON object with header, payload and footer; the header stands first:
//!
//! ```text
//! { "Header": { "SignalListHFData": [ { "Name": …, "Type": …, "Axis": …, "Address": "ENC_POS|1" }, … ], … },
//!   "Payload": [ { "HFTimestamp": … }, { "HFData": [ [ 4817081, 12.5, … ], … ] }, { "LFData": …
//! }, … ],
//!   "Footer": { "ErrorMessages": [], … } }
//! ```
//!
//! A row of `HFData` has a value for each signal of the header, in its order. Columns are named
//! by `Address`. What else the payload has is left out. `CYCLE` counts position control cycles.
//! How long one is, the described fields do not say; recorders from 3.1 on write it as
//! `CycleTimeMs` of the header (as an
//! [example](https://github.com/max-scw/CaptureDataParser) shows), and the time is made of both.

mod json;

use json::{Cell, File, Signal};

use super::{Format, Found};
use crate::csv_text::MAX_COLUMNS;
use crate::log::TIME_CHANNEL;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Head, Holes, Table};

pub(super) const FORMAT: Format = Format {
    name: "SINUMERIK Data Recorder",
    is_it,
    open: |bytes| Ok(Box::new(Recording::read(bytes)?)),
    columns: proposed,
    caution: "positions are in mm, of an axis that turns in deg (A, B, C and SP by their names); if the header has no CycleTimeMs, map CYCLE to \"t_s\" with the position control cycle in s as factor",
};

/// The signal that counts position control cycles.
const CYCLE: &str = "CYCLE";

/// Signals of an axis whose unit is described, what they are on a linear axis in mm and on one
/// that turns in deg
/// (<https://docs.industrial-operations-x.siemens.cloud/r/de-de/1.0.0/sinumerik-connector/faq/which-hf-data-can-be-collected-via-sinumerik-connector>).
const SIGNALS: &[(&str, &str, &str)] = &[
    ("DES_POS|", "position_ref_m", "position_ref_rad"),
    ("ENC_POS|", "position_m", "position_rad"),
];

/// Names of axes that turn begin with these (ISO 841), and a spindle's so.
const TURN: [&str; 4] = ["A", "B", "C", "SP"];

fn proposed(heads: &[&Head]) -> Vec<Found> {
    let one = |head: &&Head| {
        let mut signals = SIGNALS.iter();
        let (number, linear, turns) = signals.find_map(|(start, linear, turns)| {
            let number = head.name.strip_prefix(start)?;
            Some((number, linear, turns))
        })?;
        let name = head.address.as_deref().unwrap_or_default();
        let axis = match name {
            "" => number.to_owned(),
            name => format!("{number} ({name})"),
        };
        let (channel, unit) = match TURN.iter().any(|start| name.starts_with(start)) {
            true => (turns, "deg"),
            false => (linear, "mm"),
        };
        Some(Found::of(&axis, head, channel, unit))
    };
    heads.iter().filter_map(one).collect()
}

/// `{ "Header"`, with any white space.
fn is_it(bytes: &[u8]) -> bool {
    let inside = bytes.trim_ascii_start().strip_prefix(b"{");
    inside.is_some_and(|rest| rest.trim_ascii_start().starts_with(b"\"Header\""))
}

/// The high-frequency part of a recording.
struct Recording {
    heads: Vec<Head>,
    /// Of the signals, which are the heads behind the time where there is one.
    columns: Vec<Vec<Cell>>,
    /// Index of the signal that counts cycles, and the length of one in s, where both are there.
    time: Option<(usize, f64)>,
}

impl Recording {
    fn read(bytes: &[u8]) -> Result<Self, ReadProblem> {
        let refused = |reason: String| ReadProblem::Import {
            format: "a recording of SINUMERIK Data Recorder",
            reason,
        };
        let file: File = serde_json::from_slice(bytes).map_err(|e| refused(e.to_string()))?;
        let count = file.header.signals.len();
        if count == 0 {
            return Err(refused(
                "the header has no SignalListHFData, so the job recorded no high-frequency signals; no others are read".to_owned(),
            ));
        }
        if count > MAX_COLUMNS {
            return Err(refused(format!(
                "the header lists {count} signals, at most {MAX_COLUMNS} are read"
            )));
        }
        if !file.footer.errors.is_empty() {
            return Err(refused(format!(
                "the recorder reports errors ({}); to read the file all the same, empty ErrorMessages in its footer",
                crate::error::clip(&file.footer.errors.join("; "))
            )));
        }
        let mut columns = vec![Vec::new(); count];
        let rows = file.payload.into_iter().flat_map(|part| part.0);
        for (k, row) in rows.enumerate() {
            if row.len() != count {
                return Err(refused(format!(
                    "row {} of HFData has {} values, the header lists {count} signals",
                    k + 1,
                    row.len()
                )));
            }
            for (column, cell) in columns.iter_mut().zip(row) {
                column.push(cell);
            }
        }
        if columns[0].is_empty() {
            return Err(ReadProblem::NoRows);
        }
        let cycle = file.header.cycle();
        let signals = file.header.signals.into_iter();
        let head = |signal: Signal| Head {
            address: signal.axis,
            ..Head::new(signal.address)
        };
        let signals: Vec<Head> = signals.map(head).collect();
        let counter = signals.iter().position(|head| head.name == CYCLE);
        let time = counter.zip(cycle);
        let first = time.map(|_| Head::new(TIME_CHANNEL));
        Ok(Self {
            heads: first.into_iter().chain(signals).collect(),
            columns,
            time,
        })
    }

    /// Index of the signal of a column, and what its numbers are multiplied by.
    fn signal(&self, column: usize) -> (usize, f64) {
        match (self.time, column.checked_sub(1)) {
            (Some(time), None) => time,
            (Some(_), Some(signal)) => (signal, 1.0),
            (None, _) => (column, 1.0),
        }
    }

    fn number(&self, column: usize, row: usize, holes: Holes) -> Result<f64, ReadProblem> {
        let (signal, factor) = self.signal(column);
        let text = match self.columns[signal][row] {
            Cell::Number(value) => return Ok(value * factor),
            Cell::Null if holes == Holes::Kept => return Ok(f64::NAN),
            Cell::Null => "null",
            Cell::Other => "text, or true or false, or a list",
        };
        Err(ReadProblem::NotANumber {
            place: self.place(row, column),
            name: self.heads[column].name.clone(),
            text: text.to_owned(),
        })
    }
}

impl Table for Recording {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn looks_like(&self) -> String {
        "JSON, high-frequency signals".to_owned()
    }

    fn read(&mut self, wanted: &[usize], holes: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let rows = self.columns[0].len();
        let one = |&column: &usize| {
            (0..rows)
                .map(|row| self.number(column, row, holes))
                .collect()
        };
        wanted.iter().map(one).collect()
    }

    fn place(&self, row: usize, _: usize) -> Place {
        Place::Row { row: row + 1 }
    }
}
