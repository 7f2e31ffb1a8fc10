//! What of the correction an ordinary drive or CNC can be given, in its units, and what
//! that loses against the plan. `docs/drive-terms.md` says how it is entered.

mod gains;
mod parameters;
mod tables;
mod term;
mod terms;
mod units;

use axis_sim::Axis;
use compensator::DriveTerms;
use serde::Serialize;

use crate::compensation::{compensate_with, find};
use crate::strategies::{NONE, Predictors, STRATEGIES, StrategyKind, named, reversal_start};
use crate::{Figures, PipelineError};
pub use parameters::DriveParameter;
pub use tables::{TermTable, over_position, over_turn};
pub use term::Term;
pub use terms::{gain_terms, terms};

/// Tracking errors of a trajectory, µm or µrad.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Loss {
    /// Number of the trajectory, from 1.
    pub trajectory: usize,
    /// Without compensation.
    pub none: Figures,
    /// With the drive terms.
    pub drive_terms: Figures,
    /// With the full plan.
    pub plan: Figures,
}

/// The terms of an axis as its file has it.
///
/// # Errors
/// [`PipelineError::Compensator`] if no terms can be made from it.
pub fn of_axis(axis: &Axis) -> Result<DriveTerms, PipelineError> {
    let model = Predictors::of(axis).assumed_model()?;
    Ok(DriveTerms::new(&model, &reversal_start(axis))?)
}

/// Runs the trajectories of `model` on `machine` without compensation, with the drive terms
/// and with the plan, both made from `model`; nothing if it has no trajectories.
///
/// # Errors
/// As [`compensate_with`].
pub fn losses(model: &Axis, machine: &Axis) -> Result<Vec<Loss>, PipelineError> {
    if model.trajectories.is_empty() {
        return Ok(Vec::new());
    }
    let kinds: Vec<&StrategyKind> = ["drive_terms", "plan"]
        .into_iter()
        .filter_map(|name| named(STRATEGIES, name))
        .chain([&NONE])
        .collect();
    let runs = compensate_with(model, machine, &Predictors::of(model), &kinds, || ())?;
    let figures = |id, name| find(&runs, id, name).map(|run| run.figures);
    let loss = |id| {
        Some(Loss {
            trajectory: id,
            none: figures(id, NONE.name)?,
            drive_terms: figures(id, "drive_terms")?,
            plan: figures(id, "plan")?,
        })
    };
    Ok((1..=model.trajectories.len()).filter_map(loss).collect())
}
