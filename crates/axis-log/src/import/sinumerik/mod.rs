//! Recordings of SINUMERIK Data Recorder (SINUMERIK Edge, Analyze MyWorkpiece /Capture).
//!
//! [Siemens describes](https://docs.industrial-operations-x.siemens.cloud/r/es-es/1.0.0/sinumerik-data-recorder/accessing-recorded-data/data-output-format/data-output-format-overview)
//! a JSON object with header, payload and footer; the header stands first:
//!
//! ```text
//! { "Header": { "SignalListHFData": [ { "Name": …, "Type": …, "Axis": …, "Address": "ENC_POS|1" }, … ], … },
//!   "Payload": [ { "HFTimestamp": … }, { "HFData": [ [ 4817081, 12.5, … ], … ] }, { "LFData": … }, … ],
//!   "Footer": { "ErrorMessages": [], … } }
//! ```
//!
//! A row of `HFData` has a value for each signal of the header, in its order. Columns are named
//! by `Address`. What else the payload has is left out. `CYCLE` counts position control cycles;
//! how long one is, the described fields do not say, so that no time is made of it here.

mod json;

use json::{Cell, File, Signal};

use super::{Format, ProposedColumn};
use crate::csv_text::MAX_COLUMNS;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Head, Holes, Table};

pub(super) const FORMAT: Format = Format {
    name: "SINUMERIK Data Recorder",
    is_it,
    open: |bytes| Ok(Box::new(Recording::read(bytes)?)),
    columns: proposed,
    caution: "map CYCLE to \"t_s\" with the position control cycle in s as factor; positions are in mm, of an axis that turns in deg",
};

/// Signals of an axis whose unit is described, what they are, and their unit on a linear axis
/// (<https://docs.industrial-operations-x.siemens.cloud/r/de-de/1.0.0/sinumerik-connector/faq/which-hf-data-can-be-collected-via-sinumerik-connector>).
const SIGNALS: &[(&str, &str, &str)] = &[
    ("DES_POS|", "position_ref_m", "mm"),
    ("ENC_POS|", "position_m", "mm"),
];

/// Those of the first axis that has one: two axes would be one channel.
fn proposed(heads: &[&Head]) -> Vec<ProposedColumn> {
    let axis_of = |head: &&Head| {
        let mut signals = SIGNALS.iter();
        signals.find_map(|(start, ..)| head.name.strip_prefix(start).map(str::to_owned))
    };
    let Some(axis) = heads.iter().find_map(axis_of) else {
        return Vec::new();
    };
    let one = |(start, channel, unit): &(&str, &'static str, &'static str)| {
        let source = format!("{start}{axis}");
        let is_there = heads.iter().any(|head| head.name == source);
        is_there.then_some(ProposedColumn {
            source,
            channel,
            unit,
        })
    };
    SIGNALS.iter().filter_map(one).collect()
}

/// `{ "Header"`, with any white space.
fn is_it(bytes: &[u8]) -> bool {
    let inside = bytes.trim_ascii_start().strip_prefix(b"{");
    inside.is_some_and(|rest| rest.trim_ascii_start().starts_with(b"\"Header\""))
}

/// The high-frequency part of a recording.
struct Recording {
    heads: Vec<Head>,
    columns: Vec<Vec<Cell>>,
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
                "the recorder tells of errors ({}); to read the file all the same, empty ErrorMessages in its footer",
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
        let signals = file.header.signals.into_iter();
        let head = |signal: Signal| Head::new(signal.address);
        Ok(Self {
            heads: signals.map(head).collect(),
            columns,
        })
    }

    fn number(&self, column: usize, row: usize, holes: Holes) -> Result<f64, ReadProblem> {
        let text = match self.columns[column][row] {
            Cell::Number(value) => return Ok(value),
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
