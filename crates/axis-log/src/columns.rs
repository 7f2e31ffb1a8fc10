//! What is in a file before anything is known of it.

use std::path::Path;

use crate::by_extension::whole;
use crate::read::open;
use crate::read_error::{ReadError, ReadProblem};
use crate::table::Holes;

/// A column of numbers as the file has it.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnSummary {
    /// Its name in the file.
    pub name: String,
    /// Its unit, where the file has one beside the name.
    pub unit: Option<String>,
    /// How many numbers it has; fields that are empty or not a number are none.
    pub numbers: usize,
    /// The least of them.
    pub least: f64,
    /// The greatest.
    pub greatest: f64,
    /// Their mean.
    pub mean: f64,
}

/// What a file is, as far as it can be told without a mapping.
#[derive(Debug, Clone, PartialEq)]
pub struct FileSummary {
    /// What it is written as, in a few words: `text, semicolons between fields`.
    pub looks_like: String,
    /// Its rows; of columns of different lengths the most.
    pub rows: usize,
    /// How many columns it has, with those that hold no numbers.
    pub all_columns: usize,
    /// The columns that hold numbers.
    pub columns: Vec<ColumnSummary>,
}

/// What a file of any format that [`read_log`](crate::read_log) reads holds, without a
/// mapping.
///
/// # Errors
/// A [`ReadError`]: the file cannot be read, is of no known format, or damaged.
pub fn columns(path: impl AsRef<Path>) -> Result<FileSummary, ReadError> {
    let path = path.as_ref();
    all(path).map_err(|problem| ReadError {
        file: path.display().to_string(),
        problem,
    })
}

fn all(path: &Path) -> Result<FileSummary, ReadProblem> {
    let bytes = whole(path)?;
    let mut table = open(path, &bytes)?;
    let (mut found, mut rows) = (Vec::new(), 0);
    for column in 0..table.heads().len() {
        if table.heads()[column].fault.is_some() {
            continue;
        }
        let values = match table.read(&[column], Holes::Kept) {
            Ok(mut columns) => columns.pop().unwrap_or_default(),
            Err(ReadProblem::NotANumber { .. }) => continue,
            Err(problem) => return Err(problem),
        };
        rows = rows.max(values.len());
        let (mut numbers, mut sum) = (0, 0.0);
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.into_iter().filter(|value| value.is_finite()) {
            numbers += 1;
            sum += value;
            least = value.min(least);
            greatest = value.max(greatest);
        }
        if numbers > 0 {
            let head = &table.heads()[column];
            found.push(ColumnSummary {
                name: head.name.clone(),
                unit: head.unit.clone(),
                numbers,
                least,
                greatest,
                mean: sum / numbers as f64,
            });
        }
    }
    Ok(FileSummary {
        looks_like: table.looks_like(),
        rows,
        all_columns: table.heads().len(),
        columns: found,
    })
}
