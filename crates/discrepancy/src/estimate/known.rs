//! Parameters that the axis file gives, and that may be off by its tolerances.

use axis_sim::Axis;

/// Name of a parameter in reports.
pub fn shown(name: &str) -> String {
    name.replace('_', "-")
}

/// How far each known parameter may be off, as a share, in the order of [`Axis::known`].
pub fn tolerances(axis: &Axis) -> Vec<f64> {
    axis.known_tolerances()
}

/// Standard deviation of a known parameter's departure: that of a uniform
/// distribution over its tolerance.
pub fn known_deviations(axis: &Axis) -> Vec<f64> {
    let all = tolerances(axis).into_iter();
    all.map(|tolerance| tolerance / 3f64.sqrt()).collect()
}

/// Which known parameters are at the edge of their tolerance: they cannot move
/// on, whatever a linearised problem would like.
pub fn pinned(axis: &Axis, shares: &[f64]) -> Vec<bool> {
    let all = shares.iter().zip(tolerances(axis));
    all.map(|(share, tolerance)| share.abs() >= 0.999 * tolerance)
        .collect()
}
