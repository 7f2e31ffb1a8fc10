//! `network_lugre_printed`: the network, and feed-forward of the axis file's friction.

use compensator::Combined;

use super::{Build, Need, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "network_lugre_printed",
    label: "network + LuGre as in the axis file",
    heading: "Network + LuGre, the axis file's own parameters",
    summary: "the network, and LuGre feed-forward with the axis file's own parameters",
    table: ReportTable::More,
    needs: &[Need::Network],
    build: Build::Each(|predictors| {
        let friction = predictors.friction(predictors.axis.friction.law)?;
        Ok(Box::new(Combined::new(predictors.network()?, friction)))
    }),
};
