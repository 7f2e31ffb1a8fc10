//! The keys of `[rating]`: what the data sheets of the axis' parts allow.

use axis_rating::screw::{BUCKLING_SHARE, CRITICAL_SPEED_SHARE};

use crate::part::units::{
    BELT_FORCE, CAPACITANCE, DN_VALUE, ENERGY, FORCE, LENGTH, LIFE, MOTOR_SPEED, MOTOR_TORQUE,
    POWER, RESISTANCE, TEMPERATURE, THERMAL_RESISTANCE, TIME, VOLTAGE,
};
use crate::part::{Key, number, quantity, tables, word};

/// Temperature of the surroundings where the file does not say, °C: that of most data sheets of motors.
pub(super) const AMBIENT: f64 = 40.0;

const fn force(name: &'static str) -> Key {
    quantity(name, &FORCE, 1e-3, 1e9).optional()
}

const fn length(name: &'static str) -> Key {
    quantity(name, &LENGTH, 1e-4, 100.0).optional()
}

/// Keys of `[rating]` itself. Each may be left out.
pub(crate) const RATING_KEYS: &[Key] = &[
    // Motor and drive.
    quantity("continuous_torque", &MOTOR_TORQUE, 1e-6, 1e8).optional(),
    quantity("peak_torque", &MOTOR_TORQUE, 1e-6, 1e8).optional(),
    quantity("max_speed", &MOTOR_SPEED, 1e-6, 1e5).optional(),
    number("inertia_ratio_limit", 1e-3, 1e6).optional(),
    quantity("winding_thermal_resistance", &THERMAL_RESISTANCE, 1e-6, 1e4).optional(),
    quantity("winding_time_constant", &TIME, 1e-3, 1e6).optional(),
    quantity("winding_temperature_limit", &TEMPERATURE, -50.0, 500.0).optional(),
    quantity("ambient_temperature", &TEMPERATURE, -100.0, 200.0).or(AMBIENT),
    quantity("dc_link_limit", &VOLTAGE, 1.0, 1e5).optional(),
    quantity("dc_link_capacitance", &CAPACITANCE, 0.0, 100.0).optional(),
    quantity("brake_on_voltage", &VOLTAGE, 1.0, 1e5).optional(),
    quantity("brake_energy", &ENERGY, 0.0, 1e9).optional(),
    quantity("brake_power", &POWER, 1e-3, 1e7).optional(),
    quantity("brake_resistance", &RESISTANCE, 1e-3, 1e5).optional(),
    // Life and safety of all that rolls.
    quantity("required_life", &LIFE, 1.0, 1e7).optional(),
    number("load_factor", 0.1, 10.0).or(1.0),
    number("static_safety", 0.1, 100.0).or(1.0),
    // Guides.
    force("guide_load"),
    force("guide_dynamic_load_rating"),
    force("guide_static_load_rating"),
    word("guide_base", &["50-km", "100-km"]).optional(),
    word("guide_element", &["ball", "roller"]).optional(),
    // Screw, nut and bearings.
    word(
        "screw_mounting",
        &[
            "fixed-fixed",
            "fixed-supported",
            "supported-supported",
            "fixed-free",
        ],
    )
    .optional(),
    length("screw_root_diameter"),
    length("screw_length"),
    length("screw_buckling_length"),
    number("screw_speed_share", 0.01, 1.0).or(CRITICAL_SPEED_SHARE),
    number("screw_buckling_share", 0.01, 1.0).or(BUCKLING_SHARE),
    length("screw_ball_circle"),
    quantity("screw_dn_limit", &DN_VALUE, 1.0, 1e7).optional(),
    force("nut_dynamic_load_rating"),
    force("nut_static_load_rating"),
    quantity("nut_preload", &FORCE, 0.0, 1e8).or(0.0),
    force("bearing_dynamic_load_rating"),
    force("bearing_static_load_rating"),
    quantity("bearing_preload", &FORCE, 0.0, 1e8).or(0.0),
    word("bearing_element", &["ball", "roller"]).optional(),
    quantity("bearing_radial_load", &FORCE, 0.0, 1e8).or(0.0),
    number("bearing_radial_factor", 0.0, 100.0).or(1.0),
    number("bearing_axial_factor", 0.0, 100.0).or(1.0),
    // Belt.
    quantity("belt_tooth_force", &BELT_FORCE, 1.0, 1e8).optional(),
    quantity("belt_width", &LENGTH, 1e-3, 1.0).optional(),
    number("belt_teeth_in_mesh", 1.0, 1000.0).optional(),
    quantity("belt_pretension", &FORCE, 0.0, 1e8).or(0.0),
    force("belt_cord_limit"),
];

/// Keys of each point of the motor's curves.
const CURVE: &[Key] = &[
    quantity("speed", &MOTOR_SPEED, 0.0, 1e5),
    quantity("continuous_torque", &MOTOR_TORQUE, 0.0, 1e8).optional(),
    quantity("peak_torque", &MOTOR_TORQUE, 0.0, 1e8).optional(),
];

/// Name of the motor's curves.
pub(crate) const MOTOR_CURVE: &str = "motor_curve";

/// All keys of the table.
pub(crate) fn rating_keys() -> Vec<Key> {
    let curve = [tables(MOTOR_CURVE, CURVE).optional()];
    RATING_KEYS.iter().cloned().chain(curve).collect()
}

/// What of an axis a key is about, if not all have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum About {
    Screw,
    Belt,
    Guide,
}

/// What a key is about.
pub(crate) fn about(name: &str) -> Option<About> {
    let begins = |with: &str| name.starts_with(with);
    match name {
        _ if begins("screw_") || begins("nut_") || begins("bearing_") => Some(About::Screw),
        _ if begins("belt_") => Some(About::Belt),
        _ if begins("guide_") => Some(About::Guide),
        _ => None,
    }
}

impl About {
    /// What it is, for messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Screw => "a screw",
            Self::Belt => "a belt",
            Self::Guide => "guides along a line",
        }
    }
}

/// Whether a unit of a motor's torque or speed is that of a motor that moves along a line.
pub(crate) fn is_linear_unit(unit: &str) -> bool {
    ["n", "n_per_sqrt_w"].contains(&unit)
        || unit.contains("m_per_s") && !unit.starts_with("n_m")
        || unit == "m_per_min"
}
