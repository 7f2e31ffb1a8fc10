//! Currents of the motor in the rotor's frame.

use crate::parameters::Parameters;

/// The dq equations of a permanent-magnet synchronous motor:
///
/// ```text
/// L_d i_d' = u_d − R i_d + p ω L_q i_q
/// L_q i_q' = u_q − R i_q − p ω (L_d i_d + ψ)
/// T = 1.5 p (ψ i_q + (L_d − L_q) i_d i_q)
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Motor {
    pole_pairs: f64,
    flux: f64,
    resistance: f64,
    inductance: [f64; 2],
}

impl Motor {
    /// The motor of these parameters.
    pub fn new(p: &Parameters) -> Self {
        Self {
            pole_pairs: p.pole_pairs,
            flux: p.flux(),
            resistance: p.resistance,
            inductance: [p.inductance_d, p.inductance_q],
        }
    }

    /// A motor of these numbers: pole pairs (of a linear motor π over the pole pitch, 1/m), flux linkage (Wb),
    /// resistance (Ω) and inductances d, q (H).
    pub fn of(pole_pairs: f64, flux: f64, resistance: f64, inductance: [f64; 2]) -> Self {
        Self {
            pole_pairs,
            flux,
            resistance,
            inductance,
        }
    }

    fn rate(&self, [d, q]: [f64; 2], [ud, uq]: [f64; 2], speed: f64) -> [f64; 2] {
        let (w, [ld, lq]) = (self.pole_pairs * speed, self.inductance);
        [
            (ud - self.resistance * d + w * lq * q) / ld,
            (uq - self.resistance * q - w * (ld * d + self.flux)) / lq,
        ]
    }

    /// Currents d, q after `h` seconds at held voltages and speed, by the classical
    /// Runge–Kutta rule.
    pub fn after(&self, i: [f64; 2], u: [f64; 2], speed: f64, h: f64) -> [f64; 2] {
        let along = |k: [f64; 2], by: f64| [i[0] + by * k[0], i[1] + by * k[1]];
        let k1 = self.rate(i, u, speed);
        let k2 = self.rate(along(k1, 0.5 * h), u, speed);
        let k3 = self.rate(along(k2, 0.5 * h), u, speed);
        let k4 = self.rate(along(k3, h), u, speed);
        let mean = |a: usize| (k1[a] + 2.0 * (k2[a] + k3[a]) + k4[a]) / 6.0;
        [i[0] + h * mean(0), i[1] + h * mean(1)]
    }

    /// Torque, N·m.
    pub fn torque(&self, [d, q]: [f64; 2]) -> f64 {
        let reluctance = self.inductance[0] - self.inductance[1];
        1.5 * self.pole_pairs * (self.flux * q + reluctance * d * q)
    }
}
