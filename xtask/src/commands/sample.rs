//! `sample`: one-cycle samples, to train on and to judge by.

use std::path::PathBuf;

use clap::Args;
use miette::{IntoDiagnostic, Result};
use pipeline::sample_file;
use pipeline::sampling::{SamplePlan, SampleSet, Sampler, SpeedDensity};

use crate::context::{Common, Context};
use crate::output::say;
use crate::progress::bar;
use crate::store::Stage;

/// Samples to train on.
const TRAINING: &str = "training.samples";
/// As many, evenly spread as in the paper: for the linear map beside the network.
const EVEN: &str = "even.samples";
/// Samples that no training sees, evenly spread.
const UNSEEN: &str = "unseen.samples";

/// Options of `sample`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Only write this many samples to --file, evenly spread over the axis
    /// file's ranges; any number works, in bounded memory
    #[arg(long, value_name = "N", requires = "file")]
    count: Option<usize>,
    /// Where to write them
    #[arg(long, value_name = "FILE", requires = "count")]
    file: Option<PathBuf>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let context = options.common.open()?;
    if let (Some(count), Some(file)) = (options.count, &options.file) {
        let plan = SamplePlan {
            count,
            seed: context.seed,
            density: SpeedDensity::Uniform,
        };
        write(&context, &plan, file)?;
        return say(format!("{count} samples in {}", file.display()));
    }
    let _claim = context.claim()?;
    run(&context)
}

/// The stage, for this context.
pub fn stage(context: &Context) -> Stage<'_> {
    let files = &[TRAINING, EVEN, UNSEEN];
    Stage::new(
        context,
        "sample",
        files,
        &format!("{:?}", plans(context)),
        &[],
    )
}

/// Runs the stage.
pub fn run(context: &Context) -> Result<()> {
    let stage = stage(context);
    stage.begin()?;
    let [training, even, unseen] = plans(context);
    write(context, &training, &stage.path(TRAINING))?;
    write(context, &even, &stage.path(EVEN))?;
    write(context, &unseen, &stage.path(UNSEEN))?;
    stage.finish()?;
    say(format!(
        "sample: {} samples to train on, {} unseen",
        training.count, unseen.count
    ))
}

/// The samples of a finished stage: to train on, as many evenly spread, unseen.
pub fn load(context: &Context) -> Result<[SampleSet; 3]> {
    let stage = stage(context);
    let load = |file: &str| -> Result<SampleSet> {
        stage.read(file)?;
        sample_file::read(&stage.path(file), &context.axis.fingerprint).into_diagnostic()
    };
    Ok([load(TRAINING)?, load(EVEN)?, load(UNSEEN)?])
}

fn plans(context: &Context) -> [SamplePlan; 3] {
    let (training, unseen) = if context.quick {
        (2000, 1000)
    } else {
        (5000, 1000)
    };
    [
        SamplePlan {
            count: training,
            seed: context.seed,
            density: SpeedDensity::NearZero { scale: 3e-3 },
        },
        SamplePlan {
            count: training,
            seed: context.seed ^ 0xe7e4_0000_0000_0000,
            density: SpeedDensity::Uniform,
        },
        SamplePlan {
            count: unseen,
            seed: context.seed ^ 0x7e57_0000_0000_0000,
            density: SpeedDensity::Uniform,
        },
    ]
}

fn write(context: &Context, plan: &SamplePlan, file: &std::path::Path) -> Result<()> {
    let sampler = Sampler::new(&context.axis, plan).into_diagnostic()?;
    let progress = bar("samples", plan.count as u64);
    sample_file::write(file, &sampler, &context.axis.fingerprint, |rows| {
        progress.inc(rows as u64);
    })
    .into_diagnostic()?;
    progress.finish_and_clear();
    Ok(())
}
