//! Identification of the transfer function of the tracking error, the paper's
//! baseline, from simulated motion.

use axis_sim::{Axis, ClosedLoop};
use compensator::{
    Candidates, Compensator, MotionRecord as Observed, NoCompensation, TransferFunctionFit,
    identify_transfer_function,
};
use lhs::LatinHypercube;
use rayon::prelude::*;
use trajectories::{Limits, SCurve};

use crate::PipelineError;
use crate::strategies::Feedforward;
use crate::tracking::{PlannedTrajectory, follow};

/// Which motions the transfer function is identified from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferPlan {
    /// Motions to fit.
    pub training: usize,
    /// Other motions, by which order and pole are chosen.
    pub validation: usize,
    /// Seed of the motions' Latin hypercube.
    pub seed: u64,
}

impl Default for TransferPlan {
    fn default() -> Self {
        Self {
            training: 10,
            validation: 5,
            seed: 0,
        }
    }
}

/// Simulates moves there and back over a Latin hypercube of speed,
/// acceleration, jerk, distance and start, and fits the transfer function.
///
/// The hypercube spans half to one and a half times the values of the axis'
/// own trajectories, none of which is among the moves.
///
/// With `feedforward` the axis runs under LuGre feed-forward of its own
/// friction meanwhile: what is left is more nearly linear, and is what a
/// transfer function beside that feed-forward has to predict.
///
/// # Errors
/// [`PipelineError`] if a run diverges or the fit has too little data.
pub fn identify_transfer(
    axis: &Axis,
    plan: &TransferPlan,
    feedforward: bool,
    each: impl Fn() + Sync,
) -> Result<TransferFunctionFit, PipelineError> {
    let closed_loop = ClosedLoop::new(axis)?;
    let design = LatinHypercube::new(plan.training + plan.validation, 5, plan.seed)?;
    let spans = spans(axis)?;
    let record = |row: usize| {
        let mut cell = [0.0; 5];
        design.row(row, &mut cell)?;
        let mut law: Box<dyn Compensator> = if feedforward {
            Box::new(Feedforward::of(axis).of_law(axis.friction.law, axis.period)?)
        } else {
            Box::new(NoCompensation)
        };
        let motion = a_move(axis, &spans, &cell, row % 2 == 1)?;
        let record = one(&closed_loop, motion, &mut *law);
        each();
        record
    };
    let records: Result<Vec<Record>, PipelineError> =
        (0..design.len()).into_par_iter().map(record).collect();
    let records = records?;
    let observed: Vec<Observed> = (records.iter())
        .map(|record| Observed {
            period: axis.period,
            acceleration: &record.acceleration,
            error: &record.error,
        })
        .collect();
    let (training, validation) = observed.split_at(plan.training);
    let candidates = Candidates::for_period(axis.period);
    Ok(identify_transfer_function(
        training,
        validation,
        &candidates,
    )?)
}

/// What one move left behind, a value each cycle.
struct Record {
    acceleration: Vec<f64>,
    error: Vec<f64>,
}

/// Least and greatest speed, acceleration, jerk and distance over the
/// trajectories of an axis.
type Spans = [[f64; 2]; 4];

fn spans(axis: &Axis) -> Result<Spans, PipelineError> {
    let mut spans = [[f64::INFINITY, 0.0]; 4];
    for spec in &axis.trajectories {
        let limits = &spec.limits;
        let values = [
            limits.velocity(),
            limits.acceleration(),
            limits.jerk(),
            spec.displacement.abs(),
        ];
        for (span, value) in spans.iter_mut().zip(values) {
            *span = [span[0].min(0.5 * value), span[1].max(1.5 * value)];
        }
    }
    if axis.trajectories.is_empty() {
        return Err(PipelineError::NoTrajectories);
    }
    Ok(spans)
}

/// The move of one cell of the hypercube.
fn a_move(
    axis: &Axis,
    spans: &Spans,
    cell: &[f64; 5],
    back: bool,
) -> Result<SCurve, PipelineError> {
    let at = |i: usize| spans[i][0] + cell[i] * (spans[i][1] - spans[i][0]);
    let planning = |source| PipelineError::Trajectory { index: 0, source };
    let stroke = axis.stroke.maximum - axis.stroke.minimum;
    let distance = at(3).min(0.9 * stroke);
    let start = axis.stroke.minimum + cell[4] * (stroke - distance);
    let (from, to) = if back {
        (start + distance, start)
    } else {
        (start, start + distance)
    };
    let limits = Limits::new(at(0), at(1), at(2)).map_err(planning)?;
    SCurve::plan(from, to, &limits).map_err(planning)
}

fn one(
    closed_loop: &ClosedLoop,
    motion: SCurve,
    law: &mut dyn Compensator,
) -> Result<Record, PipelineError> {
    let planned = PlannedTrajectory { id: 0, motion };
    let (mut acceleration, mut error) = (Vec::new(), Vec::new());
    follow(closed_loop, &planned, law, |cycle| {
        acceleration.push(cycle.reference.acceleration);
        error.push(cycle.error());
    })?;
    Ok(Record {
        acceleration,
        error,
    })
}
