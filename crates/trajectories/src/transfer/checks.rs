//! What can be asked of a transfer.

use super::TransferLimits;
use crate::error::{bounded, check, position};
use crate::{Real, Setpoint, TrajectoryError, maximum};

/// Names of a target's values in errors.
pub(super) const TARGET: [&str; 3] = ["target position", "target velocity", "target acceleration"];

/// Whether a state can be planned from or to.
pub(super) fn state<T: Real>(
    state: &Setpoint<T>,
    names: [&'static str; 3],
) -> Result<(), TrajectoryError> {
    position(names[0], state.position)?;
    bounded(
        names[1],
        state.velocity,
        maximum::VELOCITY,
        "m/s",
        "from -1e9 to 1e9",
    )?;
    bounded(
        names[2],
        state.acceleration,
        maximum::ACCELERATION,
        "m/s²",
        "from -1e9 to 1e9",
    )?;
    Ok(())
}

/// Whether a target can be reached within the limits.
pub(super) fn reachable<T: Real>(
    target: &Setpoint<T>,
    limits: &TransferLimits<T>,
) -> Result<(), TrajectoryError> {
    let (v, a) = (target.velocity, target.acceleration);
    let change = &limits.change;
    check(
        v >= limits.back && v <= limits.fast,
        TARGET[1],
        v,
        "m/s",
        "within the velocity limits",
    )?;
    if change.jerk() == T::INFINITY {
        return Ok(());
    }
    check(
        a >= change.acceleration_min() && a <= change.acceleration_max(),
        TARGET[2],
        a,
        "m/s²",
        "within the acceleration limits",
    )?;
    // A velocity that rises at the end was lower by a²/2J where the acceleration was zero.
    let before = v - T::HALF * a * (a.abs() / change.jerk());
    let rounding = T::of(16.0) * T::EPSILON * (v.abs() + before.abs());
    check(
        before >= limits.back - rounding && before <= limits.fast + rounding,
        TARGET[2],
        a,
        "m/s²",
        "so small that it can be built up within the velocity limits: a²/2J at most the distance of the velocity from the limit it comes from",
    )?;
    Ok(())
}
