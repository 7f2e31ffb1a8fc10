//! Every key of the axis file, with the least and the greatest value that is
//! accepted: what messages and the table in docs/theory/axis-sim.md are made
//! of.
//!
//! The limits are far beyond any axis that is built. They keep a slip of the
//! pen (a wrong unit, an exponent too many) from turning into a run without an
//! end or into numbers that no longer resolve.

use std::borrow::Cow;

use super::units::*;
use crate::SixDigits;
use crate::axis::Range;

/// One key of a table.
#[derive(Clone, Debug)]
pub(super) struct Key {
    /// As in the file; a quantity's is without its unit.
    pub(super) name: &'static str,
    pub(super) kind: Kind,
}

/// What stands under a key.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// A number with a unit, which ends the key; the limits are SI.
    Quantity(&'static Dimension, Range),
    /// A number whose unit, if it has one, is always the same.
    Number(&'static str, Range),
    /// A whole number.
    Count(u32, u32),
    /// A text.
    Text,
    /// One of a few words.
    Word(Cow<'static, [&'static str]>),
    /// A table.
    Table(&'static [Key]),
    /// Tables of the same kind.
    Tables(&'static [Key]),
}

const fn quantity(
    name: &'static str,
    dimension: &'static Dimension,
    least: f64,
    most: f64,
) -> Key {
    let kind = Kind::Quantity(dimension, Range { least, most });
    Key { name, kind }
}

const fn number(name: &'static str, least: f64, most: f64) -> Key {
    let kind = Kind::Number("", Range { least, most });
    Key { name, kind }
}

const fn count(name: &'static str, least: u32, most: u32) -> Key {
    let kind = Kind::Count(least, most);
    Key { name, kind }
}

const fn text(name: &'static str) -> Key {
    let kind = Kind::Text;
    Key { name, kind }
}

const fn word(name: &'static str, words: &'static [&'static str]) -> Key {
    let kind = Kind::Word(Cow::Borrowed(words));
    Key { name, kind }
}

const fn table(name: &'static str, keys: &'static [Key]) -> Key {
    let kind = Kind::Table(keys);
    Key { name, kind }
}

const fn tables(name: &'static str, keys: &'static [Key]) -> Key {
    let kind = Kind::Tables(keys);
    Key { name, kind }
}

/// The version of the axis file's layout that this program reads.
const SCHEMA: u32 = 1;

/// The word for a ball-screw axis, which a file without a kind is, and the one
/// for a rigid mass.
pub(super) const KINDS: [&str; 2] = ["ball-screw", "rigid-mass"];

/// What tells which keys a file may have.
pub(super) const KIND: &[Key] = &[word("kind", &KINDS)];

/// A file of a ball-screw axis.
pub(super) const BALL_SCREW: &[Key] = &[
    count("schema", SCHEMA, SCHEMA),
    word("kind", &KINDS),
    text("name"),
    text("description"),
    table("screw", SCREW),
    table("drive", DRIVE),
    table("friction", FRICTION),
    table("motor", MOTOR),
    table("inverter", INVERTER),
    table("control", CONTROL),
    table("stroke", STROKE),
    table("samples", SAMPLES),
    table("simulation", SIMULATION),
    table("experiment", EXPERIMENT),
    table("tolerances", TOLERANCES),
    table("log", LOG),
    tables("trajectory", TRAJECTORY),
    tables("effects", ENTRY),
];

/// A file of a rigid mass.
pub(super) const RIGID_MASS: &[Key] = &[
    count("schema", SCHEMA, SCHEMA),
    word("kind", &KINDS),
    text("name"),
    text("description"),
    table("body", BODY),
    table("control", RIGID_CONTROL),
    table("stroke", STROKE),
    table("simulation", RIGID_SIMULATION),
    table("tolerances", TOLERANCES),
    table("log", LOG),
    tables("effects", ENTRY),
];

const SCREW: &[Key] = &[
    quantity("length", &LENGTH, 0.01, 100.0),
    quantity("diameter", &LENGTH, 1e-3, 1.0),
    quantity("lead", &LENGTH, 1e-4, 1.0),
    count("elements", 2, 1000),
    quantity("youngs_modulus", &PRESSURE, 1e8, 1e13),
    number("poisson_ratio", -0.99, 0.49),
    quantity("density", &DENSITY, 100.0, 1e5),
];

const DRIVE: &[Key] = &[
    quantity("motor_inertia", &INERTIA, 1e-9, 1e3),
    quantity("torque_sensor_inertia", &INERTIA, 1e-9, 1e3),
    quantity("motor_coupling", &TORSION, 0.1, 1e9),
    quantity("screw_coupling", &TORSION, 0.1, 1e9),
    quantity("nut_stiffness", &STIFFNESS, 1e3, 1e12),
    quantity("table_mass", &MASS, 1e-3, 1e6),
    quantity("stiffness_damping", &TIME, 0.0, 0.1),
];

const FRICTION: &[Key] = &[
    quantity("coulomb", &TORQUE, 1e-9, 1e5),
    quantity("stiction", &TORQUE, 1e-9, 1e5),
    quantity("stribeck_speed", &ROTATION, 1e-6, 1e5),
    quantity("bristle_stiffness", &BRISTLE_STIFFNESS, 1e-6, 1e9),
    quantity("bristle_damping", &ROTARY_DAMPING, 0.0, 1e5),
    quantity("viscous", &ROTARY_DAMPING, 0.0, 1e5),
];

const MOTOR: &[Key] = &[
    count("pole_pairs", 1, 100),
    quantity("torque_constant", &TORQUE_CONSTANT, 1e-5, 1e4),
    quantity("resistance", &RESISTANCE, 0.0, 1e4),
    quantity("inductance_d", &INDUCTANCE, 1e-8, 100.0),
    quantity("inductance_q", &INDUCTANCE, 1e-8, 100.0),
];

const INVERTER: &[Key] = &[quantity("dc_link", &VOLTAGE, 1.0, 1e5)];

/// Control frequency, Hz.
const CONTROL_FREQUENCY: Key = quantity("frequency", &FREQUENCY, 100.0, 1e6);
/// Tracking error at which a run is given up, m.
const FOLLOWING_ERROR: Key = quantity("following_error_limit", &LENGTH, 1e-6, 10.0);

const CONTROL: &[Key] = &[
    CONTROL_FREQUENCY,
    quantity("position_gain", &POSITION_GAIN, 0.0, 1e9),
    number("velocity_feedforward", -10.0, 10.0),
    quantity("speed_proportional", &SPEED_PROPORTIONAL, 0.0, 1e6),
    quantity("speed_integral", &SPEED_INTEGRAL, 0.0, 1e9),
    quantity("current_d_proportional", &CURRENT_PROPORTIONAL, 0.0, 1e6),
    quantity("current_d_integral", &CURRENT_INTEGRAL, 0.0, 1e9),
    quantity("current_q_proportional", &CURRENT_PROPORTIONAL, 0.0, 1e6),
    quantity("current_q_integral", &CURRENT_INTEGRAL, 0.0, 1e9),
    quantity("current_limit", &CURRENT, 1e-3, 1e5),
    FOLLOWING_ERROR,
];

const STROKE: &[Key] = &[
    quantity("minimum", &LENGTH, -1e3, 1e3),
    quantity("maximum", &LENGTH, -1e3, 1e3),
    quantity("start", &LENGTH, -1e3, 1e3),
];

const SAMPLES: &[Key] = &[
    quantity("position_min", &LENGTH, 0.0, 100.0),
    quantity("position_max", &LENGTH, 0.0, 100.0),
    quantity("speed_min", &SPEED, -1e3, 1e3),
    quantity("speed_max", &SPEED, -1e3, 1e3),
    quantity("acceleration_min", &ACCELERATION, -1e6, 1e6),
    quantity("acceleration_max", &ACCELERATION, -1e6, 1e6),
    quantity("current_min", &CURRENT, -1e5, 1e5),
    quantity("current_max", &CURRENT, -1e5, 1e5),
];

const STEP: Key = quantity("step", &TIME, 1e-8, 0.01);

const SIMULATION: &[Key] = &[
    word("nut_coupling", &["shape-functions", "moving-node"]),
    STEP,
];

const RIGID_SIMULATION: &[Key] = &[STEP];

const EXPERIMENT: &[Key] = &[text("machine"), text("paper_tables")];

const TOLERANCES: &[Key] = &[number("known_parameters_percent", 1e-3, 100.0)];

const LOG: &[Key] = &[
    quantity("sample_rate", &FREQUENCY, 1e-3, 1e8),
    tables("column", COLUMN),
];

const COLUMN: &[Key] = &[
    text("source"),
    text("channel"),
    number("scale", -1e12, 1e12),
    number("offset", -1e12, 1e12),
];

const TRAJECTORY: &[Key] = &[
    quantity("displacement", &LENGTH, -100.0, 100.0),
    quantity("speed", &SPEED, 1e-6, 1e3),
    quantity("acceleration", &ACCELERATION, 1e-6, 1e6),
    quantity("jerk", &JERK, 1e-6, 1e9),
];

/// An effect; its other keys are its parameters.
const ENTRY: &[Key] = &[text("name")];

const BODY: &[Key] = &[
    quantity("mass", &MASS, 1e-3, 1e6),
    quantity("force_gain", &FORCE_GAIN, 1e-6, 1e9),
    quantity("viscous", &LINEAR_DAMPING, 0.0, 1e9),
    quantity("coulomb", &FORCE, 0.0, 1e7),
    quantity("presliding", &LENGTH, 1e-9, 0.1),
    quantity("lead", &LENGTH, 1e-4, 10.0),
];

const RIGID_CONTROL: &[Key] = &[
    CONTROL_FREQUENCY,
    quantity("position_gain", &RATE, 1e-3, 1e6),
    quantity("speed_gain", &SPEED_GAIN, 1e-6, 1e9),
    quantity("command_limit", &VOLTAGE, 1e-3, 1e6),
    FOLLOWING_ERROR,
];

impl Range {
    /// Whether `value` lies inside, but for the rounding of its conversion to SI.
    pub(super) fn takes(&self, value: f64) -> bool {
        let slack = |end: f64| 1e-12 * end.abs();
        (self.least - slack(self.least)..=self.most + slack(self.most)).contains(&value)
    }

    /// In words, in a unit of `factor` SI units.
    fn text(&self, factor: f64) -> String {
        let (least, most) = (SixDigits(self.least / factor), SixDigits(self.most / factor));
        format!("from {least} to {most}")
    }
}

impl Key {
    /// A number of an effect, in SI units.
    pub(super) const fn of_effect(name: &'static str, unit: &'static str, bounds: [f64; 2]) -> Self {
        let [least, most] = bounds;
        let kind = Kind::Number(unit, Range { least, most });
        Self { name, kind }
    }

    /// A key whose value is one of `words`.
    pub(super) const fn of_words(name: &'static str, words: Vec<&'static str>) -> Self {
        let kind = Kind::Word(Cow::Owned(words));
        Self { name, kind }
    }

    /// The spellings under which it may stand in a file.
    pub(super) fn spellings(&self) -> Vec<String> {
        match &self.kind {
            Kind::Quantity(dimension, _) => dimension.keys(self.name).collect(),
            _ => vec![self.name.to_owned()],
        }
    }

    /// A spelling with the brackets that a table has in a file.
    pub(super) fn shown(&self, spelling: &str) -> String {
        match self.kind {
            Kind::Table(_) => format!("[{spelling}]"),
            Kind::Tables(_) => format!("[[{spelling}]]"),
            _ => spelling.to_owned(),
        }
    }

    /// What would be valid; `unit` is that of the key as it was given, if it was.
    pub(super) fn valid(&self, unit: Option<(&str, f64)>) -> String {
        match &self.kind {
            Kind::Quantity(dimension, limits) => {
                let usual = dimension.units().first().copied();
                let (unit, factor) = unit.or(usual).unwrap_or(("", 1.0));
                format!("a number {}, in {unit}", limits.text(factor))
            }
            Kind::Number(unit, limits) => {
                let text = format!("a number {} {unit}", limits.text(1.0));
                text.trim_end().to_owned()
            }
            Kind::Count(least, most) => format!("a whole number from {least} to {most}"),
            Kind::Text => "a text in quotes".to_owned(),
            Kind::Word(words) => {
                let quoted: Vec<String> = words.iter().map(|w| format!("\"{w}\"")).collect();
                quoted.join(" or ")
            }
            Kind::Table(_) => format!("a table [{}]", self.name),
            Kind::Tables(_) => format!("tables [[{}]]", self.name),
        }
    }
}
