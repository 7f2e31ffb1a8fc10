//! Compensated runs on what stands for the machine: Tables 15 and 16.

use axis_sim::{Axis, ClosedLoop, Measured};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::moves::{Moves, NamedMotion};
use crate::strategies::{Build, Predictors, STRATEGIES, StrategyKind};
use crate::tracking::{PlannedTrajectory, Run, plan_all, run_of};
use crate::{ErrorUnit, PipelineError};

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
/// in that order; a strategy that learns does so from each trajectory for those after it.
/// One that the axis cannot carry (a feedback without margins) is left out, with a warning.
/// `each` is called once a run; [`runs`] tells how often.
///
/// # Errors
/// [`PipelineError::Missing`] if the predictors lack what a strategy needs,
/// [`PipelineError::Run`] if a run diverges.
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
/// As [`compensate`]; [`PipelineError::SameName`] if two strategies have one name, by
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
    }
    let mut suited = Vec::new();
    for kind in strategies {
        match kind.strategy(predictors) {
            Ok(_) => suited.push(*kind),
            Err(error) if error.is_unsuited() => {
                tracing::warn!("{} is left out: {error}", kind.label);
            }
            // Refused before anything is computed.
            Err(error) => return Err(error),
        }
    }
    let (closed_loop, unit) = (ClosedLoop::new(machine)?, ErrorUnit::of(machine));
    let motions: Vec<NamedMotion> = plan_all(model)?
        .into_iter()
        .map(PlannedTrajectory::named)
        .collect();
    // One after the other where a strategy carries something from move to move.
    let series: Vec<(&StrategyKind, &[NamedMotion], usize)> = suited
        .iter()
        .flat_map(|kind| {
            let length = match kind.build {
                Build::Each(_) => 1,
                Build::Carrying(_) => motions.len(),
            };
            let chunks = motions.chunks(length).enumerate();
            chunks.map(move |(i, motions)| (*kind, motions, i * length + 1))
        })
        .collect();
    let runs: Vec<Vec<CompensatedRun>> = series
        .par_iter()
        .map(|&(kind, motions, first)| {
            let mut strategy = kind.strategy(predictors)?;
            let mut moves = Moves::new(&closed_loop, |_: &mut Measured| ());
            let one = |(i, motion)| {
                let made = moves.make(&mut *strategy, motion)?;
                each();
                Ok(CompensatedRun {
                    id: first + i,
                    strategy: kind.name.to_owned(),
                    run: run_of(&made.errors, unit)?,
                })
            };
            motions.iter().enumerate().map(one).collect()
        })
        .collect::<Result<_, PipelineError>>()?;
    let mut runs = runs.concat();
    // By trajectory, the strategies in their order.
    runs.sort_by_key(|run| run.id);
    Ok(runs)
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
