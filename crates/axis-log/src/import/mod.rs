//! Files of other programs, recognised by what is in them.
//!
//! A format is one file and one line of [`FORMATS`]. It gives its columns as the program names
//! them; a mapping makes channels of them, as of any file. What a mapping could be it proposes
//! ([`propose`]), since a program's names tell what was logged and not always in which unit:
//! nothing is applied by itself.

mod by_name;
mod halscope;
mod moteus;
mod names;
mod numbers;
mod sinumerik;
mod sinumerik_trace;
mod stated;
mod twincat;
mod vocabulary;

pub(crate) use stated::{is_rms, stated_unit};

use std::path::Path;

use crate::read_error::{ReadError, ReadProblem};
use crate::table::{Head, Table};

type Opened<'a> = Result<Box<dyn Table + 'a>, ReadProblem>;

/// A format of another program.
struct Format {
    /// What it is called.
    name: &'static str,
    /// Whether the first bytes of a file are of this format.
    is_it: fn(&[u8]) -> bool,
    /// Reads the whole file.
    open: fn(&[u8]) -> Opened<'_>,
    /// What these columns are, all of which can be read, of every axis.
    columns: fn(&[&Head]) -> Vec<Found>,
    /// What the proposal rests on and leaves open.
    caution: &'static str,
}

/// All formats, one line each.
const FORMATS: &[Format] = &[
    halscope::FORMAT,
    moteus::FORMAT,
    sinumerik::FORMAT,
    sinumerik_trace::FORMAT,
    twincat::FORMAT,
];

/// What a column seems to be.
#[derive(Clone)]
struct Found {
    /// Which axis it is of; empty if nothing tells.
    axis: String,
    column: ProposedColumn,
    /// Whether the file itself says the unit, or it is only the usual one.
    is_said: bool,
}

impl Found {
    /// A column of an axis, in a unit that is the usual one there.
    fn of(axis: &str, head: &Head, channel: &'static str, unit: &'static str) -> Self {
        Self {
            axis: axis.to_owned(),
            column: ProposedColumn {
                source: head.name.clone(),
                channel,
                unit,
                factor: None,
            },
            is_said: false,
        }
    }
}

/// A column that a mapping could have.
#[derive(Debug, Clone, PartialEq)]
pub struct ProposedColumn {
    /// Name of the column in the file.
    pub source: String,
    /// The channel that it seems to be.
    pub channel: &'static str,
    /// The unit that it is usually in.
    pub unit: &'static str,
    /// Factor on top of the unit's, where one is needed: √2 of an RMS value.
    pub factor: Option<f64>,
}

/// What the columns of one axis seem to be.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisProposal {
    /// What tells it from the others: a number, or what stands around the names.
    pub axis: String,
    /// Its columns.
    pub columns: Vec<ProposedColumn>,
}

/// What a file is, and what its mapping could be.
#[derive(Debug, Clone, PartialEq)]
pub struct MappingProposal {
    /// Name of the format.
    pub format: &'static str,
    /// Columns of which the name tells what they are: those that all axes share, and those of the
    /// first axis. A log is of one axis.
    pub columns: Vec<ProposedColumn>,
    /// The other axes that the file holds, to be chosen instead.
    pub other_axes: Vec<AxisProposal>,
    /// What the first axis is called, where there are others.
    pub axis: Option<String>,
    /// Columns of which it does not.
    pub others: Vec<String>,
    /// What it rests on and leaves open.
    pub caution: &'static str,
    /// What the numbers say of names and units.
    pub remarks: Vec<String>,
    /// The sampling rate in Hz that the proposed time has, or the file's own.
    pub rate_hz: Option<f64>,
}

impl MappingProposal {
    /// Whether all that the file holds has its channel.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty() && self.others.is_empty()
    }

    /// As lines of an axis file.
    pub fn lines(&self) -> String {
        lines(&self.columns)
    }
}

impl AxisProposal {
    /// As lines of an axis file.
    pub fn lines(&self) -> String {
        lines(&self.columns)
    }
}

fn lines(columns: &[ProposedColumn]) -> String {
    let one = |column: &ProposedColumn| {
        let factor = column.factor.map(|factor| format!("factor = {factor}\n"));
        format!(
            "[[log.column]]\nsource = {:?}\nchannel = \"{}\"\nunit = \"{}\"\n{}",
            column.source,
            column.channel,
            column.unit,
            factor.unwrap_or_default()
        )
    };
    columns.iter().map(one).collect()
}

/// What a file is, by its content, and what mapping it could have: of a recording of another
/// program by the names that this gives, of any other table by what names and units in it seem to
/// say.
/// `None` if nothing is left to map, and of files that are not read.
///
/// # Errors
/// A [`ReadError`]: the file cannot be read, or is damaged.
pub fn propose(path: impl AsRef<Path>) -> Result<Option<MappingProposal>, ReadError> {
    let path = path.as_ref();
    proposal(path).map_err(|problem| ReadError {
        file: path.display().to_string(),
        problem,
    })
}

fn proposal(path: &Path) -> Result<Option<MappingProposal>, ReadProblem> {
    let bytes = crate::by_extension::whole(path)?;
    if let Some(format) = FORMATS.iter().find(|format| (format.is_it)(&bytes)) {
        let table = (format.open)(&bytes)?;
        let found = proposed(table, format.name, format.columns, format.caution);
        return Ok(Some(found));
    }
    match crate::by_extension::by_extension(path, &bytes) {
        Ok(table) => {
            let name = "by the names of the columns";
            let found = proposed(table, name, by_name::proposed, BY_NAME);
            Ok(Some(found).filter(|found| !found.is_empty()))
        }
        Err(ReadProblem::Extension { .. } | ReadProblem::LeftOut { .. }) => Ok(None),
        Err(problem) => Err(problem),
    }
}

/// What the caution of a proposal by names and units alone is.
const BY_NAME: &str =
    "a unit that no name states is a guess (mm, mm/s, deg, rpm, A, N·m): compare with the numbers";

/// The columns of a table that can be read, as `columns` tells what they are.
fn proposed(
    mut table: Box<dyn Table + '_>,
    format: &'static str,
    columns: fn(&[&Head]) -> Vec<Found>,
    caution: &'static str,
) -> MappingProposal {
    let readable = |head: &&Head| head.fault.is_none();
    let heads: Vec<&Head> = table.heads().iter().filter(readable).collect();
    let mut found = columns(&heads);
    let mut remarks = by_name::remarks(&heads);
    let numbers = numbers::checked(&mut *table, &mut found);
    let told = |name: &String| {
        found.iter().any(|found| found.column.source == *name) || crate::unit_of(name).is_some()
    };
    let names = table.names().into_iter();
    let others = names.filter(|name| !told(name)).collect();
    let mut axes = by_axis(&found);
    let first = axes.remove(0);
    remarks.extend(numbers.remarks);
    MappingProposal {
        format,
        axis: (!axes.is_empty()).then_some(first.axis),
        columns: first.columns,
        other_axes: axes,
        others,
        caution,
        remarks,
        rate_hz: numbers.rate_hz,
    }
}

/// The columns of each axis, the first column of a channel; at least one, of which no column need
/// be. What no axis is told of belongs to the first.
fn by_axis(found: &[Found]) -> Vec<AxisProposal> {
    let mut axes: Vec<AxisProposal> = Vec::new();
    for axis in found.iter().map(|found| &found.axis) {
        if !axis.is_empty() && axes.iter().all(|known| known.axis != *axis) {
            let (axis, columns) = (axis.clone(), Vec::new());
            axes.push(AxisProposal { axis, columns });
        }
    }
    if axes.is_empty() {
        let (axis, columns) = (String::new(), Vec::new());
        axes.push(AxisProposal { axis, columns });
    }
    for Found { axis, column, .. } in found {
        let own = axes.iter().position(|known| known.axis == *axis);
        let columns = &mut axes[own.unwrap_or(0)].columns;
        if columns.iter().all(|other| other.channel != column.channel) {
            columns.push(column.clone());
        }
    }
    axes
}

/// The file as a table, where it is of another program.
pub(crate) fn table(bytes: &[u8]) -> Option<Opened<'_>> {
    let format = FORMATS.iter().find(|format| (format.is_it)(bytes))?;
    Some((format.open)(bytes))
}
