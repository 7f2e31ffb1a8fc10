//! `compensate`: Tables 15 and 16.

use miette::{IntoDiagnostic, Result};
use pipeline::compensation::{self, CompensatedRun};
use pipeline::strategies::Strategy;

use super::{identify, train, validate};
use crate::context::{Common, Context};
use crate::output::say;
use crate::progress::bar;
use crate::store::Stage;

const COMPENSATION: &str = "compensation.json";

/// Runs the command.
pub fn command(common: &Common) -> Result<()> {
    let context = common.open()?;
    let _claim = context.claim()?;
    run(&context)
}

/// The stage, for this context.
pub fn stage(context: &Context) -> Stage<'_> {
    let after = [&train::stage(context), &identify::stage(context)];
    Stage::new(
        context,
        "compensate",
        &[COMPENSATION],
        &context.machine.fingerprint,
        &after,
    )
}

/// Runs the stage.
pub fn run(context: &Context) -> Result<()> {
    let stage = stage(context);
    let predictors = validate::predictors(context)?;
    stage.begin()?;
    let progress = bar("compensate", compensation::runs(&context.axis) as u64);
    let runs = compensation::compensate(&context.axis, &context.machine, &predictors, || {
        progress.inc(1);
    })
    .into_diagnostic()?;
    progress.finish_and_clear();
    stage.write_json(COMPENSATION, &runs)?;
    stage.finish()?;
    say("compensate: tracking error of the machine (simulated), max / mean in µm")?;
    for strategy in Strategy::COMPENSATED {
        say(format!("  {}", strategy.label()))?;
        for run in runs.iter().filter(|run| run.strategy == strategy) {
            let f = run.run.figures;
            say(format!("  {:>10} {:>8.3} / {:.4}", run.id, f.max, f.mean))?;
        }
    }
    Ok(())
}

/// The results of a finished stage.
pub fn load(context: &Context) -> Result<Vec<CompensatedRun>> {
    stage(context).read_json(COMPENSATION)
}
