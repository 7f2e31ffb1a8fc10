//! `iterative`: the plan, corrected by the error of earlier repetitions of the same move.

use super::plan_based::{PlanOptions, PlanStrategy};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "iterative",
    label: "iterative learning",
    heading: "Plan, iterative learning",
    summary: "the plan, corrected by the error of earlier repetitions of the same move",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(PlanStrategy::new(
            predictors,
            PlanOptions {
                repetition: true,
                ..PlanOptions::default()
            },
        )?))
    }),
};
