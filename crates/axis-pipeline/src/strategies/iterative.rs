//! `iterative`: the plan, corrected by what the same move was off by before.

use super::ladder::{Ladder, Rungs};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "iterative",
    label: "iterative learning",
    heading: "Plan, iterative learning",
    summary: "the plan, corrected by what the same move was off by before",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(Ladder::new(
            predictors,
            Rungs {
                repetition: true,
                ..Rungs::default()
            },
        )?))
    }),
};
