//! Stiffness of a transmission against the position of its load.

use std::fmt::Debug;
use std::sync::Arc;

use crate::DriveError;
use crate::error::positive;

/// Stiffness of a transmission as seen at its load, against the load's position.
pub trait Stiffness: Debug + Send + Sync {
    /// Stiffness with the load at `x` (m, or rad where it turns), N/m or N·m/rad.
    ///
    /// Must be finite and above zero wherever the load may be; a step at which it
    /// is not gives a state that is no number, and says that it did not converge.
    fn at(&self, x: f64) -> f64;

    /// The stiffness where it is the same everywhere, to the bit: a stepper then asks
    /// for it once.
    fn constant(&self) -> Option<f64> {
        None
    }
}

/// The same everywhere.
impl Stiffness for f64 {
    fn at(&self, _: f64) -> f64 {
        *self
    }

    fn constant(&self) -> Option<f64> {
        Some(*self)
    }
}

/// Springs one behind the other: 1/k = Σ 1/k_i.
#[derive(Clone, Debug)]
pub struct InSeries(pub Vec<Arc<dyn Stiffness>>);

impl Stiffness for InSeries {
    fn at(&self, x: f64) -> f64 {
        let soft = |sum, spring: &Arc<dyn Stiffness>| sum + 1.0 / spring.at(x);
        let compliance = self.0.iter().fold(0.0, soft);
        1.0 / compliance
    }

    fn constant(&self) -> Option<f64> {
        let all = self.0.iter().all(|spring| spring.constant().is_some());
        all.then(|| self.at(0.0))
    }
}

/// The two strands of a preloaded toothed belt between its drive pulley and the
/// carriage, one directly and one around the idle pulley.
///
/// With `c` = EA the force for each unit of strain, a strand of length l has the
/// stiffness c/l; both act side by side:
///
/// ```text
/// k(x) = c (1/L₁ + 1/L₂),   L₁ = shortest + x,   L₂ = total − L₁
/// ```
///
/// Least where the strands are equal, 4c/total. Both hold while the belt's preload
/// is not used up. Source: Hace, Jezernik, Šabanović, Proc. IEEE ISIE 2005, 1641–1646
/// (its third strand, between the pulleys, is part of L₂ here).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "crate::stored::StoredStrands",
        into = "crate::stored::StoredStrands"
    )
)]
pub struct BeltStrands {
    pub(crate) specific_stiffness: f64,
    pub(crate) shortest: f64,
    pub(crate) total: f64,
}

impl BeltStrands {
    /// Least length of a strand as a part of both: beyond it a strand is taken as
    /// that long, so that the stiffness has a bound.
    pub const LEAST: f64 = 1e-3;

    /// Strands of `specific_stiffness` = EA (N, force for each unit of strain), of
    /// which the direct one is `shortest` (m) long with the carriage at x = 0, and
    /// both together `total` (m).
    ///
    /// # Errors
    /// [`DriveError::Parameter`] unless the first and the last are finite and above
    /// zero, and `shortest` is between a thousandth and 999 thousandths of `total`.
    pub fn new(specific_stiffness: f64, shortest: f64, total: f64) -> Result<Self, DriveError> {
        positive([("specific_stiffness", specific_stiffness), ("total", total)])?;
        let least = Self::LEAST * total;
        if !(least..=total - least).contains(&shortest) {
            return Err(DriveError::Parameter {
                name: "shortest",
                value: shortest,
                valid: "between 0.001 and 0.999 of total",
            });
        }
        Ok(Self {
            specific_stiffness,
            shortest,
            total,
        })
    }
}

impl Stiffness for BeltStrands {
    fn at(&self, x: f64) -> f64 {
        let least = Self::LEAST * self.total;
        let direct = (self.shortest + x).clamp(least, self.total - least);
        let around = self.total - direct;
        self.specific_stiffness * self.total / (direct * around)
    }
}
