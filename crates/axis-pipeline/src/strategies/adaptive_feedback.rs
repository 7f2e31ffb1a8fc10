//! `adaptive_feedback`: plan and state feedback, the model adapted between moves.

use super::plan_based::{PlanOptions, PlanStrategy};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "adaptive_feedback",
    label: "adaptive feedback",
    heading: "Plan and feedback, adapted",
    summary: "plan and state feedback, the model adapted between moves",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(PlanStrategy::new(
            predictors,
            PlanOptions {
                feedback: true,
                adaptation: true,
                ..PlanOptions::default()
            },
        )?))
    }),
};
