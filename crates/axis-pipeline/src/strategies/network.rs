//! `network`: the tracking error that the network predicts for the end of the cycle.

use super::{Build, Need, ReportTable, StrategyKind};

/// The network alone.
pub static KIND: StrategyKind = StrategyKind {
    name: "network",
    label: "network",
    heading: "Network",
    summary: "the network's predicted error",
    table: ReportTable::WithoutFrictionFeedforward,
    needs: &[Need::Network],
    build: Build::Each(|predictors| Ok(Box::new(predictors.network()?))),
};
