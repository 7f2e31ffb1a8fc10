//! Units and SI prefixes: the one place where a number gets its unit for people.

use crate::number::{fixed, scientific};

/// Units that take a prefix, on their first symbol, with the least and the greatest power of ten
/// that people read with it. Of products such as N·s/m and of kg none is common; they stay as
/// they are.
const PREFIXED: [(&str, i32, i32); 20] = [
    ("m", -15, 0),
    ("m/s", -12, 0),
    ("m/s²", -12, 0),
    ("m/s³", -12, 0),
    ("s", -12, 0),
    ("rad", -12, 0),
    ("rad/s", -12, 0),
    ("rad/s²", -12, 0),
    ("rad/s³", -12, 0),
    ("A", -12, 3),
    ("V", -12, 3),
    ("N", -12, 6),
    ("N·m", -12, 6),
    ("N/m", 0, 9),
    ("N·m/rad", 0, 9),
    ("Hz", -3, 9),
    ("W", -12, 9),
    ("J", -12, 9),
    ("Pa", 0, 9),
    ("Ω", -3, 6),
];

/// Prefixes by their power of ten (BIPM, The International System of Units, 9th edition, table 7).
const PREFIXES: [(&str, i32); 9] = [
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("µ", -6),
    ("m", -3),
    ("", 0),
    ("k", 3),
    ("M", 6),
    ("G", 9),
];

/// A unit as it is written, taken apart.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Unit {
    /// Without prefix.
    pub base: String,
    /// Power of ten of the prefix that it was written with.
    pub exponent: i32,
    /// Least and greatest power of ten of a prefix; both 0 if it takes none.
    pub prefixes: (i32, i32),
}

impl Unit {
    /// Takes a unit apart: `"µm"` is 10⁻⁶ m. One that is not known takes no prefix.
    pub fn parse(text: &str) -> Self {
        let known = |base: &str| PREFIXED.into_iter().find(|(name, ..)| *name == base);
        let of = |prefix: &(&str, i32)| {
            let (base, low, high) = known(text.strip_prefix(prefix.0)?)?;
            Some(Self {
                base: base.to_owned(),
                exponent: prefix.1,
                prefixes: (low, high),
            })
        };
        // As it stands first: "m" is the metre, not a prefix.
        let whole = of(&("", 0)).or_else(|| PREFIXES.iter().find_map(of));
        whole.unwrap_or_else(|| Self {
            base: text.to_owned(),
            exponent: 0,
            prefixes: (0, 0),
        })
    }

    /// A value in the unit without prefix.
    pub fn to_base(&self, value: f64) -> f64 {
        scaled(value, -self.exponent)
    }

    /// Whether it takes prefixes.
    pub fn is_prefixed(&self) -> bool {
        self.prefixes != (0, 0)
    }

    /// The power of ten in which a value of this size, in the unit without prefix, is read:
    /// one to three digits before the point, as far as there is a prefix.
    pub fn reading(&self, size: f64) -> i32 {
        if !self.is_prefixed() || size == 0.0 || !size.is_finite() {
            return 0;
        }
        // Rounding must not make 1000 nm of 1 µm.
        let power = (size.abs().log10() + 1e-9).floor() as i32;
        let (low, high) = self.prefixes;
        (power.div_euclid(3) * 3).clamp(low, high)
    }

    /// The unit with the prefix of a power of ten.
    pub fn with(&self, exponent: i32) -> String {
        let prefix = PREFIXES.iter().find(|(_, power)| *power == exponent);
        format!("{}{}", prefix.map_or("", |(name, _)| name), self.base)
    }
}

/// A value with its unit as an engineer reads it: so many significant digits, an SI prefix
/// where the unit takes one, else a power of ten where the number would be long. `unit` is
/// that of `value`, with or without prefix; it may be empty.
///
/// ```
/// use axis_report::engineering;
/// assert_eq!(engineering(1.234e-5, "m", 3), "12.3 µm");
/// assert_eq!(engineering(0.0082, "A", 2), "8.2 mA");
/// assert_eq!(engineering(55.89, "µm", 3), "55.9 µm");
/// assert_eq!(engineering(10632.0, "N·s/m", 3), "10600 N·s/m");
/// assert_eq!(engineering(6.433e-7, "kg·m²", 3), "6.43·10⁻⁷ kg·m²");
/// ```
///
/// A value that is no finite number is a dash.
pub fn engineering(value: f64, unit: &str, digits: usize) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let unit = Unit::parse(unit);
    let value = rounded(unit.to_base(value), digits);
    let exponent = unit.reading(value);
    let number = significant(scaled(value, exponent), digits);
    let name = unit.with(exponent);
    let gap = if name.is_empty() { "" } else { " " };
    format!("{number}{gap}{name}")
}

/// A number of so many significant digits.
fn significant(value: f64, digits: usize) -> String {
    let digits = digits.max(1);
    let power = match value {
        0.0 => return "0".to_owned(),
        _ => (value.abs().log10() + 1e-12).floor() as i32,
    };
    if (-3..6).contains(&power) {
        let places = (digits as i32 - 1 - power).max(0) as usize;
        return fixed(value, places);
    }
    scientific(value, digits - 1)
}

/// To so many significant digits.
fn rounded(value: f64, digits: usize) -> f64 {
    let text = format!("{:.*e}", digits.max(1) - 1, value);
    text.parse().unwrap_or(value)
}

/// `value · 10^-exponent`, in two steps so that the power cannot overflow.
pub(crate) fn scaled(value: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    divided(divided(value, half), exponent - half)
}

/// Powers of ten are exact as whole numbers, not as fractions.
fn divided(value: f64, exponent: i32) -> f64 {
    if exponent < 0 {
        return value * 10f64.powi(-exponent);
    }
    value / 10f64.powi(exponent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn units_are_taken_apart() {
        for (text, base, exponent) in [
            ("m", "m", 0),
            ("mm", "m", -3),
            ("mm/s²", "m/s²", -3),
            ("ms", "s", -3),
            ("mrad", "rad", -3),
            ("kN", "N", 3),
            ("N·m", "N·m", 0),
            ("Pa", "Pa", 0),
            // Not known: as they are.
            ("min", "min", 0),
            ("N·s/m", "N·s/m", 0),
            ("%", "%", 0),
            ("", "", 0),
        ] {
            let unit = Unit::parse(text);
            assert_eq!(
                (unit.base.as_str(), unit.exponent),
                (base, exponent),
                "{text}"
            );
        }
    }

    #[test]
    fn numbers_stay_short() {
        for (value, unit, text) in [
            (0.0, "m", "0 m"),
            (9.999e-7, "m", "1.00 µm"),
            (999.6e-6, "m", "1.00 mm"),
            (-2.5e-8, "m", "\u{2212}25.0 nm"),
            (1500.0, "m", "1500 m"),
            (2.5e6, "N", "2.50 MN"),
            (1.5e8, "N/m", "150 MN/m"),
            (0.02979, "N·m·s/rad", "0.0298 N·m·s/rad"),
            (3.2e-14, "m", "32.0 fm"),
            (f64::NAN, "m", "–"),
            (2.0, "", "2.00"),
        ] {
            assert_eq!(engineering(value, unit, 3), text);
        }
    }

    proptest! {
        /// What is written, read again, is the value to the digits asked for.
        #[test]
        fn the_text_says_the_value(
            mantissa in 1.0..10.0f64, power in -17i32..10, digits in 2usize..7,
            unit in prop::sample::select(vec!["m", "A", "N", "rad/s", "N·s/m", "Hz", ""]),
        ) {
            let value = mantissa * 10f64.powi(power);
            let text = engineering(value, unit, digits);
            let (number, name) = text.split_once(' ').unwrap_or((&text, ""));
            // A power of ten stands in superscripts only where no prefix serves.
            prop_assume!(!number.contains('·'));
            let read = Unit::parse(name).to_base(number.parse().unwrap());
            let off = (read / value - 1.0).abs();
            prop_assert!(off <= 0.51 * 10f64.powi(1 - digits as i32) + 1e-12, "{value} {text}");
        }
    }
}
