//! Maximum and mean of an error, the two figures of the paper's tables.

use axis_log::metrics::ErrorSummary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::PipelineError;

/// Maximum and mean of an absolute error, µm or µrad (the axis' [`crate::ErrorUnit`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Figures {
    /// Greatest absolute error, µm or µrad.
    pub max: f64,
    /// Mean absolute error, µm or µrad.
    pub mean: f64,
}

impl Figures {
    /// The figures of errors given in metres or radians.
    ///
    /// # Errors
    /// [`PipelineError::Metric`] for an empty or not finite series.
    pub fn of_si(errors: &[f64]) -> Result<Self, PipelineError> {
        let summary = ErrorSummary::of(errors)?;
        Ok(Self {
            max: 1e6 * summary.max,
            mean: 1e6 * summary.mean,
        })
    }
}
