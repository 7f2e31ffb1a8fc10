//! `validate`: Tables 13 and 14.

use std::fmt;
use std::path::PathBuf;

use axis_pipeline::measured::Errors;
use axis_pipeline::strategies::{Need, Predictors, TransferModels};
use axis_pipeline::validation::{self, Validation};
use axis_pipeline::{ErrorUnit, Figures};
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use super::{identify, train};
use crate::context::{Common, Context};
use crate::output::print;
use crate::progress::bar;
use crate::store::Stage;

pub(super) const VALIDATION: &str = "validation.json";

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
        "validate",
        &[VALIDATION],
        &context.machine.fingerprint,
        &after,
    )
}

/// Runs the stage.
pub fn run(context: &Context) -> Result<()> {
    let stage = stage(context);
    let predictors = predictors(context, &Need::ALL)?;
    stage.begin()?;
    let progress = bar("validate", validation::runs(&context.axis) as u64);
    let found = validation::validate(&context.axis, &context.machine, &predictors, || {
        progress.inc(1);
    })
    .into_diagnostic()?;
    progress.finish_and_clear();
    stage.write_json(VALIDATION, &found)?;
    stage.finish()?;
    let unit = context.unit();
    let rows = found.trajectories.iter().map(|t| Row {
        trajectory: t.id,
        errors: Errors::new(
            unit,
            Pair {
                model: t.model.figures,
                machine: t.machine.figures,
            },
        ),
    });
    let told = Validated {
        unit,
        trajectories: rows.collect(),
        file: stage.path(VALIDATION),
    };
    print("validate", &told)
}

/// Tracking errors of model and machine.
#[derive(Serialize)]
struct Validated {
    #[serde(skip)]
    unit: ErrorUnit,
    trajectories: Vec<Row>,
    file: PathBuf,
}

#[derive(Serialize)]
struct Row {
    trajectory: usize,
    #[serde(flatten)]
    errors: Errors<Pair>,
}

#[derive(Serialize)]
struct Pair {
    model: Figures,
    machine: Figures,
}

impl fmt::Display for Validated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "validate: tracking error, max / mean in {}", self.unit)?;
        writeln!(f, "  trajectory      model          machine (simulated)")?;
        for row in &self.trajectories {
            let Pair {
                model: a,
                machine: b,
            } = &*row.errors;
            writeln!(
                f,
                "  {:>10} {:>8.3} / {:.4} {:>10.3} / {:.4}",
                row.trajectory, a.max, a.mean, b.max, b.mean
            )?;
        }
        Ok(())
    }
}

/// The results of a finished stage.
pub fn load(context: &Context) -> Result<Validation> {
    stage(context).read_json(VALIDATION)
}

/// Predictors with what is needed, from the results of `train` and `identify`.
pub fn predictors(context: &Context, needs: &[Need]) -> Result<Predictors> {
    let mut predictors = Predictors::of(&context.axis);
    for need in needs {
        match need {
            Need::Network => predictors.network = Some(train::load_network(context)?),
            Need::TransferFunctions => {
                let (_, [alone, with_feedforward]) = identify::load_transfer(context)?;
                predictors.transfer = Some(TransferModels {
                    alone,
                    with_feedforward,
                });
            }
            Need::IdentifiedFriction => {
                predictors.identified = Some(identify::load_friction(context)?.1);
            }
        }
    }
    Ok(predictors)
}
