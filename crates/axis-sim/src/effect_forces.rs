//! Torque and force that effects ask of a motor, at a point of a motion.

use crate::axis::Axis;
use crate::effects::{ActiveEffect, Hooks, TableState};
use crate::error::SetupError;

/// What effects add to torque and load wherever an axis is. What depends on time, on memory
/// or on the transmission's force is as at the start of a motion; what only changes a
/// parameter of the axis is not in it.
#[derive(Clone, Debug)]
pub struct EffectForces {
    hooks: Hooks,
    travel: f64,
}

impl EffectForces {
    /// Torque that the motor must give besides, N·m, and force against the load, N or N·m:
    /// the motor at `angle` (rad) and `speed` (rad/s), the load at `position` (m or rad),
    /// the bristles at the share `direction` of the Coulomb level, −1 to 1.
    #[must_use]
    pub fn at(&self, angle: f64, speed: f64, position: f64, direction: f64) -> [f64; 2] {
        let load = self.hooks.loads_at(&TableState {
            position,
            speed: self.travel * speed,
            bristle: direction,
            loaded: 1.0,
            ..TableState::default()
        });
        // The hook gives what the rotor feels of a motor that makes no torque.
        [-self.hooks.torque_at(angle, 0.0), load]
    }
}

impl Axis {
    /// Torque and force of `effects`, as if the axis had these and no others.
    ///
    /// # Errors
    /// [`SetupError`] if one does not fit the axis.
    pub fn effect_forces(&self, effects: &[ActiveEffect]) -> Result<EffectForces, SetupError> {
        let mut axis = self.clone();
        axis.effects = effects.to_vec();
        let (_, hooks) = axis.with_effects()?;
        Ok(EffectForces {
            hooks,
            travel: self.travel_per_radian(),
        })
    }
}
