//! SI numbers in the units that engineers of feed axes read.

use axis_log::fixed;

/// A unit for people, and what an SI value is multiplied by to be in it.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadUnit {
    /// Value in this unit over value in SI.
    pub factor: f64,
    /// The unit; empty for a plain number.
    pub name: String,
}

impl ReadUnit {
    fn new(factor: f64, name: &str) -> Self {
        Self {
            factor,
            name: name.to_owned(),
        }
    }

    /// The unit in which values of about `size` are read, given in the SI unit `si`; one
    /// that is not known stays as it is.
    ///
    /// ```
    /// use discrepancy::ReadUnit;
    /// let unit = ReadUnit::of("m", 4e-6);
    /// assert_eq!(unit.name, "µm");
    /// assert_eq!((4e-6 * unit.factor).round(), 4.0);
    /// ```
    pub fn of(si: &str, size: f64) -> Self {
        let below = |limit: f64| size.abs() < limit;
        match si {
            "m" if below(1e-3) => Self::new(1e6, "µm"),
            "m" if below(1.0) => Self::new(1e3, "mm"),
            "m/s" => Self::new(1e3, "mm/s"),
            "rad" if below(1.0) => Self::new(1e3, "mrad"),
            "rad/s" if below(1.0) => Self::new(1e3, "mrad/s"),
            "A" if below(1.0) => Self::new(1e3, "mA"),
            "V" if below(1.0) => Self::new(1e3, "mV"),
            "s" if below(1e-3) => Self::new(1e6, "µs"),
            "s" if below(1.0) => Self::new(1e3, "ms"),
            "m/s^2" => Self::new(1.0, "m/s²"),
            "rad/s^2" => Self::new(1.0, "rad/s²"),
            "N*m" => Self::new(1.0, "N·m"),
            "N*s/m" => Self::new(1e-3, "N/(mm/s)"),
            "N*m*s/rad" => Self::new(1.0, "N·m·s/rad"),
            "N/m" if below(1e6) => Self::new(1e-3, "N/mm"),
            "N/m" => Self::new(1e-6, "N/µm"),
            "N*m/rad" => Self::new(1.0, "N·m/rad"),
            "kg*m^2" if below(0.1) => Self::new(1e4, "kg·cm²"),
            "kg*m^2" => Self::new(1.0, "kg·m²"),
            other => Self::new(1.0, other),
        }
    }

    /// As [`ReadUnit::of`], for a parameter of an effect: a plain number is a share in % or
    /// a strain in ppm unless it counts or compares.
    pub fn of_parameter(name: &str, si: &str, size: f64) -> Self {
        match (name, si) {
            ("order" | "damping_ratio", "") => Self::new(1.0, ""),
            ("slope" | "strain", "") => Self::new(1e6, "ppm"),
            (_, "") => Self::new(100.0, "%"),
            ("phase", "rad") => Self::new(1.0, "rad"),
            _ => Self::of(si, size),
        }
    }

    /// The unit of a channel of logs, by the end of its name.
    pub fn of_channel(channel: &str, size: f64) -> Self {
        Self::of(channel_unit(channel), size)
    }

    /// A value with its unit, to three digits.
    pub fn said(&self, value: f64) -> String {
        let value = self.factor * value;
        with_unit(&fixed(value, decimals(0.1 * value)), &self.name)
    }

    /// A value with its unit and 95 % interval, to two digits of the interval's half width.
    pub fn said_within(&self, value: f64, [low, high]: [f64; 2]) -> String {
        let half = 0.5 * self.factor * (high - low);
        if half.is_nan() || half <= 0.0 {
            return self.said(value);
        }
        let digits = decimals(half);
        let number = |v: f64| fixed(self.factor * v, digits);
        let value = with_unit(&number(value), &self.name);
        format!("{value} (95 %: {} to {})", number(low), number(high))
    }
}

/// SI unit of a channel of logs; empty if its name does not say it.
pub(super) fn channel_unit(channel: &str) -> &'static str {
    const ENDS: [(&str, &str); 10] = [
        ("_rad_s", "rad/s"),
        ("_m_s", "m/s"),
        ("_n_m", "N*m"),
        ("_rad", "rad"),
        ("_m", "m"),
        ("_n", "N"),
        ("_a", "A"),
        ("_v", "V"),
        ("_w", "W"),
        ("_s", "s"),
    ];
    let end = ENDS.iter().find(|(end, _)| channel.ends_with(end));
    end.map_or("", |(_, unit)| unit)
}

fn with_unit(number: &str, unit: &str) -> String {
    match unit {
        "" => number.to_owned(),
        unit => format!("{number} {unit}"),
    }
}

/// Decimals that show two digits of a number of this size.
fn decimals(size: f64) -> usize {
    if size == 0.0 || !size.is_finite() {
        return 2;
    }
    (1.0 - size.abs().log10().floor()).clamp(0.0, 9.0) as usize
}

#[cfg(test)]
mod tests {
    use super::{ReadUnit, channel_unit};

    #[test]
    fn sizes_are_read_in_units_of_feed_axes() {
        let said = |si: &str, value: f64| ReadUnit::of(si, value).said(value);
        assert_eq!(said("m", 4e-6), "4.00 µm");
        assert_eq!(said("m", 0.0421), "42.1 mm");
        assert_eq!(said("m/s", 0.1), "100 mm/s");
        assert_eq!(said("rad", 1.2e-3), "1.20 mrad");
        assert_eq!(said("A", 0.0512), "51.2 mA");
        assert_eq!(said("N*s/m", 1.0631e4), "10.6 N/(mm/s)");
        assert_eq!(said("N/m", 1.5e6), "1.50 N/µm");
        assert_eq!(said("lumen", 3.0), "3.00 lumen");
        assert_eq!(said("N", -0.0), "0.00 N");
    }

    #[test]
    fn an_interval_shows_two_digits_of_its_half_width() {
        let unit = ReadUnit::of("N*s/m", 1.06319e4);
        let said = unit.said_within(1.06319e4, [1.06198e4, 1.06441e4]);
        assert_eq!(said, "10.632 N/(mm/s) (95 %: 10.620 to 10.644)");
        let unit = ReadUnit::of("m", 4e-6);
        assert_eq!(unit.said_within(4e-6, [4e-6, 4e-6]), "4.00 µm");
        let said = unit.said_within(1e-6, [-1e-6, 3e-6]);
        assert_eq!(said, "1.0 µm (95 %: -1.0 to 3.0)");
    }

    #[test]
    fn plain_numbers_are_shares_strains_or_counts() {
        let said = |name: &str, value: f64| ReadUnit::of_parameter(name, "", value).said(value);
        assert_eq!(said("relative_change", -0.05), "-5.00 %");
        assert_eq!(said("slope", 1e-4), "100 ppm");
        assert_eq!(said("order", 8.0), "8.00");
    }

    #[test]
    fn channels_end_in_their_unit() {
        let named = [
            "position_m",
            "motor_speed_rad_s",
            "iq_ref_a",
            "torque_ref_n_m",
        ];
        assert_eq!(named.map(channel_unit), ["m", "rad/s", "A", "N*m"]);
        assert_eq!(channel_unit("counts"), "");
    }
}
