//! The keys of `[thermal]`. Defaults are those of `axis_thermal`, all assumed (docs/heat.md).

use crate::part::units::{
    EXPANSION, HEAT_CAPACITY, HEAT_TRANSFER, LENGTH, MOTOR_CONSTANT, PER_KELVIN, SPECIFIC_HEAT,
    TEMPERATURE, THERMAL_CONDUCTANCE, THERMAL_CONDUCTIVITY,
};
use crate::part::{Key, count, number, quantity};

const fn capacity(name: &'static str) -> Key {
    quantity(name, &HEAT_CAPACITY, 1e-3, 1e9).optional()
}

const fn conductance(name: &'static str) -> Key {
    quantity(name, &THERMAL_CONDUCTANCE, 0.0, 1e6).optional()
}

const fn share(name: &'static str) -> Key {
    number(name, 0.0, 1.0).optional()
}

const fn change(name: &'static str, most: f64) -> Key {
    quantity(name, &PER_KELVIN, -most, most).optional()
}

/// All keys of `[thermal]`. Each may be left out.
pub(crate) const THERMAL_KEYS: &[Key] = &[
    quantity("reference_temperature", &TEMPERATURE, -100.0, 200.0).optional(),
    // Losses.
    quantity("motor_constant", &MOTOR_CONSTANT, 1e-6, 1e6).optional(),
    quantity("resistance_rise", &PER_KELVIN, 0.0, 0.1).optional(),
    share("nut_dry_share"),
    share("nut_viscous_share"),
    share("bearings_dry_share"),
    share("bearings_viscous_share"),
    share("front_of_bearings"),
    share("nut_into_screw"),
    share("guide_into_table"),
    // Friction and temperature.
    change("viscous_fall", 0.2),
    change("dry_fall", 0.2),
    change("preload_rise", 0.5),
    // Bodies.
    capacity("winding_capacity"),
    capacity("housing_capacity"),
    conductance("housing_to_air"),
    capacity("front_bearing_capacity"),
    capacity("rear_bearing_capacity"),
    capacity("nut_capacity"),
    conductance("nut_to_air"),
    capacity("table_capacity"),
    conductance("table_to_air"),
    capacity("bed_capacity"),
    conductance("bed_to_air"),
    capacity("scale_capacity"),
    conductance("scale_to_air"),
    // Between them.
    conductance("winding_to_housing"),
    conductance("housing_to_front_bearing"),
    conductance("housing_to_table"),
    conductance("housing_to_bed"),
    conductance("front_bearing_to_bed"),
    conductance("rear_bearing_to_bed"),
    conductance("front_bearing_to_screw"),
    conductance("rear_bearing_to_screw"),
    conductance("nut_to_screw"),
    conductance("nut_to_table"),
    conductance("table_to_bed"),
    conductance("scale_to_bed"),
    // Screw.
    quantity("screw_diameter", &LENGTH, 1e-3, 1.0).optional(),
    quantity("screw_specific_heat", &SPECIFIC_HEAT, 1.0, 1e5).optional(),
    quantity("screw_conductivity", &THERMAL_CONDUCTIVITY, 1e-3, 1e4).optional(),
    quantity("screw_expansion", &EXPANSION, 0.0, 1e-4).optional(),
    quantity("screw_still_air", &HEAT_TRANSFER, 0.0, 1e4).optional(),
    number("screw_turning_air", 0.0, 100.0).optional(),
    quantity("screw_shaft", &LENGTH, 0.0, 100.0).optional(),
    quantity("screw_nut_length", &LENGTH, 0.0, 10.0).optional(),
    quantity("screw_pretension", &crate::part::units::FORCE, 0.0, 1e8).optional(),
    count("screw_segments", 2, 400).optional(),
    // What positions are measured by.
    quantity("scale_expansion", &EXPANSION, -1e-4, 1e-4).optional(),
    quantity("scale_fixed_at", &LENGTH, -1e3, 1e3).optional(),
    quantity("bed_expansion", &EXPANSION, -1e-4, 1e-4).optional(),
];

/// Whether a key is about what only an axis with a screw has.
pub(crate) fn is_of_screws(name: &str) -> bool {
    ["screw", "nut", "bearing", "preload"]
        .iter()
        .any(|part| name.contains(part))
}
