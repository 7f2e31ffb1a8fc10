//! Channels of a slow log in SI units, whatever unit ends their names.

use axis_log::Log;

/// Units of a quantity and their factors to SI.
pub(super) type Units = &'static [(&'static str, f64)];

pub(super) const LENGTH: Units = &[("m", 1.0), ("mm", 1e-3), ("um", 1e-6)];
pub(super) const SPEED: Units = &[("m_s", 1.0), ("mm_s", 1e-3), ("m_min", 1.0 / 60.0)];
pub(super) const ANGLE: Units = &[
    ("rad", 1.0),
    ("deg", std::f64::consts::TAU / 360.0),
    ("rev", std::f64::consts::TAU),
];
pub(super) const TORQUE: Units = &[("n_m", 1.0), ("n_mm", 1e-3)];
pub(super) const CURRENT: Units = &[("a", 1.0), ("ma", 1e-3)];
pub(super) const POWER: Units = &[("w", 1.0)];
pub(super) const TEMPERATURE: Units = &[("degc", 1.0)];
pub(super) const NUMBER: Units = &[("1", 1.0)];

/// The channel of that name, without its unit, in SI units.
pub(super) fn channel(log: &Log, name: &str, units: Units) -> Option<Vec<f64>> {
    units.iter().find_map(|(unit, factor)| {
        let values = log.channel(&format!("{name}_{unit}")).ok()?;
        Some(values.iter().map(|value| factor * value).collect())
    })
}
