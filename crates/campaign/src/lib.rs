//! Jobs of many independent cases, done in shards by processes that know nothing of each
//! other, and merged.
//!
//! A [`Job`] has cases, numbered from 0; each makes a [`Row`]. [`run_shard`] makes the rows of
//! one shard and writes them as a Parquet file; [`Merged`] checks that the files of all
//! shards belong together and gives their rows back in the order of the cases; the job
//! [finishes](Job::finish) from these. A single process ([`run_whole`]) is shard 1/1 and the
//! same merging, so the number of shards does not change a bit of the results.
//!
//! - **Whole**: a file of a shard is written aside and renamed.
//! - **Resumable**: a shard that is there is left alone; one that was killed goes on behind
//!   the last block that its journal holds.
//! - **Keyed**: what the results depend on ([`Inputs`]) is in every file. Shards of other
//!   inputs are refused, and the message says what differs.
//! - **Streamed**: neither a shard nor the merging holds all rows.
//!
//! A shard is a run of neighbouring cases. So merging reads one file after another, and
//! one row group at a time; interleaved cases would need all files open at once.
//!
//! What it knows nothing of: axes, simulations, what a row means, terminals.
#![forbid(unsafe_code)]

mod column_io;
mod cpu;
mod error;
mod hashed_file;
mod inputs;
mod job;
mod journal;
mod lock;
mod merge;
mod merged;
mod row;
mod run;
mod script;
mod shard;
mod shard_file;
mod shard_paths;

pub use cpu::instruction_set;
pub use error::{CampaignError, Failure};
pub use inputs::Inputs;
pub use job::Job;
pub use lock::try_lock;
pub use merged::Merged;
pub use row::{Column, Kind, Row, Value};
pub use run::{IfOther, Progress, forget_whole, run_shard, run_whole};
pub use script::{Scheduler, Submission};
pub use shard::{BadShard, Shard, shards_in};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
