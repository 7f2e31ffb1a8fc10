//! What the file formats have in common: named columns of numbers.

use std::fmt;

use crate::error::clip;
use crate::read_error::{Place, ReadProblem};
use crate::unit::unit_of;

/// A file that has been opened: its columns are known, its numbers not yet read.
pub(crate) trait Table {
    /// All columns in the order of the file.
    fn heads(&self) -> &[Head];

    /// Parts of the file that are not among the heads, because they are damaged.
    fn unreadable(&self) -> usize {
        0
    }

    /// What the file looks like, in a few words: `text, semicolons between fields`.
    fn looks_like(&self) -> String;

    /// What was taken for granted about the file, to be told.
    fn notes(&self) -> Vec<Note> {
        Vec::new()
    }

    /// The numbers of these columns (indices into the heads, none of which has
    /// a fault). NaN passes through; what is not a number at all does not. An empty field
    /// is refused, or read as NaN.
    fn read(&mut self, wanted: &[usize], holes: Holes) -> Result<Vec<Vec<f64>>, ReadProblem>;

    /// Where the sample `row` of a column stands, both from 0.
    fn place(&self, row: usize, column: usize) -> Place;

    fn names(&self) -> Vec<String> {
        self.heads().iter().map(|h| h.name.clone()).collect()
    }

    /// Which of these rows hold the same as the row before them, in every column that can be read.
    fn repeats(&mut self, rows: &[usize]) -> Result<Vec<bool>, ReadProblem> {
        let mut same = vec![true; rows.len()];
        for column in 0..self.heads().len() {
            if self.heads()[column].fault.is_some() {
                continue;
            }
            let values = match self.read(&[column], Holes::Kept) {
                Ok(mut columns) => columns.pop().unwrap_or_default(),
                Err(ReadProblem::NotANumber { .. }) => continue,
                Err(problem) => return Err(problem),
            };
            let bits = |row: usize| values.get(row).map(|v| v.to_bits());
            for (same, &row) in same.iter_mut().zip(rows) {
                *same &= row > 0 && bits(row) == bits(row - 1);
            }
        }
        Ok(same)
    }
}

/// What had to be assumed or left out to read a file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// Its first row holds numbers and is data: the columns have no names.
    NoNames {
        /// Its columns, which are called `column 1` and so on.
        columns: usize,
    },
    /// Lines above the names of a text, which were passed over.
    Titles {
        /// The lines.
        lines: Vec<String>,
    },
    /// Its last row has no line end; it was taken as a row.
    NoLineEnd,
    /// Rows that the program left out because nothing changed; the values were held.
    Held {
        /// Rows.
        rows: usize,
    },
    /// A column whose mapping states no unit; it was read in that which the file states.
    UnitOfFile {
        /// The column.
        column: String,
        /// Its unit.
        unit: String,
    },
    /// A column that its mapping reads in another unit than that which the file states.
    OtherUnit(OtherUnit),
    /// A column that the mapping names and the file has not.
    NoColumn {
        /// The column.
        column: String,
        /// Those that there are.
        there: Vec<String>,
    },
    /// Rows that were there twice, the same in every column; taken once.
    Repeated {
        /// Rows that were dropped.
        rows: usize,
        /// Time of the first, s.
        first: f64,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoNames { columns } => write!(
                f,
                "its first row holds numbers, so it is data and there are no names; the columns are called \"column 1\" to \"column {columns}\""
            ),
            Self::Titles { lines } => write!(
                f,
                "{} passed over, as the names for its rows stand below: {}",
                match lines.len() {
                    1 => "its first line was".to_owned(),
                    many => format!("its first {many} lines were"),
                },
                clip(&lines.join(" | "))
            ),
            Self::NoLineEnd => write!(
                f,
                "its last row has no line end; it was taken as it stands, and if the file was cut there, its last number may be too"
            ),
            Self::Held { rows } => write!(
                f,
                "{rows} rows that the control left out because nothing changed; the last values are held there"
            ),
            Self::UnitOfFile { column, unit } => write!(
                f,
                "column \"{column}\" is read in {unit}, the unit that the file states, as its mapping states none (unit or factor)"
            ),
            Self::OtherUnit(other) => {
                let [stated, taken] = other.scales;
                let of_channel = unit_of(&other.channel).unwrap_or_default();
                let (column, unit) = (&other.column, &other.unit);
                write!(
                    f,
                    "column \"{column}\": the file states {unit} ({stated} {of_channel}), and its mapping takes 1 of it for {taken} {of_channel}; it is read as the mapping says"
                )
            }
            Self::NoColumn { column, there } => write!(
                f,
                "the mapping names a column \"{column}\" (source), which is not there; the file has: {}",
                there.join(", ")
            ),
            Self::Repeated { rows, first } => write!(
                f,
                "{rows} row(s) occur twice, the first at t = {first:.4} s; each is read once"
            ),
        }
    }
}

/// A column that a mapping reads in another unit than that which the file states.
#[derive(Debug, Clone, PartialEq)]
pub struct OtherUnit {
    /// The column.
    pub column: String,
    /// The channel that it becomes.
    pub channel: String,
    /// The unit that the file states.
    pub unit: String,
    /// Units of the channel for one of the file's numbers: as the file says, and as the mapping does.
    pub scales: [f64; 2],
}

impl Table for Box<dyn Table + '_> {
    fn heads(&self) -> &[Head] {
        (**self).heads()
    }

    fn unreadable(&self) -> usize {
        (**self).unreadable()
    }

    fn looks_like(&self) -> String {
        (**self).looks_like()
    }

    fn notes(&self) -> Vec<Note> {
        (**self).notes()
    }

    fn read(&mut self, wanted: &[usize], holes: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        (**self).read(wanted, holes)
    }

    fn place(&self, row: usize, column: usize) -> Place {
        (**self).place(row, column)
    }

    fn repeats(&mut self, rows: &[usize]) -> Result<Vec<bool>, ReadProblem> {
        (**self).repeats(rows)
    }
}

/// What is done about values that are missing.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Holes {
    /// The file is refused.
    Refused,
    /// They are NaN.
    Kept,
}

/// A column.
pub(crate) struct Head {
    pub name: String,
    pub fault: Option<Fault>,
    /// What the program itself calls what it recorded, where the name is one that a user gave.
    pub address: Option<String>,
    /// The unit, where the file has it beside the name.
    pub unit: Option<String>,
    /// The unit of the numbers, where the column's type says what they are: a time stamp's.
    pub stored: Option<&'static str>,
}

impl Head {
    /// A column of that name, and no more.
    pub(crate) fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            fault: None,
            address: None,
            unit: None,
            stored: None,
        }
    }
}

/// Why a column cannot be read: what it is, and what could be.
#[derive(Clone)]
pub(crate) struct Fault {
    pub found: String,
    pub valid: &'static str,
}

/// The memory that reading a file may take in which a few bytes can stand for any number of
/// rows: compressed, run-length coded, or without what has not changed.
pub(crate) struct Budget {
    file: usize,
    kept: u64,
    aside: u64,
}

impl Budget {
    pub(crate) fn of(file: usize) -> Self {
        let (kept, aside) = (0, 0);
        Self { file, kept, aside }
    }

    /// Numbers that are kept.
    pub(crate) fn keep(&mut self, numbers: u64) {
        self.kept = self.kept.saturating_add(numbers.saturating_mul(8));
    }

    /// Bytes that are needed for a while; only the most at once count.
    #[cfg(any(feature = "mat", feature = "parquet"))]
    pub(crate) fn aside(&mut self, bytes: u64) {
        self.aside = self.aside.max(bytes);
    }

    /// How many numbers may be kept at most.
    pub(crate) fn numbers(&self) -> usize {
        usize::try_from(self.most() / 8).unwrap_or(usize::MAX)
    }

    fn most(&self) -> u64 {
        9 * self.file as u64 + (64 << 20)
    }

    /// Refuses more than nine times the file and 64 MB: what numbers of one byte each
    /// take when read, and what a silent log may that compresses well.
    pub(crate) fn check(&self) -> Result<(), ReadProblem> {
        let needed = self.kept.saturating_add(self.aside);
        let most = self.most();
        if needed <= most {
            return Ok(());
        }
        Err(ReadProblem::TooLarge {
            needed,
            most,
            file: self.file,
        })
    }
}
