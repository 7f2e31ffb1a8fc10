//! Text as a table: CSV, and what else programs write with a row per instant.

use csv::{Position, StringRecord};

use crate::csv_text::Text;
use crate::error::CsvProblem;
use crate::read_error::{Place, ReadProblem};
use crate::source_unit::is_unit;
use crate::table::{Head, Holes, Table};
use crate::text_dialect::Dialect;

pub(crate) struct CsvTable<'a> {
    dialect: Dialect<'a>,
    heads: Vec<Head>,
    /// Lines before the numbers: names, and units where they have a line of their own.
    above: usize,
}

impl<'a> CsvTable<'a> {
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Self, ReadProblem> {
        let dialect = Dialect::of(bytes)?;
        let text = dialect.text();
        let (mut rows, mut record) = (text.parser(), StringRecord::new());
        if !read_record(&mut rows, &mut record)? {
            return Err(CsvProblem::NoHeader.into());
        }
        text.check_width(&record)?;
        let mut heads: Vec<Head> = record.iter().map(Head::new).collect();
        let mut above = 1;
        if read_record(&mut rows, &mut record)? && are_units(&record, heads.len()) {
            above = 2;
            for (head, unit) in heads.iter_mut().zip(&record) {
                head.unit = Some(bare(unit).to_owned()).filter(|unit| !unit.is_empty());
            }
        }
        Ok(Self {
            dialect,
            heads,
            above,
        })
    }

    /// The first column under another name.
    pub(crate) fn with_first_named(mut self, name: &str) -> Self {
        if let Some(first) = self.heads.first_mut() {
            first.name = name.to_owned();
        }
        self
    }

    fn text(&self) -> Text<'_> {
        self.dialect.text()
    }

    /// A field's number; `mark` is the decimal mark of the column, once one was met.
    fn number(
        &self,
        [row, column]: [usize; 2],
        text: &str,
        holes: Holes,
        mark: &mut Option<u8>,
    ) -> Result<f64, ReadProblem> {
        let at = || (self.place(row, column), self.heads[column].name.clone());
        if holes == Holes::Kept && HOLES.contains(&text) {
            return Ok(f64::NAN);
        }
        if text.is_empty() {
            let (place, name) = at();
            return Err(ReadProblem::MissingValue { place, name });
        }
        let number = match self.dialect.allows_decimal_comma() {
            true => with_mark(text, mark),
            false => text.parse().ok(),
        };
        number.ok_or_else(|| {
            let (place, name) = at();
            let text = text.to_owned();
            ReadProblem::NotANumber { place, name, text }
        })
    }
}

/// How files write that there is no value; `NaN` reads as a number.
const HOLES: [&str; 6] = ["", "NA", "N/A", "null", "NULL", "-"];

/// A number with one decimal mark, point or comma, the same in all of a column: where both
/// occur, one of them groups thousands.
fn with_mark(text: &str, mark: &mut Option<u8>) -> Option<f64> {
    let Some(found) = text.bytes().find(|b| matches!(b, b'.' | b',')) else {
        return text.parse().ok();
    };
    if *mark.get_or_insert(found) != found {
        return None;
    }
    match found {
        b',' if text.contains('.') => None,
        b',' => text.replacen(',', ".", 1).parse().ok(),
        _ => text.parse().ok(),
    }
}

/// Whether a row has units for names of that number: one that is known, and no number.
fn are_units(row: &StringRecord, names: usize) -> bool {
    let is_number = |field: &str| field.replace(',', ".").parse::<f64>().is_ok();
    row.len() == names && row.iter().any(|f| is_unit(bare(f))) && !row.iter().any(is_number)
}

/// A unit without its brackets; none where it says that there is none.
fn bare(unit: &str) -> &str {
    unit.trim_matches(['[', ']', '(', ')', '-', ' '])
}

impl Table for CsvTable<'_> {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn read(&mut self, wanted: &[usize], holes: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let text = self.text();
        let most = text.most_rows(self.heads.len());
        let mut columns: Vec<Vec<f64>> = wanted.iter().map(|_| Vec::with_capacity(most)).collect();
        let mut marks = vec![None; wanted.len()];
        let (mut rows, mut record) = (text.parser(), StringRecord::new());
        for _ in 0..self.above {
            read_record(&mut rows, &mut record)?;
        }
        let mut row = 0;
        while read_record(&mut rows, &mut record)? {
            // A separator behind the last field of each row but the names.
            let ends_empty =
                record.len() == self.heads.len() + 1 && record.get(self.heads.len()) == Some("");
            if record.len() != self.heads.len() && !ends_empty {
                return Err(ReadProblem::Csv(CsvProblem::Ragged {
                    line: text.line_of(&record),
                    found: record.len(),
                    expected: self.heads.len(),
                }));
            }
            for ((column, mark), &index) in columns.iter_mut().zip(&mut marks).zip(wanted) {
                column.push(self.number([row, index], &record[index], holes, mark)?);
            }
            row += 1;
        }
        text.check_end()?;
        Ok(columns)
    }

    /// Only errors ask for it, so it looks for the row anew.
    fn place(&self, row: usize, column: usize) -> Place {
        let text = self.text();
        let mut rows = text.parser().into_records();
        let found = rows.nth(row + self.above).and_then(Result::ok);
        let offset = found.and_then(|r| r.position().map(Position::byte));
        Place::Line {
            line: text.line_at(offset.unwrap_or(0)),
            column: column + 1,
        }
    }
}

fn read_record(
    rows: &mut csv::Reader<&[u8]>,
    record: &mut StringRecord,
) -> Result<bool, ReadProblem> {
    rows.read_record(record)
        .map_err(|e| ReadProblem::Csv(CsvProblem::Csv(e)))
}
