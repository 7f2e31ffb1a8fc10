//! Where the law takes energy, and where it can give some back.

use crate::exponential::Exponential;
use crate::law::LuGre;

impl<T: Exponential> LuGre<T> {
    /// The energy stored in the bristles, `σ0 z² / 2`, J.
    #[must_use]
    #[inline]
    pub fn stored_energy(&self, z: T) -> T {
        T::HALF * self.bristle_stiffness() * z * z
    }

    /// `σ2 − σ1 (T_S − T_C) / T_C`, N·m·s/rad. The law is passive from speed
    /// to torque if and only if this is not negative (N. Barabanov and
    /// R. Ortega, "Necessary and sufficient conditions for passivity of the
    /// LuGre friction model", IEEE Trans. Automatic Control 45(4), 2000).
    ///
    /// Why it suffices: with `u = σ0 z sign ω / G`, the power that goes
    /// neither out nor into [`stored_energy`](Self::stored_energy) is
    ///
    /// ```text
    /// |ω| [ G u² − σ1 |ω| u + (σ1 + σ2) |ω| ]
    /// ```
    ///
    /// and `u ≤ T_S / T_C` on the states that can be reached.
    #[must_use]
    pub fn passivity_margin(&self) -> T {
        let p = self.parameters();
        if self.bristle_stiffness() == T::ZERO {
            return p.viscous;
        }
        p.viscous - p.damping * (p.stiction - p.coulomb) / p.coulomb
    }

    /// Whether no motion whatever draws energy from the law; see
    /// [`passivity_margin`](Self::passivity_margin).
    #[must_use]
    pub fn is_passive(&self) -> bool {
        self.passivity_margin() >= T::ZERO
    }

    /// The speed in rad/s up to which the law is passive from every state:
    /// `4 (σ1 + σ2) T_C / σ1²`, from the discriminant of the bracket above
    /// with `G ≥ T_C`; infinite without bristle damping. It is the reason why
    /// Olsson et al. (European Journal of Control 4(3), 1998,
    /// doi 10.1016/S0947-3580(98)70113-X) let `σ1` fall with the speed.
    #[must_use]
    pub fn passive_below(&self) -> T {
        let p = self.parameters();
        if self.bristle_stiffness() == T::ZERO || p.damping == T::ZERO {
            return T::INFINITY;
        }
        T::of(4.0) * (p.damping + p.viscous) * p.coulomb / (p.damping * p.damping)
    }
}
