//! Compensated runs on what stands for the machine: Tables 15 and 16.

use axis_sim::{Axis, ClosedLoop};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::PipelineError;
use crate::strategies::{Predictors, STRATEGIES, StrategyKind};
use crate::tracking::{Run, plan_all, track};

/// One trajectory under one strategy.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CompensatedRun {
    /// Number of the trajectory, from 1.
    pub id: usize,
    /// Name of the strategy.
    pub strategy: String,
    /// Its tracking error.
    pub run: Run,
}

/// Runs every trajectory of `model` on `machine` under every strategy of [`STRATEGIES`],
/// in that order. `each` is called once a run; [`runs`] tells how often.
///
/// # Errors
/// [`PipelineError::Missing`] where the predictors lack what a strategy needs,
/// [`PipelineError::Run`] where a run diverges.
pub fn compensate(
    model: &Axis,
    machine: &Axis,
    predictors: &Predictors,
    each: impl Fn() + Sync,
) -> Result<Vec<CompensatedRun>, PipelineError> {
    compensate_with(model, machine, predictors, STRATEGIES, each)
}

/// As [`compensate`], under the given strategies.
///
/// # Errors
/// As [`compensate`]; [`PipelineError::SameName`] where two strategies have one name, by
/// which their results could not be told apart.
pub fn compensate_with(
    model: &Axis,
    machine: &Axis,
    predictors: &Predictors,
    strategies: &[&StrategyKind],
    each: impl Fn() + Sync,
) -> Result<Vec<CompensatedRun>, PipelineError> {
    for (i, kind) in strategies.iter().enumerate() {
        if strategies[..i].iter().any(|other| other.name == kind.name) {
            return Err(PipelineError::SameName(kind.name));
        }
        // Refused before anything is computed.
        kind.compensator(predictors)?;
    }
    let closed_loop = ClosedLoop::new(machine)?;
    let planned = plan_all(model)?;
    let cases: Vec<_> = planned
        .iter()
        .flat_map(|planned| strategies.iter().map(move |kind| (planned, kind)))
        .collect();
    cases
        .par_iter()
        .map(|&(planned, kind)| {
            let mut compensator = kind.compensator(predictors)?;
            let run = track(&closed_loop, planned, &mut *compensator)?;
            each();
            Ok(CompensatedRun {
                id: planned.id,
                strategy: kind.name.to_owned(),
                run,
            })
        })
        .collect()
}

/// How often [`compensate_with`] calls back.
pub fn runs(model: &Axis, strategies: &[&StrategyKind]) -> usize {
    model.trajectories.len() * strategies.len()
}

/// The run of a trajectory under the strategy of a name.
pub fn find<'a>(runs: &'a [CompensatedRun], id: usize, strategy: &str) -> Option<&'a Run> {
    let mut runs = runs.iter();
    runs.find(|run| run.id == id && run.strategy == strategy)
        .map(|run| &run.run)
}
