//! Every key of the axis file, with the least and the greatest value that is
//! accepted: what messages and the table in docs/theory/axis-sim.md are made
//! of.
//!
//! The limits are far beyond any axis that is built. They keep a slip of the
//! pen (a wrong unit, an exponent too many) from turning into a run without an
//! end or into numbers that no longer resolve.

use super::key::{Key, count, number, quantity, table, tables, text, word};
use super::units::*;
use crate::work::FREQUENCIES;

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
const CONTROL_FREQUENCY: Key = quantity("frequency", &FREQUENCY, FREQUENCIES[0], FREQUENCIES[1]);
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
