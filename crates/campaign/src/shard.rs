//! Which cases a shard has, and what its file is called.

use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Shard i of n, i from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Shard {
    index: usize,
    count: usize,
}

/// A text that names no shard.
#[derive(Debug, Error)]
#[error("\"{text}\" is no shard; write i/n with i from 1 to n, like 3/100")]
pub struct BadShard {
    text: String,
}

impl Shard {
    /// All cases in one.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// Shard `index`, from 1, of `count`; `None` if there is no such shard.
    pub fn new(index: usize, count: usize) -> Option<Self> {
        (1..=count)
            .contains(&index)
            .then_some(Self { index, count })
    }

    /// All shards of a number of them.
    pub fn all(count: usize) -> impl Iterator<Item = Self> {
        (1..=count).map(move |index| Self { index, count })
    }

    /// Its cases, of `cases` in all: neighbours, and as many as any other has or one more.
    pub fn range(self, cases: usize) -> Range<usize> {
        let edge = |i: usize| (i as u128 * cases as u128 / self.count as u128) as usize;
        edge(self.index - 1)..edge(self.index)
    }

    /// Number of shards.
    pub fn count(self) -> usize {
        self.count
    }

    /// What lies in the folder `shards` of it: its file, the file before it is whole, and
    /// the journal.
    pub(crate) fn files(self, job: &str) -> [String; 3] {
        let stem = format!("{job}-{}-of-{}", self.index, self.count);
        ["parquet", "part", "journal"].map(|kind| format!("{stem}.{kind}"))
    }

    /// The shard of a file's name, where it is one of this job.
    fn of_file(job: &str, file: &str) -> Option<Self> {
        let stem = file.strip_suffix(".parquet")?;
        let (index, count) = stem
            .strip_prefix(job)?
            .strip_prefix('-')?
            .split_once("-of-")?;
        Self::new(index.parse().ok()?, count.parse().ok()?)
    }
}

/// Into how many shards the files of a job in a folder say that it was divided: each
/// number that comes up, in rising order.
pub fn shards_in(folder: &Path, job: &str) -> Vec<usize> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let shards = entries.filter_map(|e| Shard::of_file(job, e.file_name().to_str()?));
    let mut counts: Vec<usize> = shards.map(Shard::count).collect();
    counts.sort_unstable();
    counts.dedup();
    counts
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = BadShard;

    fn from_str(text: &str) -> Result<Self, BadShard> {
        let parse = || {
            let (index, count) = text.split_once('/')?;
            Self::new(index.parse().ok()?, count.parse().ok()?)
        };
        parse().ok_or_else(|| BadShard {
            text: text.to_owned(),
        })
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

impl TryFrom<String> for Shard {
    type Error = BadShard;

    fn try_from(text: String) -> Result<Self, BadShard> {
        text.parse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_is_in_one_shard_and_shards_differ_by_one_at_most() {
        for (cases, count) in [(10, 3), (3, 7), (1_000_003, 1000), (0, 1), (5, 5)] {
            let mut next = 0;
            for shard in Shard::all(count) {
                let range = shard.range(cases);
                assert_eq!(range.start, next);
                assert!(range.len().abs_diff(cases / count) <= 1);
                next = range.end;
            }
            assert_eq!(next, cases);
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        assert_eq!("3/100".parse::<Shard>().unwrap().to_string(), "3/100");
        for text in ["0/3", "4/3", "3", "a/3", "1/0", "-1/3", "1/3/4", ""] {
            let error = text.parse::<Shard>().unwrap_err().to_string();
            assert!(error.contains("like 3/100"), "{error}");
        }
    }
}
