//! `adaptive_feedback`: plan and state feedback, the model adapted between moves.

use super::ladder::{Ladder, Rungs};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "adaptive_feedback",
    label: "adaptive feedback",
    heading: "Plan and feedback, adapted",
    summary: "plan and state feedback, the model adapted between moves",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(Ladder::new(
            predictors,
            Rungs {
                feedback: true,
                adaptation: true,
                ..Rungs::default()
            },
        )?))
    }),
};
