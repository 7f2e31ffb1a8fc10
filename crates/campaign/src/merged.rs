//! The rows of all shards of a job, as one.

use std::ops::Range;
use std::path::PathBuf;

use crate::shard_file::ShardFile;
use crate::{CampaignError, Row};

/// The rows of a job, read from the files of its shards as they are asked for.
pub struct Merged {
    pub(crate) cases: usize,
    pub(crate) columns: usize,
    /// The files, and the cases of each.
    pub(crate) files: Vec<(PathBuf, Range<usize>)>,
}

impl Merged {
    /// Number of cases.
    pub fn cases(&self) -> usize {
        self.cases
    }

    /// All rows, in the order of the cases.
    pub fn rows(&self) -> impl Iterator<Item = Result<Row, CampaignError>> + '_ {
        self.range(0..self.cases)
    }

    /// The rows of some cases, in their order; one row group is in memory at a time.
    pub fn range(
        &self,
        cases: Range<usize>,
    ) -> impl Iterator<Item = Result<Row, CampaignError>> + '_ {
        let touches = |of: &Range<usize>| of.start < cases.end && cases.start < of.end;
        let files: Vec<_> = self.files.iter().filter(|(_, of)| touches(of)).collect();
        files.into_iter().flat_map(move |(path, of)| {
            let part = cases.start.max(of.start) - of.start..cases.end.min(of.end) - of.start;
            Part::new(path, part, self.columns)
        })
    }
}

/// Rows of one file.
struct Part {
    path: PathBuf,
    columns: usize,
    /// Rows that are still wanted, counted from the first of those not yet passed.
    wanted: Range<usize>,
    file: Option<ShardFile>,
    group: usize,
    rows: std::vec::IntoIter<Row>,
}

impl Part {
    fn new(path: &std::path::Path, wanted: Range<usize>, columns: usize) -> Self {
        Self {
            path: path.to_owned(),
            columns,
            wanted,
            file: None,
            group: 0,
            rows: Vec::new().into_iter(),
        }
    }

    /// Reads on, up to a row group that has rows that are wanted.
    fn read_on(&mut self) -> Result<(), CampaignError> {
        if self.file.is_none() {
            self.file = Some(ShardFile::open(&self.path)?);
        }
        let Some(file) = &self.file else {
            return Ok(());
        };
        while self.group < file.groups() {
            let (group, length) = (self.group, file.len(self.group));
            self.group += 1;
            if self.wanted.start < length {
                let mut rows = file.rows(group, self.columns)?.into_iter();
                if self.wanted.start > 0 {
                    rows.nth(self.wanted.start - 1);
                }
                self.wanted = 0..self.wanted.len();
                self.rows = rows;
                return Ok(());
            }
            self.wanted = self.wanted.start - length..self.wanted.end - length;
        }
        Err(CampaignError::refused(&self.path, "it ends too early"))
    }
}

impl Iterator for Part {
    type Item = Result<Row, CampaignError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.wanted.is_empty() {
            return None;
        }
        if self.rows.len() == 0
            && let Err(error) = self.read_on()
        {
            self.wanted = 0..0;
            return Some(Err(error));
        }
        self.wanted.end -= 1;
        self.rows.next().map(Ok)
    }
}
