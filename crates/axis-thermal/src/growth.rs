//! Growth by position, and the force of a screw that is held at both ends.
//!
//! All displacements are against the place of the front bearing on the bed, positive away from it;
//! Θ = T − T₀ is the temperature above that of the state that growth is counted from, l the length
//! of the shaft between each bearing and the places 0 and L, α the expansion.
//!
//! ```text
//! one end fixed     δ(x) = α l Θ_front + α ∫₀ˣ Θ dξ                                          (1)
//! both ends fixed   e = α (l Θ_front + ∫₀ᴸ Θ dξ + l Θ_rear) − α_bed Θ_bed (L + 2 l)
//!                   F = e / ((L + 2 l)/(E A) + 2/k_b)                                         (2)
//!                   δ(x) = α l Θ_front + α ∫₀ˣ Θ dξ − F (1/k_b + (l + x)/(E A))               (3)
//! scale             δ(x) = α_scale Θ_scale (x − x_f) + α_bed Θ_bed x_f                        (4)
//! bed               δ(x) = α_bed Θ_bed x                                                      (5)
//! ```
//!
//! A drive that measures at the motor holds the table at x + (1 or 3), one that measures by the
//! scale at x + (4). What is clamped to the bed at x moves by (5).

use crate::model::ThermalModel;
use crate::screw::{ScrewEnds, ThermalScrew};
use crate::state::{BODIES, HeatNode, ThermalState};

/// Growth at a position, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Growth {
    /// Of the screw: by which the table is off with a motor encoder; 0 without a screw.
    pub screw: f64,
    /// Of the scale: by which it is off with the scale.
    pub scale: f64,
    /// Of the bed.
    pub bed: f64,
}

/// The force in a screw that is held at both ends, N.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ThermalForce {
    /// Compression by heat.
    pub compression: f64,
    /// Tension that is left: the pretension less that. Below 0 the screw is compressed.
    pub tension: f64,
}

/// The temperatures of a state above those that growth is counted from.
struct Above<'a> {
    now: &'a ThermalState,
    from: &'a ThermalState,
}

impl Above<'_> {
    fn of(&self, node: HeatNode) -> f64 {
        self.now.of(node) - self.from.of(node)
    }

    /// ∫₀ˣ Θ dξ, K·m; beyond the ends as at the ends.
    fn up_to(&self, screw: &ThermalScrew, x: f64) -> f64 {
        let dx = screw.segment();
        let n = self.now.temperatures.len() - BODIES;
        let at = |i: usize| self.now.screw()[i] - self.from.screw()[i];
        let whole = ((x / dx).max(0.0) as usize).min(n - 1);
        let sum: f64 = (0..whole).map(at).sum();
        sum * dx + at(whole) * (x - whole as f64 * dx)
    }
}

impl ThermalModel {
    /// Growth at the position `x` (m) since the state `from`: the one in which the axis was homed
    /// or calibrated.
    pub fn growth(&self, from: &ThermalState, now: &ThermalState, x: f64) -> Growth {
        let above = Above { now, from };
        let expansion = &self.parameters().expansion;
        let bed = expansion.bed * above.of(HeatNode::Bed);
        let fixed = expansion.scale_fixed_at;
        Growth {
            screw: self.screw_growth(&above, x),
            scale: expansion.scale * above.of(HeatNode::Scale) * (x - fixed) + bed * fixed,
            bed: bed * x,
        }
    }

    /// Force of the screw since `from`; none if it is free to grow, or there is no screw.
    pub fn thermal_force(&self, from: &ThermalState, now: &ThermalState) -> Option<ThermalForce> {
        let screw = self.parameters().screw.as_ref()?;
        let ScrewEnds::BothFixed { pretension, .. } = screw.ends else {
            return None;
        };
        let compression = self.compression(screw, &Above { now, from });
        Some(ThermalForce {
            compression,
            tension: pretension - compression,
        })
    }

    fn screw_growth(&self, above: &Above<'_>, x: f64) -> f64 {
        let Some(screw) = &self.parameters().screw else {
            return 0.0;
        };
        let shaft = screw.shaft * above.of(HeatNode::FrontBearing);
        let free = screw.expansion * (shaft + above.up_to(screw, x));
        match screw.ends {
            ScrewEnds::OneFixed => free,
            ScrewEnds::BothFixed {
                rigidity,
                bearing_stiffness,
                ..
            } => {
                let gives = 1.0 / bearing_stiffness + (screw.shaft + x) / rigidity;
                free - self.compression(screw, above) * gives
            }
        }
    }

    fn compression(&self, screw: &ThermalScrew, above: &Above<'_>) -> f64 {
        let ScrewEnds::BothFixed {
            rigidity,
            bearing_stiffness,
            ..
        } = screw.ends
        else {
            return 0.0;
        };
        let length = screw.length + 2.0 * screw.shaft;
        let ends = above.of(HeatNode::FrontBearing) + above.of(HeatNode::RearBearing);
        let wanted = screw.expansion * (screw.shaft * ends + above.up_to(screw, screw.length));
        let bed = self.parameters().expansion.bed * above.of(HeatNode::Bed) * length;
        (wanted - bed) / (length / rigidity + 2.0 / bearing_stiffness)
    }
}
