//! LuGre friction by the implicit midpoint rule.

use crate::parameters::Parameters;

/// The paper's friction (Canudas de Wit, Olsson, Åström, Lischinsky, IEEE Trans. Automat.
/// Contr. 40 (1995) 419–425, doi:10.1109/9.376053) at the table's speed as one of the screw:
///
/// ```text
/// z' = ω − σ0 |ω| z / G(ω),   G = T_C + (T_S − T_C) exp(−(ω/Ω_S)²),   T = σ0 z + σ1 z' + σ2 ω
/// ```
#[derive(Clone, Copy, Debug)]
pub struct LuGre {
    coulomb: f64,
    stiction: f64,
    stribeck_speed: f64,
    stiffness: f64,
    damping: f64,
    viscous: f64,
    /// r, m/rad.
    travel: f64,
}

impl LuGre {
    /// The law of these parameters.
    pub fn new(p: &Parameters) -> Self {
        Self {
            coulomb: p.coulomb,
            stiction: p.stiction,
            stribeck_speed: p.stribeck_speed,
            stiffness: p.bristle_stiffness,
            damping: p.bristle_damping,
            viscous: p.viscous,
            travel: p.travel(),
        }
    }

    /// Bristle in the middle of a step of 2 `half` seconds that begins with `z`, and the
    /// force on the table there, N; `speed` is the table's in the middle, m/s.
    pub fn middle(&self, z: f64, speed: f64, half: f64) -> (f64, f64) {
        let w = speed / self.travel;
        let ratio = w / self.stribeck_speed;
        let level = self.coulomb + (self.stiction - self.coulomb) * (-ratio * ratio).exp();
        // z_m = z + half (ω − σ0 |ω| z_m / G), solved for z_m.
        let middle = (z + half * w) / (1.0 + half * self.stiffness * w.abs() / level);
        let rate = (middle - z) / half;
        let torque = self.stiffness * middle + self.damping * rate + self.viscous * w;
        (middle, torque / self.travel)
    }
}
