//! `pipeline`: every stage in its order; those up to date are left alone.

use axis_pipeline::strategies::{Need, Predictors};
use miette::Result;
use serde::Serialize;

use super::{compensate, identify, report, sample, study, train, validate};
use crate::context::{Common, Context};
use crate::output::{Worded, print, print_by_name};
use crate::store::Stage;

/// A stage that was not run.
#[derive(Serialize)]
struct UpToDate {
    up_to_date: bool,
}

type Run = fn(&Context) -> Result<()>;

/// Predictors with what is needed; the stages that they come from are run first if they are not up to date.
///
/// # Errors
/// Those of the stages.
pub fn predictors(context: &Context, needs: &[Need]) -> Result<Predictors> {
    let _claim = context.claim()?;
    let stages: [(Need, Stage<'_>, Run); 3] = [
        (Need::Network, sample::stage(context), sample::run),
        (Need::Network, train::stage(context), train::run),
        (
            Need::IdentifiedFriction,
            identify::stage(context),
            identify::run,
        ),
    ];
    for (need, stage, run) in &stages {
        // Friction and transfer functions come from one stage.
        let is_needed = match need {
            Need::IdentifiedFriction => needs.iter().any(|need| *need != Need::Network),
            need => needs.contains(need),
        };
        if is_needed && !stage.is_current() {
            run(context)?;
        }
    }
    validate::predictors(context, needs)
}

/// Runs the command.
pub fn run(common: &Common) -> Result<()> {
    print_by_name();
    let context = common.open()?;
    let _claim = context.claim()?;
    let stages: [(Stage<'_>, &str, Run); 6] = [
        (sample::stage(&context), "sample", sample::run),
        (train::stage(&context), "train", train::run),
        (identify::stage(&context), "identify", identify::run),
        (validate::stage(&context), "validate", validate::run),
        (compensate::stage(&context), "compensate", compensate::run),
        (study::stage(&context), "study", study::run),
    ];
    for (stage, name, run) in &stages {
        if stage.is_current() {
            let text = format!("{name}: up to date");
            let value = UpToDate { up_to_date: true };
            print(name, &Worded { text, value })?;
        } else {
            run(&context)?;
        }
    }
    report::run(&context)
}
