//! Runs of the closed loop over an axis' trajectories.

use std::sync::Arc;

use axis_sim::{Axis, ClosedLoop, Cycle};
use compensator::Compensator;
use serde::{Deserialize, Serialize};
use trajectories::{Motion, SCurve};

use crate::moves::NamedMotion;
use crate::{Figures, PipelineError};

/// One run: its figures over every control cycle, and the error thinned for display.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Maximum and mean of the absolute tracking error over all cycles, µm.
    pub figures: Figures,
    /// The tracking error at every [`DISPLAY_EVERY`]th cycle, µm.
    pub error_um: Vec<f64>,
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
/// [`PipelineError::NoTrajectories`] where the axis file lists none,
/// [`PipelineError::Trajectory`] where one cannot be planned.
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
/// [`PipelineError::Run`] where the run does not come to its end.
pub fn track(
    closed_loop: &ClosedLoop,
    planned: &PlannedTrajectory,
    compensator: &mut (impl Compensator + ?Sized),
) -> Result<Run, PipelineError> {
    let mut errors = Vec::new();
    follow(closed_loop, planned, compensator, |cycle| {
        errors.push(cycle.error())
    })?;
    run_of(&errors)
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

/// A run from its errors in metres, one a cycle.
///
/// # Errors
/// [`PipelineError::Metric`] for an empty or not finite series.
pub fn run_of(errors: &[f64]) -> Result<Run, PipelineError> {
    let thinned = errors.iter().step_by(DISPLAY_EVERY);
    Ok(Run {
        figures: Figures::of_metres(errors)?,
        error_um: thinned.map(|e| 1e6 * e).collect(),
    })
}

/// Reference profile of a trajectory at the displayed instants.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Velocity, mm/s.
    pub velocity_mm_s: Vec<f64>,
    /// Acceleration, mm/s².
    pub acceleration_mm_s2: Vec<f64>,
    /// Jerk, mm/s³.
    pub jerk_mm_s3: Vec<f64>,
}

/// The profile of a planned trajectory for a control period (s).
pub fn profile(planned: &PlannedTrajectory, period: f64) -> Profile {
    let step = DISPLAY_EVERY as f64 * period;
    let count = (planned.motion.duration() / step * (1.0 + 1e-12)) as usize;
    let mut profile = Profile::default();
    for k in 0..=count {
        let time = k as f64 * step;
        let at = planned.motion.at(time);
        profile.time_s.push(time);
        profile.velocity_mm_s.push(1e3 * at.velocity);
        profile.acceleration_mm_s2.push(1e3 * at.acceleration);
        profile.jerk_mm_s3.push(1e3 * at.jerk);
    }
    profile
}
