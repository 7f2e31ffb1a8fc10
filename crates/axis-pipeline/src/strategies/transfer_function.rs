//! `transfer_function`: the tracking error that a linear model predicts from the reference.

use super::{Build, Need, ReportTable, StrategyKind};

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "transfer_function",
    label: "transfer function",
    heading: "Transfer function",
    summary: "the transfer function's predicted error",
    table: ReportTable::WithoutFrictionFeedforward,
    needs: &[Need::TransferFunctions],
    build: Build::Each(|predictors| {
        let model = predictors.transfer()?.alone;
        Ok(Box::new(predictors.leading(model)?))
    }),
};
