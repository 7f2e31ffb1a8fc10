//! Numbers as people read them.

use std::fmt;

/// Shows a number with six significant digits at most, without trailing zeros;
/// with an exponent where it is below 10⁻⁴ or from 10⁷ on.
///
/// ```
/// use axis_sim::SixDigits;
///
/// assert_eq!(SixDigits(3.6319444444444438).to_string(), "3.63194");
/// assert_eq!(SixDigits(0.02).to_string(), "0.02");
/// assert_eq!(SixDigits(-5.44537312e-5).to_string(), "-5.44537e-5");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SixDigits(
    /// The number.
    pub f64,
);

impl fmt::Display for SixDigits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Display gives the fewest digits that read back to the rounded number.
        let rounded = format!("{:.5e}", self.0).parse().unwrap_or(self.0);
        let size = f64::abs(rounded);
        if size == 0.0 || (1e-4..1e7).contains(&size) || !size.is_finite() {
            write!(f, "{rounded}")
        } else {
            write!(f, "{rounded:e}")
        }
    }
}
