//! Small oscillations about steady sliding.

use crate::exponential::Exponential;
use crate::law::LuGre;

impl<T: Exponential> LuGre<T> {
    /// The damping, N·m·s/rad, that a small oscillation of the speed with the
    /// angular frequency `frequency` (rad/s) about the steady speed `speed`
    /// meets: the real part of `δT_f/δω`. Negative: friction feeds it.
    ///
    /// Equations (1) and (3), linearised about `z = G sign ω / σ0`, give
    ///
    /// ```text
    /// δT_f/δω = σ2 + g (σ0 + i Ω σ1) / (1/τ + i Ω),   g = |ω| G'(|ω|)/G,   1/τ = σ0 |ω| / G
    /// ```
    ///
    /// with the real part
    ///
    /// ```text
    /// σ2 + G'(|ω|) [ 1 + κ (Ω τ)² ] / [ 1 + (Ω τ)² ],   κ = σ1 / (σ0 τ) = σ1 |ω| / G
    /// ```
    ///
    /// So slow oscillations meet the slope of the steady-state curve,
    /// `σ2 + G'`, and fast ones `σ2 + κ G'`: the falling of the curve counts
    /// κ times. That is more than once where `σ1 |ω| > G`, and less below.
    ///
    /// At rest there is no steady sliding: the bristles are a spring beside
    /// their damping, and the result is `σ1 + σ2`.
    #[must_use]
    pub fn vibration_damping(&self, speed: T, frequency: T) -> T {
        if speed.is_nan() || frequency.is_nan() {
            return T::NAN;
        }
        let p = self.parameters();
        let speed = speed.abs();
        let level = self.level(speed);
        if level == T::ZERO || speed == T::ZERO {
            let bristle_damping = if level == T::ZERO { T::ZERO } else { p.damping };
            return p.viscous + bristle_damping;
        }
        // G'(|ω|) = −2 |ω| (G − T_C) / Ω_S²
        let slope = -T::TWO * (speed / p.stribeck_speed) * ((level - p.coulomb) / p.stribeck_speed);
        if slope == T::ZERO {
            return p.viscous;
        }
        // The share 1/(1 + (Ω τ)²) of the slow limit, without overflow.
        let turns = frequency * (level / p.stiffness) / speed;
        let slow = T::ONE / (T::ONE + turns * turns);
        let kappa = p.damping * speed / level;
        p.viscous + slope * (slow + kappa * (T::ONE - slow))
    }
}
