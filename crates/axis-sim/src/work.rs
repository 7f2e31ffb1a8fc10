//! How much work a run is, known before it begins.

use feed_dynamics::DriveError;

/// Least and greatest control frequency that an axis file takes, Hz.
pub const FREQUENCIES: [f64; 2] = [100.0, 1e6];

/// Internal steps of the plant beyond which a run is refused: about an hour's
/// computing with the modal stepper, and as many days with some hundred
/// elements and a moving node.
pub const MOST_STEPS: f64 = 1e10;

/// Greatest number of internal steps of a control period.
pub(crate) const MOST_SUBSTEPS: u32 = 10_000;

/// Sampling instants from the start of a motion of `duration` to its end, both
/// included.
pub(crate) fn cycles_of(duration: f64, period: f64) -> f64 {
    (duration / period * (1.0 + 1e-12)).floor().max(0.0) + 1.0
}

/// Refuses a control period (s) that no axis file can have.
pub(crate) fn check_period(period: f64) -> Result<(), DriveError> {
    let [least, most] = FREQUENCIES.map(|f| f * period);
    // But for rounding.
    if least <= 1.0 + 1e-9 && most >= 1.0 - 1e-9 {
        return Ok(());
    }
    Err(DriveError::Parameter {
        name: "period",
        value: period,
        valid: "from 1e-6 s to 0.01 s",
    })
}

/// Number of equal steps, none longer than asked, that make up a period; at most [`MOST_SUBSTEPS`].
pub(crate) fn substeps(period: f64, step: f64) -> u32 {
    let steps = substeps_of(period, step);
    steps.min(f64::from(MOST_SUBSTEPS)) as u32
}

/// Number of equal steps, none longer than asked, that make up a period.
pub(crate) fn substeps_of(period: f64, step: f64) -> f64 {
    // A step that fits to rounding must not be halved.
    (period / step * (1.0 - 1e-9)).ceil().max(1.0)
}
