//! `adaptive`: the plan around an untouched drive, its model adapted between moves.

use super::ladder::{Ladder, Rungs};
use super::{Build, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "adaptive",
    label: "adaptive",
    heading: "Plan, adapted between moves",
    summary: "the plan around an untouched drive, its model adapted between moves",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(Ladder::new(
            predictors,
            Rungs {
                adaptation: true,
                ..Rungs::default()
            },
        )?))
    }),
};
