//! How great a strategy's corrections become: what the limits of a guard are made of.

use std::sync::Arc;

use axis_sim::{Axis, ClosedLoop};
use compensator::{Compensator, Correction, Sample};
use rayon::prelude::*;

use crate::PipelineError;
use crate::strategies::{Predictors, StrategyKind};
use crate::tracking::{PlannedTrajectory, follow, plan_all};

/// The greatest magnitudes along some motions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Greatest {
    /// Offset of the position, m or rad.
    pub position: f64,
    /// Offset of the command, in the actuator's unit.
    pub effort: f64,
    /// Surprise, in deviations ([`Compensator::surprise`]).
    pub surprise: f64,
}

impl Greatest {
    fn or(self, other: Self) -> Self {
        Self {
            position: self.position.max(other.position),
            effort: self.effort.max(other.effort),
            surprise: self.surprise.max(other.surprise),
        }
    }
}

/// What a strategy corrects at most on the trajectories of its axis file, each simulated on
/// `machine` from rest. `each` is called once a trajectory.
///
/// # Errors
/// [`PipelineError::NoTrajectories`] if the axis file lists none, [`PipelineError::Run`]
/// if a run does not come to its end, and what the strategy refuses.
pub fn greatest(
    machine: &Axis,
    predictors: &Predictors,
    kind: &StrategyKind,
    each: impl Fn() + Sync,
) -> Result<Greatest, PipelineError> {
    let planned = plan_all(&predictors.axis)?;
    let closed_loop = ClosedLoop::new(machine)?;
    let one = |planned: &PlannedTrajectory| {
        let motion = Arc::new(planned.motion);
        let mut compensator = kind.compensator(predictors, motion)?;
        let mut watched = Watched {
            inner: &mut *compensator,
            greatest: Greatest::default(),
        };
        follow(&closed_loop, planned, &mut watched, |_| {})?;
        each();
        Ok(watched.greatest)
    };
    let all: Vec<Greatest> = planned
        .par_iter()
        .map(one)
        .collect::<Result<_, PipelineError>>()?;
    Ok(all.into_iter().fold(Greatest::default(), Greatest::or))
}

/// A compensator whose greatest corrections are kept.
struct Watched<'a> {
    inner: &'a mut dyn Compensator,
    greatest: Greatest,
}

impl Compensator for Watched<'_> {
    fn reset(&mut self) {
        self.inner.reset();
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        let made = self.inner.correct(sample);
        self.greatest = self.greatest.or(Greatest {
            position: made.position.abs(),
            effort: made.command.abs(),
            surprise: self.inner.surprise(),
        });
        made
    }

    fn surprise(&self) -> f64 {
        self.inner.surprise()
    }
}
