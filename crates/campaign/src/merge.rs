//! All shards of a job, checked, as one.

use crate::shard_file::ShardFile;
use crate::shard_paths::paths;
use crate::{CampaignError, Job, Merged, Shard};

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
}
