//! A channel in another unit than its name says.

use std::f64::consts::{PI, TAU};

/// A measured channel that is a unit's factor away from its reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitSlip {
    /// Measured over reference, as found.
    pub factor: f64,
    /// The same by the definition of the units: divide the measured channel by
    /// it, or, for a slip of the reference, multiply the reference.
    pub exact: f64,
    /// What probably happened: "millimetres read as metres".
    pub guess: &'static str,
}

/// Correlation above which the two follow the same motion.
const CORRELATION: f64 = 0.99;
/// Relative distance from a unit's factor: well above what tracking error leaves
/// at that correlation, below the 5 % between degrees (57.3) and minutes (60).
const TOLERANCE: f64 = 0.03;

/// Factor of measured over reference, the slip in words, and in words if it is
/// the reference that has slipped (the inverse factor).
const SLIPS: [(f64, &str, &str); 7] = [
    (
        1e3,
        "millimetres read as metres",
        "the reference is in millimetres read as metres",
    ),
    (
        1e6,
        "micrometres read as metres",
        "the reference is in micrometres read as metres",
    ),
    (
        1.0 / 25.4e-3,
        "inches read as metres",
        "the reference is in inches read as metres",
    ),
    (
        60.0 / TAU,
        "revolutions per minute read as rad/s",
        "the reference is in revolutions per minute read as rad/s",
    ),
    (
        180.0 / PI,
        "degrees read as radians",
        "the reference is in degrees read as radians",
    ),
    (
        60.0,
        "m/min read as m/s",
        "the reference is in m/min read as m/s",
    ),
    (
        60e3,
        "mm/min read as m/s",
        "the reference is in mm/min read as m/s",
    ),
];

/// Notices a measured channel in another unit than its reference.
///
/// The factor is the ratio of the standard deviations (the slope of the
/// regression that treats both alike, which noise on one side does not bias as
/// it does the ordinary slope); offsets do not matter. A slip is named where the
/// correlation is above 0.99 and the factor within 3 % of one between units in
/// use: mm, µm and inch against m, rpm against rad/s, degrees against radians,
/// m/min and mm/min against m/s, either way round. The words are those of
/// lengths and their rates; 1000 in a current is milliamperes.
///
/// `None` also where there is nothing to compare: fewer than two samples,
/// unequal lengths, a constant channel, values that are not finite.
///
/// ```
/// use axis_log::quality::unit_slip;
/// let reference = [0.60, 0.61, 0.63, 0.66];
/// let slip = unit_slip(&reference, &[600.0, 610.1, 629.9, 660.0]).expect("a slip");
/// assert_eq!(slip.guess, "millimetres read as metres");
/// assert_eq!(unit_slip(&reference, &reference), None);
/// ```
pub fn unit_slip(reference: &[f64], measured: &[f64]) -> Option<UnitSlip> {
    if reference.len() != measured.len() {
        return None;
    }
    let (x, y) = (deviations(reference)?, deviations(measured)?);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (xx, yy, xy) = (dot(&x.0, &x.0), dot(&y.0, &y.0), dot(&x.0, &y.0));
    let correlation = xy / (xx * yy).sqrt();
    if correlation.is_nan() || correlation <= CORRELATION {
        return None;
    }
    let factor = (yy / xx).sqrt() * (y.1 / x.1);
    SLIPS
        .into_iter()
        .flat_map(|(f, forward, back)| [(f, forward), (1.0 / f, back)])
        .map(|(exact, guess)| ((factor / exact - 1.0).abs(), exact, guess))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|&(distance, ..)| distance < TOLERANCE)
        .map(|(_, exact, guess)| UnitSlip {
            factor,
            exact,
            guess,
        })
}

/// Deviations from the mean relative to the greatest, and the greatest: so
/// squares neither overflow nor vanish, whatever the unit. `None` for a constant.
fn deviations(values: &[f64]) -> Option<(Vec<f64>, f64)> {
    let first = *values.first()?;
    let mean = values.iter().map(|v| v - first).sum::<f64>() / values.len() as f64;
    let off = |v: &f64| v - first - mean;
    let greatest = values.iter().map(|v| off(v).abs()).fold(0.0, f64::max);
    let usable = greatest.is_finite() && greatest > 0.0 && values.iter().all(|v| v.is_finite());
    usable.then(|| (values.iter().map(|v| off(v) / greatest).collect(), greatest))
}
