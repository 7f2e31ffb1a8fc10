//! Text as a table: CSV, and what else programs write with a row per instant.

use csv::{Position, StringRecord};

use crate::csv_text::Text;
use crate::error::CsvProblem;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Head, Holes, Note, Table};
use crate::text_dialect::Dialect;
use crate::unit_table::is_unit;

pub(crate) struct CsvTable<'a> {
    dialect: Dialect<'a>,
    heads: Vec<Head>,
    /// Lines before the numbers: names, and units where they have a line of their own.
    above: usize,
}

impl<'a> CsvTable<'a> {
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Self, ReadProblem> {
        Self::of(Dialect::of(bytes)?)
    }

    /// Of a program that always writes semicolons between fields.
    pub(crate) fn with_semicolons(bytes: &'a [u8]) -> Result<Self, ReadProblem> {
        Self::of(Dialect::separated_by(bytes, b';')?)
    }

    fn of(dialect: Dialect<'a>) -> Result<Self, ReadProblem> {
        let text = dialect.text();
        let (mut rows, mut record) = (text.parser(), StringRecord::new());
        if !read_record(&mut rows, &mut record)? {
            return Err(CsvProblem::NoHeader.into());
        }
        text.check_width(&record)?;
        if !dialect.is_named() {
            // A separator may stand behind the last field.
            let ends_empty = record.len() > 1 && record.get(record.len() - 1) == Some("");
            let columns = record.len() - usize::from(ends_empty);
            let name = |k: usize| Head::new(format!("column {}", k + 1));
            return Ok(Self {
                heads: (0..columns).map(name).collect(),
                dialect,
                above: 0,
            });
        }
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

    /// The columns under other names, as many as there are.
    pub(crate) fn with_names(mut self, names: impl IntoIterator<Item = String>) -> Self {
        for (head, name) in self.heads.iter_mut().zip(names) {
            head.name = name;
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

/// A unit without its brackets; none if it says that there is none.
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
        Ok(columns)
    }

    fn looks_like(&self) -> String {
        let fields = self.dialect.separator_in_words();
        let above = match self.dialect.titles().len() {
            0 => String::new(),
            1 => ", one line above the names passed over".to_owned(),
            many => format!(", {many} lines above the names passed over"),
        };
        format!("text, {fields} between fields{above}")
    }

    fn notes(&self) -> Vec<Note> {
        let columns = self.heads.len();
        let nameless = (!self.dialect.is_named()).then_some(Note::NoNames { columns });
        let lines = self.dialect.titles().to_vec();
        let titles = (!lines.is_empty()).then_some(Note::Titles { lines });
        let open = self.text().ends_open().then_some(Note::NoLineEnd);
        nameless.into_iter().chain(titles).chain(open).collect()
    }

    /// By their text, so that columns without numbers count too.
    fn repeats(&mut self, rows: &[usize]) -> Result<Vec<bool>, ReadProblem> {
        let text = self.text();
        let (mut all, mut record) = (text.parser(), StringRecord::new());
        let mut before = StringRecord::new();
        for _ in 0..self.above {
            read_record(&mut all, &mut record)?;
        }
        let (mut same, mut row) = (Vec::with_capacity(rows.len()), 0);
        while same.len() < rows.len() && read_record(&mut all, &mut record)? {
            if row == rows[same.len()] {
                same.push(record == before);
            }
            before.clone_from(&record);
            row += 1;
        }
        Ok(same)
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
