//! `merge`: the results of a job from the shards that other processes have made.

use campaign::{Job, Merged, shards_in};
use clap::Args;
use miette::{Result, miette};

use crate::exit::wrong_use;
use crate::jobs::{Jobs, report};

/// Options of the command.
#[derive(Args)]
pub struct Options<J: Jobs> {
    /// Number of shards [default: as the existing files say]
    #[arg(long, value_name = "N")]
    shards: Option<usize>,
    /// Accept shards from processors of different instruction sets: last bits may differ
    #[arg(long)]
    any_cpu: bool,
    /// The job whose shards are merged, with the options of the command that made them, but for --shard
    #[command(subcommand)]
    job: J,
}

/// Runs the command.
pub fn command<J: Jobs>(options: &Options<J>) -> Result<()> {
    let of_job = options.job.options();
    if let Some(shard) = of_job.sharding().shard {
        return Err(wrong_use(format!(
            "merge takes all shards: leave --shard {shard} out; --shards before the name of the job gives their number"
        )));
    }
    let job = of_job.job()?;
    let shards = match options.shards {
        Some(shards) => shards.max(1),
        None => found(&*job)?,
    };
    let _claim = of_job.claim()?;
    let merged = Merged::open(&*job, shards, options.any_cpu).map_err(|e| report(e.into()))?;
    job.finish(&merged).map_err(report)
}

/// The number of shards that the files say.
fn found(job: &dyn Job) -> Result<usize> {
    let folder = job.folder().join("shards");
    match shards_in(&folder, job.name())[..] {
        [shards] => Ok(shards),
        [] => Err(miette!(
            "there are no shards of {} in {}; make them with `--shard 1/N` to `--shard N/N`",
            job.name(),
            folder.display()
        )),
        ref several => Err(miette!(
            "{} holds shards of several divisions, into {several:?}; say which with --shards N before \
             the name of the job",
            folder.display()
        )),
    }
}
