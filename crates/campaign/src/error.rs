//! Why a shard or a merging did not come to its end.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::Shard;

/// Why a job could not do its part.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Why a shard or a merging did not come to its end.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CampaignError {
    /// The system refused.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// More shards than cases.
    #[error("there are {cases} cases: at most as many shards, not {shards}")]
    TooMany {
        /// Number of cases.
        cases: usize,
        /// Number of shards.
        shards: usize,
    },
    /// Another process makes the same shard.
    #[error("another process is at work on shard {shard} ({} is locked); wait for its end", path.display())]
    Taken {
        /// The shard.
        shard: Shard,
        /// The file that is locked.
        path: PathBuf,
    },
    /// What lies there was made from something else.
    #[error(
        "{} was made from other inputs: {difference}; remove it, or give another folder with --out",
        path.display()
    )]
    OtherInputs {
        /// The file.
        path: PathBuf,
        /// What differs.
        difference: String,
    },
    /// A file that is not what this crate wrote.
    #[error("{} is refused: {what}; remove it and make the shard again", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// Shards that were not made.
    #[error("{} of {count} shards are missing in {}: {}; make them with --shard, like --shard {}",
        shards.len(), folder.display(), listed(shards), shards[0])]
    Missing {
        /// Those that are missing; at least one.
        shards: Vec<Shard>,
        /// How many there should be.
        count: usize,
        /// Where they are looked for.
        folder: PathBuf,
    },
    /// Shards of processors whose bits may differ.
    #[error(
        "shards come from processors of different instruction sets: {} has \"{first}\", {} has \
         \"{other}\"; the last bits of their results may differ. Make all on nodes of one kind, or \
         take them as they are with --any-cpu",
        Shard::to_string(first_shard),
        Shard::to_string(other_shard)
    )]
    MixedProcessors {
        /// The first shard.
        first_shard: Shard,
        /// Its processor's instruction set.
        first: String,
        /// One of another.
        other_shard: Shard,
        /// Its processor's instruction set.
        other: String,
    },
    /// A case could not be made.
    #[error("cases {first} to {last} cannot be made")]
    Case {
        /// The first case of the block, from 0.
        first: usize,
        /// The last.
        last: usize,
        /// Why.
        source: Failure,
    },
    /// A job made rows that are not as its columns say.
    #[error("cases {first} to {last}: rows do not have the columns of the job")]
    Shape {
        /// The first case of the block, from 0.
        first: usize,
        /// The last.
        last: usize,
    },
}

impl CampaignError {
    pub(crate) fn io(
        action: &'static str,
        path: &Path,
    ) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Io {
            action,
            path,
            source,
        }
    }

    pub(crate) fn refused(path: &Path, what: impl ToString) -> Self {
        Self::Refused {
            path: path.to_owned(),
            what: what.to_string(),
        }
    }
}

/// The first of them by name.
fn listed(shards: &[Shard]) -> String {
    const MOST: usize = 10;
    let first: Vec<String> = shards.iter().take(MOST).map(Shard::to_string).collect();
    let more = match shards.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    first.join(", ") + &more
}
