//! Compensated runs on what stands for the machine: Tables 15 and 16.

use axis_sim::{Axis, ClosedLoop};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::PipelineError;
use crate::strategies::{Predictors, Strategy};
use crate::tracking::{Run, plan_all, track};

/// One trajectory under one strategy.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CompensatedRun {
    /// Number of the trajectory, from 1.
    pub id: usize,
    /// The strategy.
    pub strategy: Strategy,
    /// Its tracking error.
    pub run: Run,
}

/// Runs every trajectory of `model` on `machine` under every strategy but
/// none, in that order.
///
/// # Errors
/// [`PipelineError`] where a run diverges.
pub fn compensate(
    model: &Axis,
    machine: &Axis,
    predictors: &Predictors,
    each: impl Fn() + Sync,
) -> Result<Vec<CompensatedRun>, PipelineError> {
    let closed_loop = ClosedLoop::new(machine)?;
    let planned = plan_all(model)?;
    let cases: Vec<_> = planned
        .iter()
        .flat_map(|planned| Strategy::COMPENSATED.map(|strategy| (planned, strategy)))
        .collect();
    cases
        .par_iter()
        .map(|&(planned, strategy)| {
            let mut compensator = predictors.compensator(strategy)?;
            let run = track(&closed_loop, planned, &mut *compensator)?;
            each();
            Ok(CompensatedRun {
                id: planned.id,
                strategy,
                run,
            })
        })
        .collect()
}

/// How often [`compensate`] calls back.
pub fn runs(model: &Axis) -> usize {
    model.trajectories.len() * Strategy::COMPENSATED.len()
}
