//! `network_lugre`: the network, and feed-forward of the friction found on the machine.

use compensator::Combined;

use super::{Build, Need, ReportTable, StrategyKind};

/// The network with LuGre feed-forward.
pub static KIND: StrategyKind = StrategyKind {
    name: "network_lugre",
    label: "network + LuGre",
    heading: "Network + LuGre",
    summary: "the network, and LuGre feed-forward with the identified parameters",
    table: ReportTable::WithFrictionFeedforward,
    needs: &[Need::Network, Need::IdentifiedFriction],
    build: Build::Each(|predictors| {
        let friction = predictors.friction(predictors.identified()?)?;
        Ok(Box::new(Combined::new(predictors.network()?, friction)))
    }),
};
