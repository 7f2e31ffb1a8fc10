//! A number and how well it is known.

/// A value with its standard error, both in the unit of the quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParameterEstimate {
    /// The estimate.
    pub value: f64,
    /// Its standard error: one standard deviation of the estimate over
    /// repeated noise.
    pub standard_error: f64,
}

impl ParameterEstimate {
    /// Whether `truth` lies within `value ± sigmas · standard_error`.
    #[must_use]
    pub fn covers(&self, truth: f64, sigmas: f64) -> bool {
        (truth - self.value).abs() <= sigmas * self.standard_error
    }
}
