//! `drive_terms`: what an ordinary drive makes of the constants, the pulse and the table
//! that it can be given.

use axis_sim::Axis;
use compensator::{Compensator, DriveTerms, DriveTermsFeedforward, ReversalStart, Sample};

use super::{Build, LearnedValues, NextMove, ReportTable, Strategy, StrategyKind};
use crate::PipelineError;

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "drive_terms",
    label: "drive terms",
    heading: "Drive terms",
    summary: "feed-forward gains, a reversal pulse and a table, as an ordinary drive has them",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        let start = reversal_start(&predictors.axis);
        let terms = DriveTerms::new(&predictors.assumed_model()?, &start)?;
        Ok(Box::new(Applied(DriveTermsFeedforward::new(terms))))
    }),
};

/// The start that the reversal pulse is fitted to: that of the axis' trajectories, with the
/// mean of their jerks; 1 m/s³ if there are none.
pub fn reversal_start(axis: &Axis) -> ReversalStart {
    let jerks = axis.trajectories.iter().map(|t| t.limits.jerk());
    let mean = jerks.sum::<f64>() / axis.trajectories.len() as f64;
    ReversalStart {
        acceleration: 0.0,
        jerk: if mean > 0.0 { mean } else { 1.0 },
    }
}

struct Applied(DriveTermsFeedforward);

impl Strategy for Applied {
    fn compensator(
        &mut self,
        next: &NextMove,
    ) -> Result<Box<dyn Compensator + Send>, PipelineError> {
        self.0 = match &next.continued {
            Some(_) => self.0.carried_on(),
            None => DriveTermsFeedforward::new(*self.0.terms()),
        };
        Ok(Box::new(self.0))
    }

    /// Nothing is learned; the drive's state after the move is kept for the next.
    fn learn(&mut self, record: &[Sample]) -> Result<LearnedValues, PipelineError> {
        for sample in record {
            self.0.correct(sample);
        }
        Ok(LearnedValues::new())
    }
}
