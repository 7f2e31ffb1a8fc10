//! `lugre`: feed-forward of the friction found on the machine, alone.

use super::{Build, Need, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "lugre",
    label: "LuGre",
    heading: "LuGre alone, identified",
    summary: "LuGre feed-forward alone, with the identified parameters",
    table: ReportTable::More,
    needs: &[Need::IdentifiedFriction],
    build: Build::Each(|predictors| {
        let law = predictors.identified()?;
        Ok(Box::new(predictors.friction(law)?))
    }),
};
