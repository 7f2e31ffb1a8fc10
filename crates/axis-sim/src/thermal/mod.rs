//! The axis' heat: its thermal model, and the losses of a motion that repeats itself.
//!
//! What a file's `[thermal]` leaves out is assumed (`axis_thermal::ThermalParameters`, docs/heat.md).
//! A screw gives heat and growth by place; of other mechanisms winding, carriage, bed and scale are
//! followed.

mod keys;
mod losses;

pub use losses::LossModel;

pub(crate) use keys::{THERMAL_KEYS, is_of_screws};

use axis_thermal::{
    ScrewEnds, TemperatureLaw, ThermalError, ThermalModel, ThermalParameters, ThermalScrew,
};

use crate::axis::Axis;
use crate::mechanism::{Freedom, ScrewShape};
use crate::part::{Role, Values};

/// Heat capacity of a table for each kg of the load, J/(kg·K): half of that of steel and cast iron,
/// as half of a table takes part within an hour; assumed.
const TABLE_SPECIFIC_HEAT: f64 = 230.0;

impl Axis {
    /// The thermal model of this axis: the numbers of the file's `[thermal]`, the screw of its
    /// mechanism, the resistance of its motor; the rest is assumed.
    ///
    /// # Errors
    /// [`ThermalError::Invalid`] if numbers contradict each other.
    pub fn thermal_model(&self) -> Result<ThermalModel, ThermalError> {
        ThermalModel::new(self.thermal_parameters())
    }

    /// How many of the thermal model's numbers the file states.
    pub fn thermal_keys_stated(&self) -> usize {
        let stated = |name: &&str| {
            self.thermal.optional(name).is_some() || self.thermal.optional_count(name).is_some()
        };
        THERMAL_KEYS
            .iter()
            .map(|key| key.name)
            .filter(|name| stated(name))
            .count()
    }

    /// The numbers of [`Axis::thermal_model`].
    pub fn thermal_parameters(&self) -> ThermalParameters {
        let v = &self.thermal;
        let mut p = match (self.mechanism.screw(), self.mechanism.motor_freedom()) {
            (Some(shape), _) => ThermalParameters {
                screw: Some(screw(v, &shape)),
                ..ThermalParameters::default()
            },
            (None, Freedom::Linear) => ThermalParameters::linear_motor(),
            (None, Freedom::Rotary) => ThermalParameters::without_screw(),
        };
        if self.freedom() == Freedom::Linear {
            p.bodies.table.capacity = TABLE_SPECIFIC_HEAT * self.mechanism.load_inertia();
        }
        if let Some(resistance) = self.actuator.value(Role::Resistance) {
            // P = 1.5 R i_q², T = K_t i_q.
            let per_current = self.torque_constant();
            p.winding.per_torque_squared = 1.5 * resistance / (per_current * per_current);
        }
        if let Some(constant) = v.optional("motor_constant") {
            p.winding.per_torque_squared = 1.0 / (constant * constant);
        }
        stated(v, &mut p);
        p
    }
}

fn screw(v: &Values, shape: &ScrewShape) -> ThermalScrew {
    let assumed = ThermalScrew::default();
    let mut air = assumed.air;
    air.still = v.or("screw_still_air", air.still);
    air.turning = v.or("screw_turning_air", air.turning);
    let segments = v.optional_count("screw_segments").map(|n| n as usize);
    ThermalScrew {
        length: shape.length,
        diameter: v.or("screw_diameter", shape.diameter),
        density: shape.density,
        specific_heat: v.or("screw_specific_heat", assumed.specific_heat),
        conductivity: v.or("screw_conductivity", assumed.conductivity),
        expansion: v.or("screw_expansion", assumed.expansion),
        shaft: v.or("screw_shaft", assumed.shaft),
        nut_length: v.or("screw_nut_length", assumed.nut_length.min(shape.length)),
        segments: segments.unwrap_or(assumed.segments),
        air,
        ends: match shape.held_at_both_ends {
            None => ScrewEnds::OneFixed,
            Some(bearing_stiffness) => ScrewEnds::BothFixed {
                rigidity: shape.rigidity,
                bearing_stiffness,
                pretension: v.or("screw_pretension", 0.0),
            },
        },
    }
}

/// What the file states, besides the screw.
fn stated(v: &Values, p: &mut ThermalParameters) {
    let set = |name: &str, to: &mut f64| *to = v.or(name, *to);
    set("reference_temperature", &mut p.reference_temperature);
    set("resistance_rise", &mut p.winding.resistance_per_kelvin);
    let s = &mut p.shares;
    set("nut_dry_share", &mut s.nut.dry);
    set("nut_viscous_share", &mut s.nut.viscous);
    set("bearings_dry_share", &mut s.bearings.dry);
    set("bearings_viscous_share", &mut s.bearings.viscous);
    set("front_of_bearings", &mut s.front_of_bearings);
    set("nut_into_screw", &mut s.nut_into_screw);
    set("guide_into_table", &mut s.guide_into_table);
    if let Some(per_kelvin) = v.optional("viscous_fall") {
        p.friction.viscous = TemperatureLaw::Exponential { per_kelvin };
    }
    if let Some(per_kelvin) = v.optional("dry_fall") {
        p.friction.dry = TemperatureLaw::Linear { per_kelvin };
    }
    set("preload_rise", &mut p.friction.preload_per_kelvin);
    let b = &mut p.bodies;
    set("winding_capacity", &mut b.winding.capacity);
    set("housing_capacity", &mut b.housing.capacity);
    set("housing_to_air", &mut b.housing.to_air);
    set("front_bearing_capacity", &mut b.front_bearing.capacity);
    set("rear_bearing_capacity", &mut b.rear_bearing.capacity);
    set("nut_capacity", &mut b.nut.capacity);
    set("nut_to_air", &mut b.nut.to_air);
    set("table_capacity", &mut b.table.capacity);
    set("table_to_air", &mut b.table.to_air);
    set("bed_capacity", &mut b.bed.capacity);
    set("bed_to_air", &mut b.bed.to_air);
    set("scale_capacity", &mut b.scale.capacity);
    set("scale_to_air", &mut b.scale.to_air);
    let l = &mut p.links;
    set("winding_to_housing", &mut l.winding_to_housing);
    set("housing_to_front_bearing", &mut l.housing_to_front_bearing);
    set("housing_to_table", &mut l.housing_to_table);
    set("housing_to_bed", &mut l.housing_to_bed);
    set("front_bearing_to_bed", &mut l.front_bearing_to_bed);
    set("rear_bearing_to_bed", &mut l.rear_bearing_to_bed);
    set("front_bearing_to_screw", &mut l.front_bearing_to_screw);
    set("rear_bearing_to_screw", &mut l.rear_bearing_to_screw);
    set("nut_to_screw", &mut l.nut_to_screw);
    set("nut_to_table", &mut l.nut_to_table);
    set("table_to_bed", &mut l.table_to_bed);
    set("scale_to_bed", &mut l.scale_to_bed);
    let e = &mut p.expansion;
    set("scale_expansion", &mut e.scale);
    set("scale_fixed_at", &mut e.scale_fixed_at);
    set("bed_expansion", &mut e.bed);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::part::Kind;

    const AXIS: &str = include_str!("../../../../data/axes/screw-datasheet.toml");
    const PAGE: &str = include_str!("../../../../docs/heat.md");

    /// A key that does nothing would be a slip of its name.
    #[test]
    fn every_key_changes_the_model_and_stands_in_the_page() {
        let text = AXIS.replace("fixed-free", "fixed-fixed");
        let axis = Axis::parse("axis.toml", &text).unwrap();
        let before = axis.thermal_parameters();
        for key in THERMAL_KEYS {
            let mut other = axis.clone();
            match key.kind {
                Kind::Count(..) => other.thermal.set_count(key.name, 7),
                _ => other.thermal.set(key.name, 0.0123),
            }
            assert_ne!(other.thermal_parameters(), before, "{}", key.name);
            assert!(PAGE.contains(&format!("`{}`", key.name)), "{}", key.name);
        }
    }
}
