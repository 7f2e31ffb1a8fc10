//! The units that drives export.

use std::f64::consts::{PI, TAU};

use crate::unit::unit_of;

/// Names of a unit, its dimension, and how many SI units (rad for angles) one of it is.
pub(crate) type Row = (&'static [&'static str], &'static str, f64);

const UNITS: &[Row] = &[
    (&["s", "sec"], "time", 1.0),
    (&["ms", "msec"], "time", 1e-3),
    // Micro is written as the sign of its own, the Greek letter, or "u".
    (&["us", "µs", "μs", "usec"], "time", 1e-6),
    (&["ns", "nsec"], "time", 1e-9),
    (&["Hz", "hz"], "frequency", 1.0),
    (&["kHz", "khz"], "frequency", 1e3),
    (&["m"], "length", 1.0),
    (&["mm"], "length", 1e-3),
    (&["um", "µm", "μm"], "length", 1e-6),
    (&["nm"], "length", 1e-9),
    (&["in", "inch"], "length", 25.4e-3),
    (&["m/s", "m/sec"], "speed", 1.0),
    (&["mm/s", "mm/sec"], "speed", 1e-3),
    (&["m/min"], "speed", 1.0 / 60.0),
    (&["mm/min"], "speed", 1e-3 / 60.0),
    (&["m/s²", "m/s2"], "acceleration", 1.0),
    (&["mm/s²", "mm/s2"], "acceleration", 1e-3),
    (&["m/s³", "m/s3"], "jerk", 1.0),
    (&["rad"], "angle", 1.0),
    (&["mrad"], "angle", 1e-3),
    (&["deg", "°", "degree", "degrees"], "angle", PI / 180.0),
    (&["arcmin"], "angle", PI / 10_800.0),
    (&["arcsec"], "angle", PI / 648_000.0),
    (&["rev", "turn", "turns"], "angle", TAU),
    (&["rad/s", "rad/sec"], "angular speed", 1.0),
    (&["deg/s", "°/s", "deg/sec"], "angular speed", PI / 180.0),
    (&["rev/s", "rps"], "angular speed", TAU),
    (
        &["rpm", "1/min", "rev/min", "r/min", "U/min", "RPM"],
        "angular speed",
        TAU / 60.0,
    ),
    (&["rad/s²", "rad/s2"], "angular acceleration", 1.0),
    (&["A", "a"], "current", 1.0),
    (&["mA", "ma"], "current", 1e-3),
    (&["V", "v"], "voltage", 1.0),
    (&["mV", "mv"], "voltage", 1e-3),
    (&["W", "w"], "power", 1.0),
    (&["kW"], "power", 1e3),
    (&["N", "n"], "force", 1.0),
    (&["kN"], "force", 1e3),
    (&["N·m", "Nm", "n_m"], "torque", 1.0),
    (&["N·mm", "Nmm", "mN·m", "mNm", "n_mm"], "torque", 1e-3),
    (&["kg"], "mass", 1.0),
    (&["1"], "number", 1.0),
];

/// Encoder counts, and counts a second: their size is `counts_per_turn`'s.
pub(crate) const COUNTS: [(&str, &str); 2] = [("counts", "angle"), ("counts/s", "angular speed")];

/// A share of a full scale, which is the factor's to give.
pub(crate) const PERCENT: &str = "%";

pub(crate) fn row(name: &str) -> Option<&'static Row> {
    UNITS.iter().find(|(names, ..)| names.contains(&name))
}

/// Whether a column may be given in a unit of that name.
pub(crate) fn is_unit(name: &str) -> bool {
    known(name).is_some()
}

/// The unit's own name where it has several, and its dimension.
pub(crate) fn known(name: &str) -> Option<(&'static str, &'static str)> {
    let counted = COUNTS.iter().find(|(own, _)| *own == name).copied();
    row(name).map(|(names, of, _)| (names[0], *of)).or(counted)
}

/// How many SI units (rad for angles) one of that name is.
pub(crate) fn size_of(name: &str) -> Option<f64> {
    row(name).map(|(_, _, size)| *size)
}

/// Names of the units that a column may be given in to be this channel, as error messages list them;
/// of all dimensions, where the channel's is not known.
pub(crate) fn source_units(channel: &str) -> String {
    let own = unit_of(channel).and_then(row).map(|(_, of, _)| *of);
    let units = UNITS.iter().map(|(names, of, _)| (names[0], *of));
    let fits = units
        .chain(COUNTS)
        .filter(|(_, of)| own.is_none_or(|own| own == *of));
    let all: Vec<&str> = fits.map(|(name, _)| name).chain([PERCENT]).collect();
    all.join(" ")
}

/// The dimension of a unit by its symbol, and its size in SI.
fn dimension_of(symbol: &str) -> Option<(&'static str, f64)> {
    row(symbol).map(|(_, of, size)| (*of, *size))
}

/// The name of the unit that a channel with this symbol was read from as if it were its
/// own, where its numbers are `factor` times too large; within `tolerance` of it.
pub(crate) fn slipped_unit(
    symbol: &str,
    factor: f64,
    tolerance: f64,
) -> Option<(&'static str, f64)> {
    let (dimension, own) = dimension_of(symbol)?;
    let of_kind = UNITS.iter().filter(|(_, of, _)| *of == dimension);
    let distance = |size: f64| (factor * size / own - 1.0).abs();
    of_kind
        .filter(|(_, _, size)| *size != own && distance(*size) < tolerance)
        .min_by(|a, b| distance(a.2).total_cmp(&distance(b.2)))
        .map(|(names, _, size)| (names[0], own / size))
}
