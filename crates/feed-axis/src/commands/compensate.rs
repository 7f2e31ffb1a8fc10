//! `compensate`: Tables 15 and 16.

use std::fmt;
use std::path::PathBuf;

use axis_pipeline::compensation::{self, CompensatedRun};
use axis_pipeline::measured::Errors;
use axis_pipeline::strategies::{Need, STRATEGIES};
use axis_pipeline::{ErrorUnit, Figures};
use clap::Args;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use super::{compensate_moves, identify, train, validate};
use crate::context::{Common, Context, warn_of_control};
use crate::output::print;
use crate::progress::bar;
use crate::store::Stage;

pub(super) const COMPENSATION: &str = "compensation.json";

/// Options of `compensate`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    moves: compensate_moves::Options,
}

/// Runs the command: the stage, or moves under one strategy.
pub fn command(options: &Options) -> Result<()> {
    let context = options.common.open()?;
    if let Some(strategy) = options.moves.strategy {
        return compensate_moves::run(&context, &options.moves, strategy);
    }
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
    let predictors = validate::predictors(context, &Need::ALL)?;
    stage.begin()?;
    let count = compensation::runs(&context.axis, STRATEGIES);
    let progress = bar("compensate", count as u64);
    let runs = compensation::compensate(&context.axis, &context.machine, &predictors, || {
        progress.inc(1);
    })
    .into_diagnostic()?;
    progress.finish_and_clear();
    stage.write_json(COMPENSATION, &runs)?;
    stage.finish()?;
    let unit = context.unit();
    let run = |run: &CompensatedRun| Run {
        trajectory: run.id,
        strategy: run.strategy.clone(),
        errors: Errors::new(unit, run.run.figures),
    };
    let found = Compensated {
        unit,
        control_differences: context.other_control(),
        runs: runs.iter().map(run).collect(),
        file: stage.path(COMPENSATION),
    };
    print("compensate", &found)
}

/// The machine under every strategy.
#[derive(Serialize)]
struct Compensated {
    #[serde(skip)]
    unit: ErrorUnit,
    /// Keys of the controller that the machine's file has otherwise.
    control_differences: Vec<String>,
    runs: Vec<Run>,
    file: PathBuf,
}

/// One trajectory under one strategy.
#[derive(Serialize)]
struct Run {
    trajectory: usize,
    strategy: String,
    #[serde(flatten)]
    errors: Errors<Figures>,
}

impl fmt::Display for Compensated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "compensate: tracking error of the machine (simulated), max / mean in {}",
            self.unit
        )?;
        warn_of_control(f, &self.control_differences)?;
        for kind in STRATEGIES {
            let mut runs = self.runs.iter().filter(|run| run.strategy == kind.name);
            let Some(first) = runs.next() else {
                writeln!(f, "  {}: left out, this axis cannot have it", kind.label)?;
                continue;
            };
            writeln!(f, "  {}", kind.label)?;
            for run in [first].into_iter().chain(runs) {
                let errors = &*run.errors;
                writeln!(
                    f,
                    "  {:>10} {:>8.3} / {:.4}",
                    run.trajectory, errors.max, errors.mean
                )?;
            }
        }
        Ok(())
    }
}

/// The results of a finished stage.
pub fn load(context: &Context) -> Result<Vec<CompensatedRun>> {
    stage(context).read_json(COMPENSATION)
}

#[cfg(test)]
mod tests {
    use axis_pipeline::strategies::named;

    use super::*;

    /// Results that lie in folders from before carry these names.
    #[test]
    fn results_of_every_strategy_are_read_and_labelled() {
        let labels = [
            ("network", "network"),
            ("network_lugre", "network + LuGre"),
            ("transfer_function", "transfer function"),
            ("transfer_function_lugre", "transfer function + LuGre"),
            ("lugre", "LuGre"),
            (
                "network_lugre_printed",
                "network + LuGre as in the axis file",
            ),
            ("drive_terms", "drive terms"),
            ("plan", "plan"),
            ("feedback", "feedback"),
            ("adaptive", "adaptive"),
            ("adaptive_feedback", "adaptive feedback"),
            ("iterative", "iterative learning"),
            ("learned", "learned"),
        ];
        assert_eq!(labels.len(), STRATEGIES.len());
        for (name, label) in labels {
            let json = format!(
                r#"{{"id":3,"strategy":"{name}","run":{{"figures":{{"max":2.5,"mean":1.0}},"error_um":[0.5]}}}}"#
            );
            let run: CompensatedRun = serde_json::from_str(&json).unwrap();
            let kind = named(STRATEGIES, &run.strategy).unwrap();
            assert_eq!((run.id, kind.label), (3, label));
            assert_eq!(serde_json::to_string(&run).unwrap(), json);
        }
    }
}
