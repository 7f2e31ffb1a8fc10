//! The keys of an axis file that belong to no part, with the least and the
//! greatest value that is accepted.
//!
//! The limits, like those of the parts' keys, are far beyond any axis that is built. They
//! keep a slip of the pen (a wrong unit, an exponent too many) from turning into a run
//! without an end or into numbers that no longer resolve.

use super::fields::SCHEMA;
use super::layout::Layout;
use super::loop_keys::loop_keys;
use crate::actuator::Effort;
use crate::freedom::Freedom;
use crate::part::units::*;
use crate::part::{Key, number, quantity, table, tables, text, text_of, word};
use crate::rating::rating_keys;
use crate::thermal::THERMAL_KEYS;

/// All keys of a file whose parts are of these kinds.
pub(super) fn keys(layout: &Layout, freedom: Freedom, effort: Effort) -> Vec<Key> {
    let mut keys = vec![SCHEMA, text("name"), text("description").optional()];
    keys.extend(layout.tables(&loop_keys(freedom)));
    keys.extend([
        Key::of_table("stroke", stroke(freedom)),
        Key::of_table("samples", samples(freedom, effort)).optional(),
        table("simulation", SIMULATION).optional(),
        table("sensors", SENSORS).optional(),
        table("experiment", EXPERIMENT).optional(),
        Key::of_table("tolerances", tolerances(layout)).optional(),
        table("log", LOG).optional(),
        Key::of_table("balance", balance(freedom)).optional(),
        table("thermal", THERMAL_KEYS).optional(),
        Key::of_table("rating", rating_keys()).optional(),
        Key::of_tables("trajectory", trajectory(freedom)).optional(),
        tables("load", KIND).optional(),
        tables("effects", ENTRY).optional(),
    ]);
    keys
}

fn position(name: &'static str, freedom: Freedom) -> Key {
    match freedom {
        Freedom::Linear => quantity(name, &LENGTH, -1e3, 1e3),
        Freedom::Rotary => quantity(name, &ANGLE, -1e4, 1e4),
    }
}

fn stroke(freedom: Freedom) -> Vec<Key> {
    ["minimum", "maximum", "start"]
        .map(|name| position(name, freedom))
        .to_vec()
}

fn samples(freedom: Freedom, effort: Effort) -> Vec<Key> {
    let linear = freedom == Freedom::Linear;
    let position = |name| match linear {
        true => quantity(name, &LENGTH, -1e3, 1e3),
        false => quantity(name, &ANGLE, -1e4, 1e4),
    };
    let speed = |name| match linear {
        true => quantity(name, &SPEED, -1e3, 1e3),
        false => quantity(name, &ANGULAR_SPEED, -1e4, 1e4),
    };
    let acceleration = |name| match linear {
        true => quantity(name, &ACCELERATION, -1e6, 1e6),
        false => quantity(name, &ANGULAR_ACCELERATION, -1e7, 1e7),
    };
    let (dimension, most) = match effort {
        Effort::Current => (&CURRENT, 1e5),
        Effort::Torque => (&TORQUE, 1e7),
        Effort::Force => (&FORCE, 1e8),
        Effort::Voltage => (&VOLTAGE, 1e6),
    };
    let [least_effort, most_effort] = effort_names(effort);
    vec![
        position("position_min"),
        position("position_max"),
        speed("speed_min"),
        speed("speed_max"),
        acceleration("acceleration_min"),
        acceleration("acceleration_max"),
        quantity(least_effort, dimension, -most, most),
        quantity(most_effort, dimension, -most, most),
    ]
}

/// What the range of the actuator's command is called in [samples].
pub(super) fn effort_names(effort: Effort) -> [&'static str; 2] {
    match effort {
        Effort::Current => ["current_min", "current_max"],
        Effort::Torque => ["torque_min", "torque_max"],
        Effort::Force => ["force_min", "force_max"],
        Effort::Voltage => ["command_min", "command_max"],
    }
}

const SIMULATION: &[Key] = &[
    word("method", &["fast", "exact"]).optional(),
    quantity("step", &TIME, 1e-8, 0.01),
];

const KIND: &[Key] = &[text("kind")];

const SENSORS: &[Key] = &[
    table("load", KIND).optional(),
    table("motor", KIND).optional(),
];

const EXPERIMENT: &[Key] = &[text("machine"), text("paper_tables").optional()];

/// How far a known parameter may be off.
pub(super) const SHARE: &str =
    "a text in quotes: a share such as \"20 %\", from 0.001 % to 90 %, or \"unknown\"";

/// `known_parameters_percent`, and each known parameter of the file's kinds.
fn tolerances(layout: &Layout) -> Vec<Key> {
    let lists = [
        layout.mechanism.known,
        layout.actuator.known,
        layout.control.known,
        layout.friction.known,
    ];
    let loads = layout.loads.iter().map(|load| load.known);
    let known = lists.into_iter().chain(loads).flatten();
    let known = known.map(|known| text_of(known.name, SHARE).optional());
    let default = number("known_parameters_percent", 1e-3, 100.0).optional();
    std::iter::once(default).chain(known).collect()
}

const LOG: &[Key] = &[
    quantity("sample_rate", &FREQUENCY, 1e-3, 1e8).optional(),
    tables("column", COLUMN).optional(),
];

/// What is left out is taken from the log.
fn balance(freedom: Freedom) -> Vec<Key> {
    let slowest = match freedom {
        Freedom::Linear => quantity("slowest", &SPEED, 1e-9, 1e3),
        Freedom::Rotary => quantity("slowest", &ANGULAR_SPEED, 1e-9, 1e4),
    };
    let cutoff = quantity("cutoff", &FREQUENCY, 1e-3, 1e5);
    vec![cutoff.optional(), slowest.optional()]
}

const COLUMN: &[Key] = &[
    text("source"),
    text("channel"),
    text("unit").optional(),
    number("counts_per_turn", 1e-6, 1e12).optional(),
    number("factor", -1e12, 1e12).optional(),
    number("scale", -1e12, 1e12).optional(),
    number("offset", -1e12, 1e12).optional(),
    number("delay_ms", -1e7, 1e7).optional(),
];

fn trajectory(freedom: Freedom) -> Vec<Key> {
    match freedom {
        Freedom::Linear => vec![
            quantity("displacement", &LENGTH, -100.0, 100.0),
            quantity("speed", &SPEED, 1e-6, 1e3),
            quantity("acceleration", &ACCELERATION, 1e-6, 1e6),
            quantity("jerk", &JERK, 1e-6, 1e9),
        ],
        Freedom::Rotary => vec![
            quantity("displacement", &ANGLE, -1e4, 1e4),
            quantity("speed", &ANGULAR_SPEED, 1e-6, 1e5),
            quantity("acceleration", &ANGULAR_ACCELERATION, 1e-6, 1e8),
            quantity("jerk", &ANGULAR_JERK, 1e-6, 1e12),
        ],
    }
}

/// An effect; its other keys are its parameters.
const ENTRY: &[Key] = &[text("name")];
