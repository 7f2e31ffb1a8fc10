//! `adaptive`: the plan, its model adapted between moves; the drive's own loops stay as they are.

use super::plan_based::{PlanOptions, PlanStrategy};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "adaptive",
    label: "adaptive",
    heading: "Plan, adapted between moves",
    summary: "the plan, its model adapted between moves; the drive's own loops stay as they are",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(PlanStrategy::new(
            predictors,
            PlanOptions {
                adaptation: true,
                ..PlanOptions::default()
            },
        )?))
    }),
};
