//! What is done in shards.

use std::ops::Range;
use std::path::Path;

use crate::{Column, Failure, Inputs, Merged, Row};

/// Many independent cases, and what is made of their rows.
pub trait Job: Sync {
    /// Name, which file names begin with.
    fn name(&self) -> &'static str;

    /// Everything that the rows depend on.
    fn inputs(&self) -> Inputs;

    /// Folder that holds the folder `shards`.
    fn folder(&self) -> &Path;

    /// Columns of a row.
    fn columns(&self) -> &'static [Column];

    /// Number of cases.
    fn cases(&self) -> usize;

    /// Cases that are made at a time. What a killed shard loses is at most this many on each
    /// thread: 1 for cases of seconds, more where keeping one costs as much as making it.
    fn block(&self) -> usize {
        1
    }

    /// Makes what cases share, before any of these is made; called from one thread. What is
    /// made in [`Job::rows`] by the first who needs it could be asked for by a thread that is
    /// making it, where that thread helps others meanwhile.
    ///
    /// # Errors
    /// Where it cannot be made.
    fn prepare(&self, cases: &[Range<usize>]) -> Result<(), Failure> {
        let _ = cases;
        Ok(())
    }

    /// Makes the rows of some cases, in their order. It may depend on the inputs and the
    /// numbers of the cases alone.
    ///
    /// # Errors
    /// Where a case cannot be made.
    fn rows(&self, cases: Range<usize>) -> Result<Vec<Row>, Failure>;

    /// Whether the shard of a single process stays, so that the next run need not make it
    /// again; not where the results are as large and up to date by themselves.
    fn is_kept(&self) -> bool {
        false
    }

    /// Writes the results.
    ///
    /// # Errors
    /// Where a row does not read or a result cannot be written.
    fn finish(&self, rows: &Merged) -> Result<(), Failure>;
}
