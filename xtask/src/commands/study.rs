//! `study`: Tables 7 to 10 over several seeds.

use miette::{IntoDiagnostic, Result};
use pipeline::study::{self, StudyRow};

use crate::context::{Common, Context};
use crate::output::say;
use crate::progress::bar;
use crate::store::Stage;

const STUDY: &str = "study.json";

/// Runs the command.
pub fn command(common: &Common) -> Result<()> {
    let context = common.open()?;
    let _claim = context.claim()?;
    run(&context)
}

/// The stage, for this context.
pub fn stage(context: &Context) -> Stage<'_> {
    Stage::new(
        context,
        "study",
        &[STUDY],
        &format!("{:?}", size(context)),
        &[],
    )
}

/// Runs the stage.
pub fn run(context: &Context) -> Result<()> {
    let stage = stage(context);
    stage.begin()?;
    let (samples, seeds) = size(context);
    let settings = study::settings();
    let progress = bar("study", settings.len() as u64 * seeds);
    let rows = study::study(
        &context.axis,
        &settings,
        samples,
        seeds,
        context.seed,
        || {
            progress.inc(1);
        },
    )
    .into_diagnostic()?;
    progress.finish_and_clear();
    stage.write_json(STUDY, &rows)?;
    stage.finish()?;
    say(format!(
        "study: {} settings over {seeds} seeds",
        settings.len()
    ))
}

/// The results of a finished stage.
pub fn load(context: &Context) -> Result<Vec<StudyRow>> {
    stage(context).read_json(STUDY)
}

/// Samples to train on (and as many unseen), and seeds.
fn size(context: &Context) -> (usize, u64) {
    if context.quick { (200, 2) } else { (1000, 11) }
}
