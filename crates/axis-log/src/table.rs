//! What the file formats have in common: named columns of numbers.

use crate::read_error::{Place, ReadProblem};

/// A file that has been opened: its columns are known, its numbers not yet read.
pub(crate) trait Table {
    /// All columns in the order of the file.
    fn heads(&self) -> &[Head];

    /// Parts of the file that are not among the heads.
    fn unreadable(&self) -> usize {
        0
    }

    /// The numbers of these columns (indices into the heads, none of which has
    /// a fault). NaN passes through; what is not a number at all does not.
    fn read(&mut self, wanted: &[usize]) -> Result<Vec<Vec<f64>>, ReadProblem>;

    /// Where the sample `row` of a column stands, both from 0.
    fn place(&self, row: usize, column: usize) -> Place;

    fn names(&self) -> Vec<String> {
        self.heads().iter().map(|h| h.name.clone()).collect()
    }
}

/// A column.
pub(crate) struct Head {
    pub name: String,
    pub fault: Option<Fault>,
}

/// Why a column cannot be read: what it is, and what could be.
#[derive(Clone)]
pub(crate) struct Fault {
    pub found: String,
    pub valid: &'static str,
}
