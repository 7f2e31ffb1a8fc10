//! A value and its half width, as people read them.

use std::fmt;

/// Decimals beyond which a half width is shown by a power of ten.
const MOST: usize = 9;

/// Shows `value ± half width` with so many decimals, and with more if the half width would be
/// rounded to zero: with as many as show one digit of it.
///
/// ```
/// use axis_log::PlusMinus;
///
/// assert_eq!(PlusMinus::new(51.034, 0.27, 2).to_string(), "51.03 ± 0.27");
/// assert_eq!(PlusMinus::new(51.034, 0.0027, 2).to_string(), "51.034 ± 0.003");
/// assert_eq!(PlusMinus::new(51.034, 0.0, 2).to_string(), "51.03 ± 0");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlusMinus {
    /// The value.
    pub value: f64,
    /// Half the width of its interval, or its standard deviation, in the value's unit.
    pub half_width: f64,
    /// Decimals, if the half width does not ask for more.
    pub decimals: usize,
}

impl PlusMinus {
    /// A value and its half width with so many decimals at least.
    pub fn new(value: f64, half_width: f64, decimals: usize) -> Self {
        Self {
            value,
            half_width,
            decimals,
        }
    }
}

/// Decimals, so many at least, with which a number is not shown as zero; none if that takes too many.
fn enough(number: f64, decimals: usize) -> Option<usize> {
    let is_shown = |decimals: &usize| !is_zero(&format!("{:.*}", *decimals, number.abs()));
    (decimals..=MOST.max(decimals)).find(is_shown)
}

/// A number with so many decimals, and with more if it would be rounded to zero; 0 is `0`.
///
/// ```
/// assert_eq!(axis_log::never_zero(0.31, 1), "0.3");
/// assert_eq!(axis_log::never_zero(0.0031, 1), "0.003");
/// ```
pub fn never_zero(number: f64, decimals: usize) -> String {
    match enough(number, decimals) {
        _ if number == 0.0 => "0".to_owned(),
        Some(decimals) => format!("{number:.decimals$}"),
        None => format!("{number:.0e}"),
    }
}

impl fmt::Display for PlusMinus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            value,
            half_width,
            decimals,
        } = *self;
        let shared = enough(half_width, decimals).filter(|_| half_width != 0.0);
        let number = fixed(value, shared.unwrap_or(decimals));
        write!(f, "{number} ± {}", never_zero(half_width, decimals))
    }
}

/// A number with so many decimals; what is rounded to zero has no sign.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix(['-', '+']) {
        Some(zero) if is_zero(zero) => zero.to_owned(),
        _ => text,
    }
}

fn is_zero(text: &str) -> bool {
    text.bytes().all(|c| matches!(c, b'0' | b'.'))
}

#[cfg(test)]
mod tests {
    use super::{PlusMinus, fixed};

    #[test]
    fn a_half_width_is_never_shown_as_zero() {
        for (value, half, decimals, text) in [
            (1.0, 0.005, 2, "1.00 ± 0.01"),
            (1.0, 0.004, 2, "1.000 ± 0.004"),
            (-0.0001, 0.3, 2, "0.00 ± 0.30"),
            (-12.0, 4e-7, 3, "-12.0000000 ± 0.0000004"),
            (5.0, 2.4e-13, 2, "5.00 ± 2e-13"),
            (5.0, f64::NAN, 2, "5.00 ± NaN"),
            (5.0, f64::INFINITY, 2, "5.00 ± inf"),
            (0.0, 1e3, 0, "0 ± 1000"),
        ] {
            assert_eq!(PlusMinus::new(value, half, decimals).to_string(), text);
        }
        // Whatever the size: read again it is not zero.
        for power in -30..6 {
            let half = 3.0 * 10f64.powi(power);
            let text = PlusMinus::new(2.0, half, 2).to_string();
            let read: f64 = text.split(" ± ").nth(1).unwrap().parse().unwrap();
            assert!((read / half - 1.0).abs() < 0.51, "{text}");
        }
    }

    #[test]
    fn a_rounded_zero_has_no_sign() {
        assert_eq!(fixed(-0.0004, 3), "0.000");
        assert_eq!(fixed(-0.0006, 3), "-0.001");
        assert_eq!(fixed(-0.0, 0), "0");
    }
}
