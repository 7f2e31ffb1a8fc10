//! The contact law of a nut or another transmission, and the errors of its kinematics.

use crate::DriveError;

/// What the kinematics of a screw and its nut, or of another transmission, have
/// beyond `load travel = r · rotation`, at the end of a step. The default is none.
///
/// The nut (or the transmission, as seen at its load) is compressed by `δ = r θ + offset − y`, at the rate
/// `δ̇ = r θ̇ + offset_rate − ẏ`. Without a gap it is preloaded, both flanks
/// touch, and its force on the load is `k δ + βk δ̇`, of either sign. With a
/// gap one flank at most touches, and it never pulls:
///
/// ```text
/// δ >  gap/2:  max(0, k (δ − gap/2) + βk δ̇)
/// δ < −gap/2:  min(0, k (δ + gap/2) + βk δ̇)
/// otherwise:   0
/// ```
///
/// Where a flank arrives at the speed δ̇ this jumps by βk δ̇; just there the
/// force may have any value between. The reaction F on the rotation keeps the
/// lever r. An offset that changes with the rotation θ reacts on it by the torque
/// −F ∂offset/∂θ besides (power is the same on both sides), which the caller adds to that of the motor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NutErrors {
    offset: f64,
    offset_rate: f64,
    gap: f64,
}

impl NutErrors {
    /// Displacement `offset` (m) that is added to what the rotation commands, its
    /// rate `offset_rate` (m/s), and the free travel `gap` between the flanks (m).
    ///
    /// # Errors
    /// [`DriveError::Parameter`] for what is not finite, and a gap below zero.
    #[inline]
    pub fn new(offset: f64, offset_rate: f64, gap: f64) -> Result<Self, DriveError> {
        let refuse = |name, value, valid| Err(DriveError::Parameter { name, value, valid });
        if !offset.is_finite() {
            return refuse("offset", offset, "finite");
        }
        if !offset_rate.is_finite() {
            return refuse("offset_rate", offset_rate, "finite");
        }
        if !(gap.is_finite() && gap >= 0.0) {
            return refuse("gap", gap, "finite and not negative");
        }
        Ok(Self {
            offset,
            offset_rate,
            gap,
        })
    }

    /// Displacement that is added to what the rotation commands, m.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// Its rate, m/s.
    pub fn offset_rate(&self) -> f64 {
        self.offset_rate
    }

    /// Free travel between the flanks, m.
    pub fn gap(&self) -> f64 {
        self.gap
    }

    /// How far the nut is strained where `r θ − y` is `compression` (m): δ as far as
    /// it is beyond half the gap.
    #[inline]
    pub(crate) fn strain(&self, compression: f64) -> f64 {
        let delta = compression + self.offset;
        let beyond = delta.abs() - 0.5 * self.gap;
        if beyond <= 0.0 {
            return 0.0;
        }
        beyond.copysign(delta)
    }
}

/// The contact at the end of a step, with what a newton of it gives way there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// k, N/m.
    pub stiffness: f64,
    /// βk, N·s/m.
    pub damping: f64,
    /// Compression that a newton of nut force takes away, m/N.
    pub travel: f64,
    /// Rate of compression that it takes away, (m/s)/N.
    pub speed: f64,
    /// Half the gap, m.
    pub half_gap: f64,
}

impl Contact {
    /// The force on the load, N, where the nut would be compressed by
    /// `compression` (m) at `rate` (m/s) if there were none: [`NutErrors`]' law on
    /// what is left of the two.
    #[inline]
    pub fn force(&self, compression: f64, rate: f64) -> f64 {
        let stiff = 1.0 + self.stiffness * self.travel + self.damping * self.speed;
        if self.half_gap == 0.0 {
            return (self.stiffness * compression + self.damping * rate) / stiff;
        }
        let side = compression.signum();
        let beyond = side * compression - self.half_gap;
        if beyond <= 0.0 {
            return 0.0;
        }
        // No more than brings the flank back to where it just touches.
        let pressed = (self.stiffness * beyond + self.damping * side * rate) / stiff;
        let most = beyond / self.travel;
        let force = if most < pressed { most } else { pressed };
        if force < 0.0 { 0.0 } else { side * force }
    }

    /// The side, −1 or 1, of the flank that spring and damper press at the same
    /// compression and rate; 0 in the gap, and where [`Contact::force`] is one that
    /// only keeps the flank at its edge, or from pulling.
    #[inline]
    pub fn flank(&self, compression: f64, rate: f64) -> f64 {
        let stiff = 1.0 + self.stiffness * self.travel + self.damping * self.speed;
        let side = compression.signum();
        let beyond = side * compression - self.half_gap;
        let pressed = (self.stiffness * beyond + self.damping * side * rate) / stiff;
        if beyond > 0.0 && pressed > 0.0 && pressed < beyond / self.travel {
            side
        } else {
            0.0
        }
    }
}

#[cfg(test)]
pub(super) mod tests;
