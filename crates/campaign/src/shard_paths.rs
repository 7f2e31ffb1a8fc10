//! Where the files of a shard lie.

use std::path::PathBuf;

use crate::{Job, Shard};

/// The files of a shard: itself, before it is whole, its journal.
pub(crate) fn paths(job: &dyn Job, shard: Shard) -> [PathBuf; 3] {
    let files = shard.files(job.name());
    files.map(|file| job.folder().join("shards").join(file))
}
