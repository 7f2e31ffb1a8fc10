//! Traces of SINUMERIK Operate (Diagnostics > Trace), saved as XML.
//!
//! No description by Siemens was found. Readers of others that do not depend on each other
//! agree on this, among them [Trace-Tools](https://github.com/eliasrhoden/Trace-Tools):
//!
//! ```text
//! <traceSession>
//!   <traceCaptureSetup><sessionSettings sessionName="…"/>…</traceCaptureSetup>
//!   <traceData><dataFrame>
//!     <frameHeader startTime="…"/>
//!     <dataSignal id="f1" name="/Nck/!SD/nckServoDataActPos1stEnc64 [u1, 1]" description="…"/>…
//!     <rec time="0.002" f1="1.5" f2="…"/>…
//!   </dataFrame></traceData>
//! </traceSession>
//! ```
//!
//! Times are in seconds. A signal without `id` has that of its place, `f1` for the first. What
//! a `rec` does not have is as it was: a value holds until the next, and before the first there
//! is none. A `rec` that would have no value is left out: where `datapointCount` and `interval` of
//! the signals count more instants than there are, or none is counted and `dropOuts` is 0, those
//! between are put back and values hold there too. Numbers from
//! [`NOT_MEASURED`](record::NOT_MEASURED) on stand for no value. Columns are
//! named by `description` where it is there and no other has it, by `name` otherwise.

mod record;
mod xml;

use record::Record;

use super::names::distinct;
use super::{Format, Found, by_name};
use crate::log::TIME_CHANNEL;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Budget, Fault, Head, Holes, Note, Table};

pub(super) const FORMAT: Format = Format {
    name: "SINUMERIK trace",
    is_it: xml::is_it,
    open: |bytes| Ok(Box::new(Trace::read(bytes)?)),
    columns: proposed,
    caution: "no document of Siemens describes the format; it is read as other programs read it: compare a value with the control's screen; units are those of the machine, mm (or inch) or deg",
};

/// Channels, signals of an axis that are it, and their unit on a linear axis in mm, as those
/// readers and users of the control have them.
const SIGNALS: &[(&str, &[&str], &str)] = &[
    (
        "position_ref_m",
        &["nckServoDataCmdPos", "cmdContrPos"],
        "mm",
    ),
    ("position_m", &["nckServoDataActPos"], "mm"),
];

fn proposed(heads: &[&Head]) -> Vec<Found> {
    let one = |head: &&Head| {
        let address = head.address.as_deref().unwrap_or_default();
        let is_it = |names: &[&str]| names.iter().any(|name| address.contains(name));
        let axis = axis_of(head);
        match SIGNALS.iter().find(|(_, names, _)| is_it(names)) {
            Some((channel, _, unit)) => Some(Found::of(axis, head, channel, unit)),
            // What the control calls it in words.
            None => by_name::motion(head).map(|found| Found {
                axis: axis.to_owned(),
                ..found
            }),
        }
    };
    heads.iter().filter_map(one).collect()
}

/// `u1, 2` of an address, its unit and the number of its axis.
fn axis_of(head: &Head) -> &str {
    let address = head.address.as_deref().unwrap_or_default();
    let inside = address.find('[').map_or("", |at| &address[at..]);
    inside.trim_matches(['[', ']'])
}

/// A trace; the time is its first column.
struct Trace {
    heads: Vec<Head>,
    record: Record,
    /// Rows that were put back.
    held: usize,
    /// Size of the file, bytes.
    file: usize,
}

impl Trace {
    fn read(bytes: &[u8]) -> Result<Self, ReadProblem> {
        let mut record = xml::read(&xml::text(bytes))?;
        if record.times.is_empty() {
            return Err(ReadProblem::NoRows);
        }
        let held = record.hold(Budget::of(bytes.len()).numbers());
        let names = record.signals.iter();
        let names: Vec<_> = names.map(|s| [&*s.description, &*s.name]).collect();
        let signals = distinct(&names).into_iter().zip(&record.signals);
        let head = |(name, signal): (String, &record::Signal)| Head {
            name,
            fault: signal.other.clone().map(|found| Fault {
                found,
                valid: "a number in each rec",
            }),
            address: Some(signal.name.clone()),
            unit: None,
            stored: None,
        };
        let time = std::iter::once(Head::new(TIME_CHANNEL));
        Ok(Self {
            heads: time.chain(signals.map(head)).collect(),
            record,
            held,
            file: bytes.len(),
        })
    }

    fn column(&self, index: usize, holes: Holes) -> Result<Vec<f64>, ReadProblem> {
        let Some(signal) = index.checked_sub(1) else {
            return Ok(self.record.times.clone());
        };
        let values = self.record.signals[signal].held(self.record.times.len());
        match values.iter().position(|value| value.is_nan()) {
            Some(row) if holes == Holes::Refused => Err(ReadProblem::MissingValue {
                place: self.place(row, index),
                name: self.heads[index].name.clone(),
            }),
            _ => Ok(values),
        }
    }
}

impl Table for Trace {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn looks_like(&self) -> String {
        "XML, values as they change".to_owned()
    }

    fn notes(&self) -> Vec<Note> {
        let rows = self.held;
        Vec::from_iter((rows > 0).then_some(Note::Held { rows }))
    }

    fn read(&mut self, wanted: &[usize], holes: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let mut budget = Budget::of(self.file);
        budget.keep((self.record.times.len() as u64).saturating_mul(wanted.len() as u64));
        budget.check()?;
        let column = |&index: &usize| self.column(index, holes);
        wanted.iter().map(column).collect()
    }

    fn place(&self, row: usize, _: usize) -> Place {
        Place::Row { row: row + 1 }
    }
}
