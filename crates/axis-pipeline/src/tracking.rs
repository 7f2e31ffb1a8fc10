//! Runs of the closed loop over an axis' trajectories.

use std::sync::Arc;

use axis_sim::{Axis, ClosedLoop, Cycle};
use compensator::Compensator;
use serde::{Deserialize, Serialize};
use trajectories::{Motion, SCurve, Setpoint};

use crate::measured::{Acceleration, ErrorSeries, Jerk, Velocity};
use crate::moves::NamedMotion;
use crate::{ErrorUnit, Figures, PipelineError};

/// One run: its figures over every control cycle, and the error thinned for display.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Maximum and mean of the absolute tracking error over all cycles, µm or µrad.
    pub figures: Figures,
    /// The tracking error at every [`DISPLAY_EVERY`]th cycle.
    #[serde(flatten)]
    pub error: ErrorSeries<Vec<f64>>,
}

/// Cycles from one displayed sample to the next.
pub const DISPLAY_EVERY: usize = 10;

/// A trajectory with its number and plan.
#[derive(Clone, Debug)]
pub struct PlannedTrajectory {
    /// Number in the axis file, from 1.
    pub id: usize,
    /// The S-curve.
    pub motion: SCurve,
}

impl PlannedTrajectory {
    /// Under its number.
    pub fn named(self) -> NamedMotion {
        NamedMotion {
            name: self.id.to_string(),
            motion: Arc::new(self.motion),
            learned: None,
        }
    }
}

/// Plans every trajectory of an axis.
///
/// # Errors
/// [`PipelineError::NoTrajectories`] if the axis file lists none,
/// [`PipelineError::Trajectory`] if one cannot be planned.
pub fn plan_all(axis: &Axis) -> Result<Vec<PlannedTrajectory>, PipelineError> {
    if axis.trajectories.is_empty() {
        return Err(PipelineError::NoTrajectories);
    }
    let plan = |(i, spec)| {
        let id = i + 1;
        let motion = axis
            .plan(spec)
            .map_err(|source| PipelineError::Trajectory { index: id, source })?;
        Ok(PlannedTrajectory { id, motion })
    };
    axis.trajectories.iter().enumerate().map(plan).collect()
}

/// Follows a trajectory and keeps its error.
///
/// # Errors
/// [`PipelineError::Run`] if the run does not come to its end.
pub fn track(
    closed_loop: &ClosedLoop,
    planned: &PlannedTrajectory,
    compensator: &mut (impl Compensator + ?Sized),
) -> Result<Run, PipelineError> {
    let mut errors = Vec::new();
    follow(closed_loop, planned, compensator, |cycle| {
        errors.push(cycle.error())
    })?;
    run_of(&errors, ErrorUnit::of(closed_loop.axis()))
}

/// Follows a trajectory and shows every cycle to `observe`.
///
/// # Errors
/// As [`track`].
pub fn follow(
    closed_loop: &ClosedLoop,
    planned: &PlannedTrajectory,
    compensator: &mut (impl Compensator + ?Sized),
    observe: impl FnMut(&Cycle),
) -> Result<(), PipelineError> {
    let outcome = closed_loop.run(&planned.motion, compensator, observe);
    outcome.completed().map_err(|source| PipelineError::Run {
        what: format!("trajectory {} of {}", planned.id, closed_loop.axis().name),
        source,
    })
}

/// A run from its errors in metres or radians, one a cycle.
///
/// # Errors
/// [`PipelineError::Metric`] for an empty or not finite series.
pub fn run_of(errors: &[f64], unit: ErrorUnit) -> Result<Run, PipelineError> {
    let thinned = errors.iter().step_by(DISPLAY_EVERY);
    Ok(Run {
        figures: Figures::of_si(errors)?,
        error: ErrorSeries::new(unit, thinned.map(|e| 1e6 * e).collect()),
    })
}

/// Reference profile of a trajectory at the displayed instants.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Velocity.
    #[serde(flatten)]
    pub velocity: Velocity<Vec<f64>>,
    /// Acceleration.
    #[serde(flatten)]
    pub acceleration: Acceleration<Vec<f64>>,
    /// Jerk.
    #[serde(flatten)]
    pub jerk: Jerk<Vec<f64>>,
}

/// The profile of a planned trajectory for the control period of its axis.
pub fn profile(planned: &PlannedTrajectory, axis: &Axis) -> Profile {
    let (step, unit) = (DISPLAY_EVERY as f64 * axis.period, ErrorUnit::of(axis));
    let count = (planned.motion.duration() / step * (1.0 + 1e-12)) as usize;
    let time_s: Vec<f64> = (0..=count).map(|k| k as f64 * step).collect();
    let of = |read: fn(&Setpoint<f64>) -> f64| {
        let values = time_s
            .iter()
            .map(|&time| 1e3 * read(&planned.motion.at(time)));
        values.collect()
    };
    Profile {
        velocity: Velocity::new(unit, of(|at| at.velocity)),
        acceleration: Acceleration::new(unit, of(|at| at.acceleration)),
        jerk: Jerk::new(unit, of(|at| at.jerk)),
        time_s,
    }
}
