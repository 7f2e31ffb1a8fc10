//! Values as serde reads and writes them (feature `serde`): what the constructors refuse does not get in.

use alloc::vec::Vec;

use axis_scalar::Scalar;
use serde::{Deserialize, Serialize};

use crate::{CompensatorError, TransferFunctionModel};

#[derive(Serialize, Deserialize)]
#[serde(rename = "TransferFunctionModel", deny_unknown_fields)]
pub(crate) struct StoredModel<T> {
    period: T,
    direct: T,
    poles: Vec<T>,
    coefficients: Vec<T>,
}

impl<T: Scalar> TryFrom<StoredModel<T>> for TransferFunctionModel<T> {
    type Error = CompensatorError;

    fn try_from(stored: StoredModel<T>) -> Result<Self, CompensatorError> {
        Self::new(
            stored.period,
            stored.direct,
            &stored.poles,
            &stored.coefficients,
        )
    }
}

impl<T: Scalar> From<TransferFunctionModel<T>> for StoredModel<T> {
    fn from(model: TransferFunctionModel<T>) -> Self {
        Self {
            period: model.period(),
            direct: model.direct(),
            poles: model.poles().to_vec(),
            coefficients: model.coefficients().to_vec(),
        }
    }
}
