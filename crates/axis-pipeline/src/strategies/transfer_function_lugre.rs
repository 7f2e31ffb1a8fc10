//! `transfer_function_lugre`: feed-forward of the friction found on the machine, and the
//! transfer function of the error that it leaves.

use compensator::Combined;

use super::{Build, Need, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "transfer_function_lugre",
    label: "transfer function + LuGre",
    heading: "Transfer function + LuGre",
    summary: "the transfer function, and LuGre feed-forward with the identified parameters",
    table: ReportTable::WithFrictionFeedforward,
    needs: &[Need::TransferFunctions, Need::IdentifiedFriction],
    build: Build::Each(|predictors| {
        let model = predictors.transfer()?.with_feedforward;
        let friction = predictors.friction(predictors.identified()?)?;
        Ok(Box::new(Combined::new(
            predictors.leading(model)?,
            friction,
        )))
    }),
};
