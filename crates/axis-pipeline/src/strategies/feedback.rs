//! `feedback`: the plan, and a state feedback around it that knows the friction's state.

use super::ladder::{Ladder, Rungs};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "feedback",
    label: "feedback",
    heading: "Plan and state feedback",
    summary: "the plan, and a state feedback around it that knows the friction's state",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(Ladder::new(
            predictors,
            Rungs {
                feedback: true,
                ..Rungs::default()
            },
        )?))
    }),
};
