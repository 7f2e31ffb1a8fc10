//! `learned`: plan and feedback adapted between moves; forces that no parameter describes are
//! learned.

use super::plan_based::{PlanOptions, PlanStrategy};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "learned",
    label: "learned",
    heading: "Adapted and learned",
    summary: "plan and feedback adapted between moves; forces that no parameter describes are learned",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(PlanStrategy::new(
            predictors,
            PlanOptions {
                feedback: true,
                adaptation: true,
                residual: true,
                repetition: true,
            },
        )?))
    }),
};
