//! Designs as they are read by serde (feature `serde`): nothing unchecked gets in.

use crate::{Design, LhsError};

/// The fields of a design, not checked yet.
#[derive(serde::Deserialize)]
#[serde(rename = "Design", deny_unknown_fields)]
pub(crate) struct Stored {
    dims: usize,
    values: Vec<f64>,
}

impl TryFrom<Stored> for Design {
    type Error = LhsError;

    fn try_from(stored: Stored) -> Result<Self, LhsError> {
        Self::from_rows(stored.dims, stored.values)
    }
}
