//! The commands whose work is a job of independent cases: in one process, or a shard of it.

use std::fmt;
use std::path::PathBuf;

use campaign::{IfOther, Job, Shard, run_shard, run_whole};
use clap::{Args, Subcommand};
use miette::{Result, miette};
use serde::Serialize;

use crate::context::Claim;
use crate::output::{Worded, print};
use crate::progress::bar;

/// The jobs of a program: an enum of subcommands, one line a job. Its options say how the
/// job is made of them.
pub trait Jobs: Subcommand {
    /// The options of the job.
    fn options(&self) -> &dyn JobOptions;

    /// Runs the command: a shard where one was asked for, else all.
    fn run(&self) -> Result<()> {
        let options = self.options();
        let job = options.job()?;
        match options.sharding().shard {
            Some(shard) => make(&*job, shard),
            None => {
                let _claim = options.claim()?;
                whole(&*job)
            }
        }
    }
}

/// Options of which a job is made.
pub trait JobOptions {
    /// The job.
    fn job(&self) -> Result<Box<dyn Job>>;

    /// Whether only a shard of it is to be made.
    fn sharding(&self) -> &Sharding;

    /// The right to write its results, where a run's folder takes them.
    fn claim(&self) -> Result<Option<Claim>> {
        Ok(None)
    }
}

/// Which part of a job is made.
#[derive(Args, Clone)]
pub struct Sharding {
    /// Only make shard I of N (from 1) and write it to the folder `shards`, for the command merge
    /// (docs/campaigns.md); an existing one is kept
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
}

/// Makes all of a job in this process.
pub fn whole(job: &dyn Job) -> Result<()> {
    let progress = bar(job.name(), job.cases() as u64);
    run_whole(job, &|cases| progress.inc(cases as u64)).map_err(report)?;
    progress.finish_and_clear();
    Ok(())
}

/// A shard that was made.
#[derive(Serialize)]
struct Made {
    job: &'static str,
    shard: String,
    cases: usize,
    file: PathBuf,
}

/// Makes one shard.
fn make(job: &dyn Job, shard: Shard) -> Result<()> {
    let cases = shard.range(job.cases()).len();
    let progress = bar(job.name(), cases as u64);
    let made = run_shard(job, shard, IfOther::Refuse, &|cases| {
        progress.inc(cases as u64)
    });
    let path = made.map_err(|error| report(error.into()))?;
    progress.finish_and_clear();
    let text = format!(
        "{}, shard {shard}: {cases} cases in {}",
        job.name(),
        path.display()
    );
    let value = Made {
        job: job.name(),
        shard: shard.to_string(),
        cases,
        file: path,
    };
    print(job.name(), &Worded { text, value })
}

/// A failure with its causes, in one message; one that is a report of this program as it was.
pub fn report(failure: campaign::Failure) -> miette::Report {
    let failure = match failure.downcast::<Reported>() {
        Ok(reported) => return reported.0,
        Err(failure) => failure,
    };
    let mut text = failure.to_string();
    let mut next = failure.source();
    while let Some(cause) = next {
        text = format!("{text}: {cause}");
        next = cause.source();
    }
    miette!("{text}")
}

/// A message as the failure of a job.
pub fn failure(report: impl Into<miette::Report>) -> campaign::Failure {
    Box::new(Reported(report.into()))
}

/// A report on its way through a job, so that its exit code is not lost.
#[derive(Debug)]
struct Reported(miette::Report);

impl fmt::Display for Reported {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

impl std::error::Error for Reported {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.source()
    }
}
