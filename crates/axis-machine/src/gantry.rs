//! Two drives that carry one beam.

use crate::error::MachineError;

/// What holds the two ends of a beam together: its guides' and its own stiffness against skew, as a spring between the ends.
///
/// Each drive has the axis file of its own half: its motor, screw or rack, and its share of the beam's mass. With q₁ and q₂
/// the ends' positions, the force between them is K (q₁ − q₂) + C (q̇₁ − q̇₂); a yaw stiffness K_ψ (N·m/rad) over a span L is
/// K = K_ψ/L².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GantryBeam {
    /// Stiffness K against the ends' difference, N/m.
    pub stiffness: f64,
    /// Damping C against its rate, N·s/m.
    pub damping: f64,
    /// Where the tool is between the ends: 0 at the first, 1 at the second.
    pub tool: f64,
}

impl Default for GantryBeam {
    /// 1e7 N/m, 1e4 N·s/m, the tool in the middle.
    fn default() -> Self {
        Self {
            stiffness: 1e7,
            damping: 1e4,
            tool: 0.5,
        }
    }
}

/// Greatest product of the skew's natural frequency and the control period: the force is held for a period.
const MOST_PHASE: f64 = 0.5;

impl GantryBeam {
    /// Greatest stiffness (N/m) and damping (N·s/m) for loads of `masses` (kg) and a control period (s).
    pub(crate) fn most(masses: [f64; 2], period: f64) -> [f64; 2] {
        let inverse: f64 = masses.iter().map(|m| 1.0 / m).sum();
        let stiffness = (MOST_PHASE / period).powi(2) / inverse;
        [stiffness, MOST_PHASE / (period * inverse)]
    }

    /// Checks it for loads of `masses` (kg) and a control period (s).
    pub(crate) fn check(
        &self,
        axis: usize,
        masses: [f64; 2],
        period: f64,
    ) -> Result<(), MachineError> {
        let refuse = |what, value, unit, valid| {
            Err(MachineError::Invalid {
                what,
                axis: axis + 1,
                value,
                unit,
                valid,
            })
        };
        let [most, most_damping] = Self::most(masses, period);
        // Each false for a NaN too.
        if !(self.stiffness >= 0.0 && self.stiffness <= most) {
            let valid = format!("from 0 to {most:.3e} N/m at this mass and control period");
            return refuse(
                "the stiffness of the beam against skew",
                self.stiffness,
                "N/m",
                valid,
            );
        }
        if !(self.damping >= 0.0 && self.damping <= most_damping) {
            let valid =
                format!("from 0 to {most_damping:.3e} N·s/m at this mass and control period");
            return refuse(
                "the damping of the beam against skew",
                self.damping,
                "N·s/m",
                valid,
            );
        }
        if !(self.tool >= 0.0 && self.tool <= 1.0) {
            let valid = "from 0 (the first end) to 1 (the second)".to_owned();
            return refuse("the place of the tool on the beam", self.tool, "", valid);
        }
        Ok(())
    }

    /// Force on the first end, against positive motion, N, in the middle of the coming period; on the second its negative.
    ///
    /// A spring force taken at the begin of a period and held for it adds energy: it is as if it came half a period late. Taken at
    /// q + q̇ T/2 the map of a period has determinant 1, as the spring itself.
    pub(crate) fn force(&self, positions: [f64; 2], speeds: [f64; 2], period: f64) -> f64 {
        let rate = speeds[0] - speeds[1];
        self.stiffness * (positions[0] - positions[1] + 0.5 * period * rate) + self.damping * rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two free masses on the beam's spring keep the energy and the frequency of the closed form.
    #[test]
    fn a_force_held_for_a_period_takes_nothing_and_gives_nothing() {
        let (masses, period) = ([200.0, 300.0], 1e-4);
        let beam = GantryBeam {
            stiffness: 1e8,
            damping: 0.0,
            tool: 0.5,
        };
        beam.check(0, masses, period).unwrap();
        let (mut x, mut v) = ([1e-5, 0.0], [0.0; 2]);
        let (mut most, mut crossings) = (0.0_f64, Vec::new());
        for k in 0..50_000 {
            let before = x[0] - x[1];
            let force = beam.force(x, v, period);
            for (end, sign) in [(0, -1.0), (1, 1.0)] {
                let a = sign * force / masses[end];
                x[end] += period * v[end] + 0.5 * period * period * a;
                v[end] += period * a;
            }
            let after = x[0] - x[1];
            if before < 0.0 && after >= 0.0 {
                crossings.push(f64::from(k) + before / (before - after));
            }
            if k > 40_000 {
                most = most.max(after.abs());
            }
        }
        // Measured: 4e-12 of 1e-5 (sampling of the peak), and a frequency 0.029 % above that of the spring, (ωT)²/24 = 0.035 %.
        assert!((most / 1e-5 - 1.0).abs() < 1e-3, "{most}");
        let turns = (crossings.len() - 1) as f64;
        let time = period * (crossings[crossings.len() - 1] - crossings[0]);
        let omega = (1e8_f64 * (1.0 / 200.0 + 1.0 / 300.0)).sqrt();
        let share = std::f64::consts::TAU * turns / time / omega - 1.0;
        assert!(share.abs() < 1e-3, "{share}");
    }

    #[test]
    fn a_beam_too_stiff_for_the_period_is_refused() {
        let check = |beam: GantryBeam| {
            beam.check(1, [100.0, 100.0], 1e-3)
                .map_err(|e| e.to_string())
        };
        let text = check(GantryBeam {
            stiffness: 1e8,
            ..GantryBeam::default()
        })
        .unwrap_err();
        assert!(
            text.contains("axis 2") && text.contains("1.250e7 N/m"),
            "{text}"
        );
        for bad in [f64::NAN, f64::INFINITY, -1.0] {
            check(GantryBeam {
                damping: bad,
                ..GantryBeam::default()
            })
            .unwrap_err();
            check(GantryBeam {
                tool: bad,
                ..GantryBeam::default()
            })
            .unwrap_err();
            check(GantryBeam {
                stiffness: bad,
                ..GantryBeam::default()
            })
            .unwrap_err();
        }
    }
}
