//! `learned`: plan and feedback adapted between moves, and what no parameter holds learned.

use super::ladder::{Ladder, Rungs};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "learned",
    label: "learned",
    heading: "Adapted and learned",
    summary: "plan and feedback adapted between moves, and what no parameter holds learned",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(Ladder::new(
            predictors,
            Rungs {
                feedback: true,
                adaptation: true,
                residual: true,
                repetition: true,
            },
        )?))
    }),
};
