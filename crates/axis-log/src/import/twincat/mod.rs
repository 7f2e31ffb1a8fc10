//! Text exports of TwinCAT Scope (Beckhoff).
//!
//! Beckhoff describes the export of [Scope 2](https://infosys.beckhoff.com/content/1033/tcscope2/11171654667.html)
//! and the options of [TwinCAT 3](https://infosys.beckhoff.com/content/1033/te13xx_tc3_scopeview/6193063051.html);
//! [pytcs](https://github.com/CagtayFabry/pytcs) reads the same lines and has exports made with
//! each option:
//!
//! ```text
//! Name→Scope01
//! File→C:\x.csv
//! Starttime of export→132959733843760000→Montag, 2. Mai 2022→15:56:24.376
//! Endtime of export→…
//!
//! Name→SetPos→Name→ActPos
//! SampleTime[ms]→1→SampleTime[ms]→1
//! SymbolName→Axes.X.SetPos→SymbolName→Axes.X.ActPos
//!
//! 0→0,5→0→0,4
//! 1→0,6→1→0,5
//! EOF
//! ```
//!
//! → is a tab, `;`, `,`, `:` or a blank. The key of a header line stands above a column of times, and
//! what is behind it, above channels that were sampled then ("timelines": for each channel,
//! or for each sample time). Times are ms, or 100 ns ticks since 1601 ("full timestamp").
//! A timeline that has ended leaves blank fields, or none if no other is behind it.
//!
//! A table has one time: that of the timeline with the most samples. Channels on others are
//! among the heads, with a fault that says so.

mod blanks;
mod clock;
mod header;
mod keys;
mod line;
mod number;
mod proposal;
mod rows;
mod timeline;

use clock::Clock;
use header::Header;
use rows::{Row, Rows};
use timeline::Timelines;

use super::Format;
use crate::csv_text::Text;
use crate::log::TIME_CHANNEL;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Budget, Fault, Head, Holes, Note, Table};

pub(super) const FORMAT: Format = Format {
    name: "TwinCAT Scope",
    is_it: line::is_it,
    open: |bytes| Ok(Box::new(Export::open(bytes)?)),
    columns: proposal::proposed,
    caution: "positions of the NC are in the unit of the axis, mm or deg; torques and currents are mostly shares of a rated value, in 0.1 % (factor: a thousandth of that value); values that were scaled for the export are in the unit of the display",
};

fn refused(line: u64, reason: &str) -> ReadProblem {
    ReadProblem::Import {
        format: "an export of TwinCAT Scope",
        reason: format!("line {line}: {reason}"),
    }
}

/// An export; the time is its first column.
struct Export<'a> {
    rows: Rows<'a>,
    heads: Vec<Head>,
    /// Number, from 0, of the field of each column.
    fields: Vec<usize>,
    clock: Clock,
    samples: usize,
    /// Size of the file, bytes.
    file: usize,
}

impl<'a> Export<'a> {
    fn open(bytes: &'a [u8]) -> Result<Self, ReadProblem> {
        let text = Text::new(bytes)?;
        let header = Header::read(text.as_str())?;
        let rows = Rows::behind(text, &header)?;
        let timelines = Timelines::of(&header.groups, &rows)?;
        let time = header.groups[timelines.main()].start;
        let mut export = Self {
            rows,
            heads: vec![Head::new(TIME_CHANNEL)],
            fields: vec![time],
            clock: timelines.clock(),
            samples: timelines.samples(),
            file: bytes.len(),
        };
        for (k, group) in header.groups.iter().enumerate() {
            for field in group.clone().skip(1) {
                export.push(&header, field, timelines.fault(k));
            }
        }
        Ok(export)
    }

    fn push(&mut self, header: &Header<'_>, field: usize, fault: Option<Fault>) {
        self.heads.push(Head {
            name: header.names[&field].clone(),
            fault,
            address: header.symbol(field).map(str::to_owned),
            unit: None,
            stored: None,
        });
        self.fields.push(field);
    }

    /// The rows in which the time stands.
    fn samples(&self) -> impl Iterator<Item = Row<'a>> {
        let time = self.fields[0];
        self.rows
            .iter()
            .filter(move |row| !row.field(time).is_empty())
    }

    fn number(&self, row: &Row<'_>, column: usize, holes: Holes) -> Result<f64, ReadProblem> {
        let text = row.field(self.fields[column]);
        let place = || row.place(self.fields[column]);
        let name = || self.heads[column].name.clone();
        let number = match column {
            0 => self.clock.seconds(text),
            _ if text.is_empty() => match holes {
                Holes::Kept => Some(f64::NAN),
                Holes::Refused => {
                    let (place, name) = (place(), name());
                    return Err(ReadProblem::MissingValue { place, name });
                }
            },
            _ => number::value(text),
        };
        number.ok_or_else(|| ReadProblem::NotANumber {
            place: place(),
            name: name(),
            text: text.to_owned(),
        })
    }
}

impl Table for Export<'_> {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn looks_like(&self) -> String {
        "text, timelines of channels".to_owned()
    }

    fn notes(&self) -> Vec<Note> {
        Vec::from_iter(self.rows.end_open().then_some(Note::NoLineEnd))
    }

    fn read(&mut self, wanted: &[usize], holes: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let mut budget = Budget::of(self.file);
        budget.keep((self.samples as u64).saturating_mul(wanted.len() as u64));
        budget.check()?;
        let empty = |_: &usize| Vec::with_capacity(self.samples);
        let mut columns: Vec<Vec<f64>> = wanted.iter().map(empty).collect();
        for row in self.samples() {
            for (column, &index) in columns.iter_mut().zip(wanted) {
                column.push(self.number(&row, index, holes)?);
            }
        }
        Ok(columns)
    }

    /// Only errors ask for it, so it looks for the row anew.
    fn place(&self, row: usize, column: usize) -> Place {
        let field = self.fields[column];
        let found = self.samples().nth(row);
        found.map_or(
            Place::Line {
                line: 1,
                column: field + 1,
            },
            |row| row.place(field),
        )
    }
}
