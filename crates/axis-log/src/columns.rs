//! What is in a file before anything is known of it.

use std::path::Path;

use crate::read::{open, whole};
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

/// The columns of a file of any format that [`read_log`](crate::read_log) reads, without a
/// mapping. What holds no numbers is left out.
///
/// # Errors
/// A [`ReadError`]: the file cannot be read, is of no known format, or damaged.
pub fn columns(path: impl AsRef<Path>) -> Result<Vec<ColumnSummary>, ReadError> {
    let path = path.as_ref();
    all(path).map_err(|problem| ReadError {
        file: path.display().to_string(),
        problem,
    })
}

fn all(path: &Path) -> Result<Vec<ColumnSummary>, ReadProblem> {
    let bytes = whole(path)?;
    let mut table = open(path, &bytes)?;
    let mut found = Vec::new();
    for column in 0..table.heads().len() {
        if table.heads()[column].fault.is_some() {
            continue;
        }
        let values = match table.read(&[column], Holes::Kept) {
            Ok(mut columns) => columns.pop().unwrap_or_default(),
            Err(ReadProblem::NotANumber { .. }) => continue,
            Err(problem) => return Err(problem),
        };
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
    Ok(found)
}
