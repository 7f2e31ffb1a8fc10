//! `none`: the servo alone.

use compensator::NoCompensation;

use super::{Build, ReportTable, StrategyKind};

/// The servo alone, which no list of strategies holds: what they are compared with.
pub static KIND: StrategyKind = StrategyKind {
    name: "none",
    label: "none",
    heading: "None",
    summary: "the servo alone",
    table: ReportTable::More,
    needs: &[],
    build: Build::Each(|_| Ok(Box::new(NoCompensation))),
};
