//! `feedback`: the plan, and a state feedback around it that estimates the friction's state.

use super::plan_based::{PlanOptions, PlanStrategy};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "feedback",
    label: "feedback",
    heading: "Plan and state feedback",
    summary: "the plan, and a state feedback around it that estimates the friction's state",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(PlanStrategy::new(
            predictors,
            PlanOptions {
                feedback: true,
                ..PlanOptions::default()
            },
        )?))
    }),
};
