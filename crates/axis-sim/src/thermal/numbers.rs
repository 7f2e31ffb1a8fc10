//! The numbers of `[thermal]` beside what they are in the thermal model: one line each.

use axis_thermal::{TemperatureLaw, ThermalParameters, ThermalScrew};

/// Where a number stands in the model; none if the model has no such part.
pub(super) type Number = fn(&mut ThermalParameters) -> Option<&mut f64>;

macro_rules! numbers {
    ($($name:literal: $($at:ident).+;)+ screw $($of_screw:literal: $($there:ident).+;)+) => {
        /// All that one key states and one number of the model is.
        pub(super) const NUMBERS: &[(&str, Number)] = &[
            ("viscous_fall", |p| exponential(&mut p.friction.viscous)),
            ("dry_fall", |p| linear(&mut p.friction.dry)),
            $(($name, |p| Some(&mut p.$($at).+)),)+
            $(($of_screw, |p| screw(p).map(|screw| &mut screw.$($there).+)),)+
        ];
    };
}

numbers! {
    "reference_temperature": reference_temperature;
    "resistance_rise": winding.resistance_per_kelvin;
    "nut_dry_share": shares.nut.dry;
    "nut_viscous_share": shares.nut.viscous;
    "bearings_dry_share": shares.bearings.dry;
    "bearings_viscous_share": shares.bearings.viscous;
    "front_of_bearings": shares.front_of_bearings;
    "nut_into_screw": shares.nut_into_screw;
    "guide_into_table": shares.guide_into_table;
    "preload_rise": friction.preload_per_kelvin;
    "winding_capacity": bodies.winding.capacity;
    "housing_capacity": bodies.housing.capacity;
    "housing_to_air": bodies.housing.to_air;
    "front_bearing_capacity": bodies.front_bearing.capacity;
    "rear_bearing_capacity": bodies.rear_bearing.capacity;
    "nut_capacity": bodies.nut.capacity;
    "nut_to_air": bodies.nut.to_air;
    "table_capacity": bodies.table.capacity;
    "table_to_air": bodies.table.to_air;
    "bed_capacity": bodies.bed.capacity;
    "bed_to_air": bodies.bed.to_air;
    "scale_capacity": bodies.scale.capacity;
    "scale_to_air": bodies.scale.to_air;
    "winding_to_housing": links.winding_to_housing;
    "housing_to_front_bearing": links.housing_to_front_bearing;
    "housing_to_table": links.housing_to_table;
    "housing_to_bed": links.housing_to_bed;
    "front_bearing_to_bed": links.front_bearing_to_bed;
    "rear_bearing_to_bed": links.rear_bearing_to_bed;
    "front_bearing_to_screw": links.front_bearing_to_screw;
    "rear_bearing_to_screw": links.rear_bearing_to_screw;
    "nut_to_screw": links.nut_to_screw;
    "nut_to_table": links.nut_to_table;
    "table_to_bed": links.table_to_bed;
    "scale_to_bed": links.scale_to_bed;
    "scale_expansion": expansion.scale;
    "scale_fixed_at": expansion.scale_fixed_at;
    "bed_expansion": expansion.bed;
    screw
    "screw_diameter": diameter;
    "screw_specific_heat": specific_heat;
    "screw_conductivity": conductivity;
    "screw_expansion": expansion;
    "screw_still_air": air.still;
    "screw_turning_air": air.turning;
    "screw_shaft": shaft;
    "screw_nut_length": nut_length;
}

fn screw(p: &mut ThermalParameters) -> Option<&mut ThermalScrew> {
    p.screw.as_mut()
}

/// The coefficient of a law exp(−c ΔT), 1/K; a law of another kind becomes one, with c = 0.
fn exponential(law: &mut TemperatureLaw) -> Option<&mut f64> {
    if !matches!(law, TemperatureLaw::Exponential { .. }) {
        *law = TemperatureLaw::Exponential { per_kelvin: 0.0 };
    }
    coefficient(law)
}

/// The same of a law 1 − c ΔT.
fn linear(law: &mut TemperatureLaw) -> Option<&mut f64> {
    if !matches!(law, TemperatureLaw::Linear { .. }) {
        *law = TemperatureLaw::Linear { per_kelvin: 0.0 };
    }
    coefficient(law)
}

fn coefficient(law: &mut TemperatureLaw) -> Option<&mut f64> {
    match law {
        TemperatureLaw::Exponential { per_kelvin } | TemperatureLaw::Linear { per_kelvin } => {
            Some(per_kelvin)
        }
        TemperatureLaw::Constant => None,
    }
}
