//! CSV as a table.

use csv::{Position, StringRecord};

use crate::csv_text::Text;
use crate::error::CsvProblem;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Head, Holes, Table};

pub(crate) struct CsvTable<'a> {
    text: Text<'a>,
    heads: Vec<Head>,
}

impl<'a> CsvTable<'a> {
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Self, ReadProblem> {
        let text = Text::new(bytes)?;
        let mut record = StringRecord::new();
        if !read_record(&mut text.parser(), &mut record)? {
            return Err(CsvProblem::NoHeader.into());
        }
        text.check_width(&record)?;
        Ok(Self {
            text,
            heads: record.iter().map(Head::new).collect(),
        })
    }

    /// The first column under another name.
    pub(crate) fn with_first_named(mut self, name: &str) -> Self {
        if let Some(first) = self.heads.first_mut() {
            first.name = name.to_owned();
        }
        self
    }

    fn number(
        &self,
        row: usize,
        column: usize,
        text: &str,
        holes: Holes,
    ) -> Result<f64, ReadProblem> {
        let at = || (self.place(row, column), self.heads[column].name.clone());
        if holes == Holes::Kept && HOLES.contains(&text) {
            return Ok(f64::NAN);
        }
        if text.is_empty() {
            let (place, name) = at();
            return Err(ReadProblem::MissingValue { place, name });
        }
        text.parse().map_err(|_| {
            let (place, name) = at();
            let text = text.to_owned();
            ReadProblem::NotANumber { place, name, text }
        })
    }
}

/// How files write that there is no value; `NaN` reads as a number.
const HOLES: [&str; 6] = ["", "NA", "N/A", "null", "NULL", "-"];

impl Table for CsvTable<'_> {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn read(&mut self, wanted: &[usize], holes: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let most = self.text.most_rows(self.heads.len());
        let mut columns: Vec<Vec<f64>> = wanted.iter().map(|_| Vec::with_capacity(most)).collect();
        let (mut rows, mut record) = (self.text.parser(), StringRecord::new());
        read_record(&mut rows, &mut record)?; // the header
        let mut row = 0;
        while read_record(&mut rows, &mut record)? {
            if record.len() != self.heads.len() {
                return Err(ReadProblem::Csv(CsvProblem::Ragged {
                    line: self.text.line_of(&record),
                    found: record.len(),
                    expected: self.heads.len(),
                }));
            }
            for (column, &index) in columns.iter_mut().zip(wanted) {
                column.push(self.number(row, index, &record[index], holes)?);
            }
            row += 1;
        }
        self.text.check_end()?;
        Ok(columns)
    }

    /// Only errors ask for it, so it looks for the row anew.
    fn place(&self, row: usize, column: usize) -> Place {
        let mut rows = self.text.parser().into_records();
        let found = rows.nth(row + 1).and_then(Result::ok); // behind the header
        let offset = found.and_then(|r| r.position().map(Position::byte));
        Place::Line {
            line: self.text.line_at(offset.unwrap_or(0)),
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
