//! The unit of a channel, written as the suffix of its name.

/// Suffix and symbol. [`unit_of`] takes the longest suffix that fits, so that
/// `_rad_s` is not read as seconds.
const UNITS: &[(&str, &str)] = &[
    ("s", "s"),
    ("ms", "ms"),
    ("us", "µs"),
    ("ns", "ns"),
    ("hz", "Hz"),
    ("m", "m"),
    ("mm", "mm"),
    ("um", "µm"),
    ("m_s", "m/s"),
    ("mm_s", "mm/s"),
    ("m_min", "m/min"),
    ("m_s2", "m/s²"),
    ("mm_s2", "mm/s²"),
    ("m_s3", "m/s³"),
    ("rad", "rad"),
    ("deg", "°"),
    ("rev", "rev"),
    ("rad_s", "rad/s"),
    ("rad_s2", "rad/s²"),
    ("rpm", "rpm"),
    ("a", "A"),
    ("ma", "mA"),
    ("v", "V"),
    ("mv", "mV"),
    ("w", "W"),
    ("n", "N"),
    ("n_m", "N·m"),
    ("n_mm", "N·mm"),
    ("kg", "kg"),
    ("degc", "°C"),
    ("k", "K"),
    ("1", "1"),
];

/// The symbol of the unit that the suffix of `name` stands for, or `None`
/// if the name has no known suffix.
///
/// The suffix is what follows an underscore; the longest known one counts:
/// `motor_speed_rad_s` is in rad/s, `torque_n_m` in N·m. `_1` marks a quantity
/// without dimension. Every suffix is lower case.
///
/// ```
/// assert_eq!(axis_log::unit_of("motor_speed_rad_s"), Some("rad/s"));
/// assert_eq!(axis_log::unit_of("t_s"), Some("s"));
/// assert_eq!(axis_log::unit_of("temperature"), None);
/// ```
pub fn unit_of(name: &str) -> Option<&'static str> {
    UNITS
        .iter()
        .filter(|(suffix, _)| has_suffix(name, suffix))
        .max_by_key(|(suffix, _)| suffix.len())
        .map(|&(_, symbol)| symbol)
}

/// The name without its unit, and the unit's symbol.
pub(crate) fn stem_of(name: &str) -> Option<(&str, &'static str)> {
    let fits = UNITS.iter().filter(|(suffix, _)| has_suffix(name, suffix));
    let (suffix, symbol) = fits.max_by_key(|(suffix, _)| suffix.len())?;
    Some((&name[..name.len() - suffix.len() - 1], symbol))
}

/// All suffixes that [`unit_of`] knows, without the leading underscore.
pub fn unit_suffixes() -> impl Iterator<Item = &'static str> {
    UNITS.iter().map(|&(suffix, _)| suffix)
}

/// The suffixes as error messages list them.
pub(crate) fn suffix_list() -> String {
    let all: Vec<String> = unit_suffixes().map(|s| format!("_{s}")).collect();
    all.join(" ")
}

fn has_suffix(name: &str, suffix: &str) -> bool {
    name.strip_suffix(suffix)
        .and_then(|stem| stem.strip_suffix('_'))
        .is_some_and(|stem| !stem.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_suffix_counts() {
        for (name, symbol) in [
            ("t_s", "s"),
            ("position_ref_m", "m"),
            ("velocity_ref_m_s", "m/s"),
            ("acceleration_m_s2", "m/s²"),
            ("motor_angle_rad", "rad"),
            ("motor_speed_rad_s", "rad/s"),
            ("iq_ref_a", "A"),
            ("ud_v", "V"),
            ("torque_n_m", "N·m"),
            ("duty_1", "1"),
        ] {
            assert_eq!(unit_of(name), Some(symbol), "{name}");
        }
    }

    #[test]
    fn a_name_needs_a_stem_and_a_known_suffix() {
        for name in ["", "s", "_s", "m_s_", "position", "position_M", "speed_kmh"] {
            assert_eq!(unit_of(name), None, "{name}");
        }
        // "rad_s" alone is the stem "rad" in seconds.
        assert_eq!(unit_of("rad_s"), Some("s"));
    }
}
