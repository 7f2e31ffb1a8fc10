//! Making one shard.

use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use crate::journal::Journal;
use crate::row::{decode, encode};
use crate::shard_file::{self, Label, ShardFile};
use crate::shard_paths::paths;
use crate::{CampaignError, Failure, Job, Merged, Row, Shard, instruction_set, try_lock};

/// Rows of a row group, and bytes after which one ends before that.
const GROUP: (usize, usize) = (1 << 16, 1 << 25);

/// What is to become of what lies there from other inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IfOther {
    /// It stays, and is an error.
    Refuse,
    /// It is made anew.
    Replace,
}

/// Told of cases that are there: some found from an earlier run, others made.
pub type Progress<'a> = &'a (dyn Fn(usize) + Sync);

/// Makes all of a job in this process: its only shard, and the results from it. What other
/// inputs left of that shard is made anew.
///
/// # Errors
/// As [`run_shard`], and where the results cannot be written.
pub fn run_whole(job: &dyn Job, each: Progress<'_>) -> Result<(), Failure> {
    run_shard(job, Shard::WHOLE, IfOther::Replace, each)?;
    job.finish(&Merged::open(job, 1, true)?)?;
    if !job.is_kept() {
        forget_whole(job)?;
    }
    Ok(())
}

/// Removes what [`run_whole`] made beside the results, and the folders that are then empty.
///
/// # Errors
/// A file cannot be removed.
pub fn forget_whole(job: &dyn Job) -> Result<(), CampaignError> {
    for path in paths(job, Shard::WHOLE) {
        match std::fs::remove_file(&path) {
            Err(e) if e.kind() != ErrorKind::NotFound => {
                return Err(CampaignError::io("remove", &path)(e));
            }
            _ => {}
        }
    }
    // Where something else is in them they stay.
    let _ = std::fs::remove_dir(job.folder().join("shards"));
    let _ = std::fs::remove_dir(job.folder());
    Ok(())
}

/// Makes a shard of a job on the threads of the current rayon pool, and answers its
/// file. One that is there, from the same inputs, is left alone; what a killed process
/// made of it is used.
///
/// # Errors
/// [`CampaignError`]: more shards than cases, another process at work on it, a file of
/// other inputs or damaged, a case that cannot be made, a folder that cannot be written to.
pub fn run_shard(
    job: &dyn Job,
    shard: Shard,
    other: IfOther,
    each: Progress<'_>,
) -> Result<PathBuf, CampaignError> {
    let (cases, shards) = (job.cases(), shard.count());
    if shards > cases.max(1) {
        return Err(CampaignError::TooMany { cases, shards });
    }
    let [path, aside, journal] = paths(job, shard);
    let label = Label {
        job: job.name().to_owned(),
        inputs: job.inputs(),
        shard,
        cases,
        processor: instruction_set(),
    };
    let folder = job.folder().join("shards");
    let io = |action| CampaignError::io(action, &journal);
    if is_there(&path, &label, other)? {
        each(shard.range(cases).len());
        // Left by a process that was killed between the two.
        let _ = std::fs::remove_file(&journal);
        return Ok(path);
    }
    std::fs::create_dir_all(&folder).map_err(CampaignError::io("create", &folder))?;
    let lock = try_lock(&journal).map_err(io("lock"))?;
    let file = lock.ok_or_else(|| CampaignError::Taken {
        shard,
        path: journal.clone(),
    })?;
    // Whoever had the lock may have made it meanwhile.
    if !is_there(&path, &label, other)? {
        let replace = other == IfOther::Replace;
        let made = Journal::open(file, &label.inputs.key(), replace);
        let made = made.map_err(|e| io(if has_no_room(&e) { "write" } else { "read" })(e))?;
        let made = made.ok_or_else(|| CampaignError::OtherInputs {
            path: journal.clone(),
            difference: "what a killed process made of it has another key".to_owned(),
        })?;
        let work = Work {
            job,
            label: &label,
            journal: Mutex::new(made),
            path: &journal,
        };
        work.make([&path, &aside], each)?;
    }
    std::fs::remove_file(&journal).map_err(io("remove"))?;
    Ok(path)
}

/// Whether an error is one of writing alone.
fn has_no_room(error: &std::io::Error) -> bool {
    use ErrorKind::{FileTooLarge, QuotaExceeded, ReadOnlyFilesystem, StorageFull};
    matches!(
        error.kind(),
        FileTooLarge | QuotaExceeded | ReadOnlyFilesystem | StorageFull
    )
}

/// Whether the shard is there, from the same inputs.
fn is_there(path: &Path, label: &Label, other: IfOther) -> Result<bool, CampaignError> {
    let found = match ShardFile::open_checked(path) {
        Err(_) if other == IfOther::Replace => return Ok(false),
        found => found?,
    };
    let Some(found) = found.map(|found| found.label) else {
        return Ok(false);
    };
    let same = found.inputs == label.inputs && found.cases == label.cases;
    if same || other == IfOther::Replace {
        return Ok(same);
    }
    Err(CampaignError::OtherInputs {
        path: path.to_owned(),
        difference: label.inputs.difference(&found.inputs),
    })
}

/// A shard at work.
struct Work<'a> {
    job: &'a dyn Job,
    label: &'a Label,
    journal: Mutex<Journal>,
    path: &'a Path,
}

impl Work<'_> {
    fn make(&self, files: [&Path; 2], each: Progress<'_>) -> Result<(), CampaignError> {
        let all = self.blocks();
        let has = |block: &usize| self.locked(|journal| journal.has(*block));
        let (found, missing): (Vec<usize>, Vec<usize>) = (0..all).partition(has);
        each(found.iter().map(|&block| self.cases(block).len()).sum());
        let missing_cases: Vec<Range<usize>> = missing.iter().map(|&b| self.cases(b)).collect();
        self.prepare(&missing_cases)?;
        // One after another, not divided beforehand, so that what is there after a stop are
        // the first ones, and no thread is left with the long ones.
        let next = AtomicUsize::new(0);
        (0..rayon::current_num_threads())
            .into_par_iter()
            .try_for_each(|_| {
                while let Some(&block) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
                    self.block(block)?;
                    each(self.cases(block).len());
                }
                Ok(())
            })?;
        let mut blocks = 0..all;
        shard_file::write(files, self.label, self.job.columns(), || {
            self.group(&mut blocks)
        })
    }

    fn prepare(&self, missing: &[Range<usize>]) -> Result<(), CampaignError> {
        let [Some(first), Some(last)] = [missing.first(), missing.last()] else {
            return Ok(());
        };
        let (first, last) = (first.start, last.end - 1);
        let prepared = self.job.prepare(missing);
        prepared.map_err(|source| CampaignError::Case {
            first,
            last,
            source,
        })
    }

    fn blocks(&self) -> usize {
        let cases = self.label.shard.range(self.label.cases);
        cases.len().div_ceil(self.job.block().max(1))
    }

    /// The cases of a block.
    fn cases(&self, block: usize) -> Range<usize> {
        let cases = self.label.shard.range(self.label.cases);
        let length = self.job.block().max(1);
        let start = cases.start + block * length;
        start..(start + length).min(cases.end)
    }

    fn block(&self, block: usize) -> Result<(), CampaignError> {
        let cases = self.cases(block);
        let (first, last) = (cases.start, cases.end.saturating_sub(1));
        let rows = self.job.rows(cases.clone());
        let rows = rows.map_err(|source| CampaignError::Case {
            first,
            last,
            source,
        })?;
        let columns = self.job.columns();
        let fits = |row: &Row| {
            row.iter()
                .map(crate::Value::kind)
                .eq(columns.iter().map(|c| c.kind))
        };
        if rows.len() != cases.len() || !rows.iter().all(fits) {
            return Err(CampaignError::Shape { first, last });
        }
        let bytes = encode(&rows);
        let put = self.locked(|journal| journal.put(block, &bytes));
        put.map_err(CampaignError::io("write", self.path))
    }

    /// The rows of the next row group.
    fn group(&self, blocks: &mut Range<usize>) -> Result<Option<Vec<Row>>, CampaignError> {
        let (mut rows, mut bytes) = (Vec::new(), 0);
        while rows.len() < GROUP.0 && bytes < GROUP.1 {
            let Some(block) = blocks.next() else { break };
            let found = self.locked(|journal| journal.block(block));
            let found = found.map_err(CampaignError::io("read", self.path))?;
            let strange = || CampaignError::refused(self.path, "its rows cannot be read");
            bytes += found.len();
            rows.extend(decode(self.job.columns(), &found).ok_or_else(strange)?);
        }
        Ok((!rows.is_empty()).then_some(rows))
    }

    fn locked<T>(&self, act: impl FnOnce(&mut Journal) -> T) -> T {
        let mut journal = self.journal.lock().unwrap_or_else(PoisonError::into_inner);
        act(&mut journal)
    }
}
