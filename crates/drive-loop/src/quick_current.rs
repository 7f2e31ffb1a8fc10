//! Current controllers at the magnitude optimum.

use axis_sim::{Axis, SetupError};

use crate::error::LoopError;

/// Sets the current controllers to the magnitude optimum; whether there are any.
pub(crate) fn with_quick_current(axis: &mut Axis) -> Result<bool, LoopError> {
    let values = axis.actuator.values();
    let Some(values) = axis.actuator.with_magnitude_optimum(values, axis.period) else {
        return Ok(false);
    };
    let changed = axis.actuator.change(|own| *own = values);
    changed.map_err(SetupError::from)?;
    axis.actuator
        .runs_at(axis.period)
        .map_err(SetupError::from)?;
    Ok(true)
}
