//! Friction at another temperature.

use lugre::{Exponential, LuGre};

use crate::error::{require, within};
use crate::{CompensatorError, DriveModel};

impl<T: Exponential> DriveModel<T> {
    /// The same axis at another temperature: its dry friction (Coulomb and breakaway level) and its
    /// viscous friction times `factors`. The bristles' stiffness stays.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] if a factor is not finite, or below 0, or leaves no valid friction.
    pub fn warmed(mut self, factors: [T; 2]) -> Result<Self, CompensatorError> {
        self.friction = warmed(&self.friction, factors)?;
        Ok(self)
    }
}

/// Friction with its dry and its viscous part times `factors`.
pub(crate) fn warmed<T: Exponential>(
    friction: &LuGre<T>,
    [dry, viscous]: [T; 2],
) -> Result<LuGre<T>, CompensatorError> {
    for (name, factor) in [("dry factor", dry), ("viscous factor", viscous)] {
        require(within(factor, 0.0, 1e3), name, factor, "from 0 to 1000")?;
    }
    let mut p = friction.parameters();
    p.coulomb *= dry;
    p.stiction *= dry;
    p.viscous *= viscous;
    let outside = |_| CompensatorError::Setting {
        name: "friction",
        value: p.coulomb.to_f64(),
        valid: "factors that leave a valid friction law",
    };
    LuGre::new(p).map_err(outside)
}
