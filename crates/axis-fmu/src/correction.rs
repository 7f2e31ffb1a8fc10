//! The correction in a compensated unit: a strategy, and what was found for it from samples and runs.

use axis_pipeline::strategies::{CycleLaw, Predictors, STRATEGIES, TransferModels, named};
use axis_sim::Axis;
use cfnn::Network;
use compensator::TransferFunctionModel;
use lugre::{LuGre, Parameters};
use serde::{Deserialize, Serialize};

use crate::error::UnitError;

/// A correction that a unit can have: a strategy that runs cycle by cycle.
#[derive(Clone, Debug)]
pub struct UnitCorrection {
    strategy: String,
    text: String,
    law: CycleLaw,
}

/// As it stands among the unit's resources, in JSON.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    strategy: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    network: Option<Network>,
    /// Without and with friction feed-forward.
    #[serde(skip_serializing_if = "Option::is_none")]
    transfer_functions: Option<[StoredTransfer; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    identified_friction: Option<Parameters>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredTransfer {
    period_s: f64,
    direct_s2: f64,
    poles: Vec<f64>,
    coefficients_s2: Vec<f64>,
}

impl UnitCorrection {
    /// The strategy `name` (`_` between its words) made of `predictors`: of the axis file, and of the
    /// network, transfer functions and identified friction among them.
    ///
    /// # Errors
    /// [`UnitError::Correction`] if it is not one that runs cycle by cycle, what it needs is not
    /// there, or the axis has none.
    pub fn of(predictors: &Predictors, name: &str) -> Result<Self, UnitError> {
        let refused = |error| UnitError::Correction {
            name: name.to_owned(),
            why: Box::new(error),
        };
        if let Some(kind) = named(STRATEGIES, name) {
            let by = format!("the strategy \"{name}\"");
            predictors.require(kind.needs, &by).map_err(refused)?;
        }
        let law = CycleLaw::of(predictors, name).map_err(refused)?;
        let stored = Stored {
            strategy: name.to_owned(),
            network: predictors.network.clone(),
            transfer_functions: predictors
                .transfer
                .as_ref()
                .map(|models| [&models.alone, &models.with_feedforward].map(StoredTransfer::of)),
            identified_friction: predictors.identified.map(|law| law.parameters()),
        };
        let text = serde_json::to_string(&stored).map_err(text_error)?;
        Ok(Self {
            strategy: stored.strategy,
            text,
            law,
        })
    }

    /// The correction of this text, for the axis.
    ///
    /// # Errors
    /// [`UnitError::CorrectionText`] for a text that is not one of [`UnitCorrection::text`];
    /// otherwise as [`UnitCorrection::of`].
    pub fn parse(axis: &Axis, text: &str) -> Result<Self, UnitError> {
        let stored: Stored = serde_json::from_str(text).map_err(text_error)?;
        let mut predictors = Predictors::of(axis);
        predictors.network = stored.network;
        if let Some([alone, with_feedforward]) = &stored.transfer_functions {
            predictors.transfer = Some(TransferModels {
                alone: alone.model()?,
                with_feedforward: with_feedforward.model()?,
            });
        }
        if let Some(parameters) = stored.identified_friction {
            let law = LuGre::new(parameters);
            predictors.identified = Some(law.map_err(text_error)?);
        }
        Ok(Self {
            text: text.to_owned(),
            ..Self::of(&predictors, &stored.strategy)?
        })
    }

    /// Name of the strategy.
    pub fn strategy(&self) -> &str {
        &self.strategy
    }

    /// As it stands among the unit's resources.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Control periods by which the axis follows its references late.
    pub fn look_ahead(&self) -> usize {
        self.law.look_ahead()
    }

    /// At the start of a motion.
    pub(crate) fn law(&self) -> &CycleLaw {
        &self.law
    }
}

impl StoredTransfer {
    fn of(model: &TransferFunctionModel) -> Self {
        Self {
            period_s: model.period(),
            direct_s2: model.direct(),
            poles: model.poles().to_vec(),
            coefficients_s2: model.coefficients().to_vec(),
        }
    }

    fn model(&self) -> Result<TransferFunctionModel, UnitError> {
        let (poles, coefficients) = (&self.poles, &self.coefficients_s2);
        TransferFunctionModel::new(self.period_s, self.direct_s2, poles, coefficients)
            .map_err(text_error)
    }
}

fn text_error(error: impl std::fmt::Display) -> UnitError {
    UnitError::CorrectionText(error.to_string())
}
