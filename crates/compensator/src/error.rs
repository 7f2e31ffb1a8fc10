//! What can be wrong with a strategy's settings.

use thiserror::Error;

/// Why a strategy could not be made.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum CompensatorError {
    /// A setting lies outside its range.
    #[error("{name} = {value} is not valid: it must be {valid}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// The value given.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A network of the wrong shape.
    #[error(
        "the network has {inputs} inputs and {outputs} outputs: the prediction takes 4 (position, speed, acceleration, current command) and gives 1 (the increment of the position)"
    )]
    NetworkShape {
        /// Inputs of the network given.
        inputs: usize,
        /// Its outputs.
        outputs: usize,
    },
}

/// Refuses what lies outside a range; `inside` is false for NaN.
pub(crate) fn require(
    inside: bool,
    name: &'static str,
    value: f64,
    valid: &'static str,
) -> Result<f64, CompensatorError> {
    if inside {
        return Ok(value);
    }
    Err(CompensatorError::Setting { name, value, valid })
}

/// Refuses what is not finite and above zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, CompensatorError> {
    let inside = value.is_finite() && value > 0.0;
    require(inside, name, value, "finite and above zero")
}
