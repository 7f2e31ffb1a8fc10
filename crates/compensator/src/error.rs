//! What can be wrong with a strategy's settings.

use axis_scalar::Scalar;
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
        /// The value given, exactly, whatever the scalar.
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
    /// A network that gives no residual.
    #[error(
        "the network has {inputs} inputs and {outputs} outputs: a residual takes 5 (position, sine and cosine of the motor's angle, its speed, share of the Coulomb level) and gives 2 (torque, force)"
    )]
    ResidualShape {
        /// Inputs of the network given.
        inputs: usize,
        /// Its outputs.
        outputs: usize,
    },
}

/// Refuses what lies outside a range; `inside` is false for NaN.
pub(crate) fn require<T: Scalar>(
    inside: bool,
    name: &'static str,
    value: T,
    valid: &'static str,
) -> Result<T, CompensatorError> {
    if inside {
        return Ok(value);
    }
    Err(CompensatorError::Setting {
        name,
        value: value.to_f64(),
        valid,
    })
}

/// Whether a value lies from `low` to `high`.
pub(crate) fn within<T: Scalar>(value: T, low: f64, high: f64) -> bool {
    (T::of(low)..=T::of(high)).contains(&value)
}

/// Refuses a transmission ratio (m/rad) that no axis has.
pub(crate) fn travel_per_radian<T: Scalar>(value: T) -> Result<T, CompensatorError> {
    let inside = within(value, 1e-9, 1e3);
    require(inside, "travel_per_radian", value, "from 1e-9 to 1e3 m/rad")
}

/// Refuses a control period (s) that no controller has.
pub(crate) fn period<T: Scalar>(value: T) -> Result<T, CompensatorError> {
    let inside = within(value, 1e-9, 1e3);
    require(inside, "period", value, "from 1e-9 to 1e3 s")
}
