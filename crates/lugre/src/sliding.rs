//! Small oscillations about steady sliding.

use crate::law::LuGre;

impl LuGre {
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
    /// For `frequency = 0` it is the slope of the steady-state curve,
    /// `G' + σ2`; for fast oscillations `σ2 + σ1 g`, which on the falling side
    /// of the curve is more negative by `σ1 / (σ0 τ)`.
    #[must_use]
    pub fn vibration_damping(&self, speed: f64, frequency: f64) -> f64 {
        let p = self.parameters();
        let speed = speed.abs();
        let x = speed / p.stribeck_speed;
        let level = self.level(speed);
        if level == 0.0 || speed == 0.0 {
            // No bristles; or at rest, where they are a spring σ0 beside σ1.
            let bristle_damping = if level == 0.0 { 0.0 } else { p.damping };
            return p.viscous + bristle_damping;
        }
        // |ω| G'(|ω|) = −2 x² (G − T_C)
        let g = -2.0 * x * x * (level - p.coulomb) / level;
        let relaxation = p.stiffness * speed / level;
        let squares = relaxation * relaxation + frequency * frequency;
        p.viscous + g * (p.stiffness * relaxation + p.damping * frequency * frequency) / squares
    }
}
