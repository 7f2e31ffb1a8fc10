//! All shards of a job, checked, as one.

use std::ops::Range;
use std::path::PathBuf;

use crate::run::paths;
use crate::shard_file::ShardFile;
use crate::{CampaignError, Job, Row, Shard};

/// The rows of a job, read from the files of its shards as they are asked for.
pub struct Merged {
    cases: usize,
    columns: usize,
    /// The files, and the cases of each.
    files: Vec<(PathBuf, Range<usize>)>,
}

impl Merged {
    /// Checks that all shards of a job are there, whole, from the job's inputs, with each
    /// case once; and, unless `any_processor`, from processors of one instruction set.
    ///
    /// # Errors
    /// [`CampaignError`], which says which shards are missing or what is wrong with one.
    pub fn open(job: &dyn Job, shards: usize, any_processor: bool) -> Result<Self, CampaignError> {
        let (inputs, cases) = (job.inputs(), job.cases());
        if shards > cases.max(1) {
            return Err(CampaignError::TooMany { cases, shards });
        }
        let mut missing = Vec::new();
        let mut files = Vec::new();
        let mut first: Option<(Shard, String)> = None;
        for shard in Shard::all(shards) {
            let [path, ..] = paths(job, shard);
            let Some(file) = ShardFile::open_checked(&path)? else {
                missing.push(shard);
                continue;
            };
            let label = &file.label;
            if label.inputs != inputs {
                let difference = inputs.difference(&label.inputs);
                return Err(CampaignError::OtherInputs { path, difference });
            }
            if label.job != job.name() || label.shard != shard || label.cases != cases {
                let what = format!("it is shard {} of {}", label.shard, label.job);
                return Err(CampaignError::refused(&path, what));
            }
            let range = shard.range(cases);
            file.check(job.columns(), range.clone())?;
            let (first_shard, processor) = &*first.get_or_insert((shard, label.processor.clone()));
            if *processor != label.processor && !any_processor {
                return Err(CampaignError::MixedProcessors {
                    first_shard: *first_shard,
                    first: processor.clone(),
                    other_shard: shard,
                    other: label.processor.clone(),
                });
            }
            files.push((path, range));
        }
        if !missing.is_empty() {
            return Err(CampaignError::Missing {
                shards: missing,
                count: shards,
                folder: job.folder().join("shards"),
            });
        }
        Ok(Self {
            cases,
            columns: job.columns().len(),
            files,
        })
    }

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
