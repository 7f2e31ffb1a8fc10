//! How much work a run is, known before it begins.

/// Internal steps of the plant beyond which a run is refused: at a million a
/// second, three hours.
pub const MOST_STEPS: f64 = 1e10;

/// Greatest number of internal steps of a control period.
pub(crate) const MOST_SUBSTEPS: u32 = 10_000;

/// Sampling instants from the start of a motion of `duration` to its end, both
/// included.
pub(crate) fn cycles_of(duration: f64, period: f64) -> f64 {
    (duration / period * (1.0 + 1e-12)).floor().max(0.0) + 1.0
}

/// Number of equal steps, none longer than asked, that make up a period.
pub(crate) fn substeps_of(period: f64, step: f64) -> f64 {
    // A step that fits to rounding must not be halved.
    (period / step * (1.0 - 1e-9)).ceil().max(1.0)
}
