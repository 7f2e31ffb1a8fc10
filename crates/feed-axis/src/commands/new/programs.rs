//! Two motions of an axis, there and back: what `discover` asks for to fit to, and to check on.

use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, SixDigits};

/// A motion: its name after that of the axis, what it is for, and its size and speed as shares of
/// those of the first trajectory.
pub const PROGRAMS: [(&str, &str, [f64; 2]); 2] = [
    ("fit", "to record the log to fit to", [1.0, 1.0]),
    (
        "check",
        "shorter and slower: to record the log to check on",
        [0.8, 0.5],
    ),
];

/// Standstill before, between and behind the moves, s: twice what `discover` needs.
const DWELL: f64 = 0.4;

/// The text of a motion program of these shares; none of an axis without trajectories.
pub fn program(axis: &Axis, purpose: &str, [size, speed]: [f64; 2]) -> Option<String> {
    let spec = axis.trajectories.first()?;
    let (unit, scale) = match axis.freedom() {
        Freedom::Linear => ("mm", 1e3),
        Freedom::Rotary => ("deg", 180.0 / std::f64::consts::PI),
    };
    // Of the conversion, not of the file: 0.3 m is 300 mm.
    let shown = |value: f64| SixDigits((1e9 * scale * value).round() / 1e9);
    let step = |by: f64| {
        format!(
            "[[steps]]\nmove_by = {{ by_{unit} = {}, velocity_{unit}_s = {}, acceleration_{unit}_s2 = {}, jerk_{unit}_s3 = {} }}\n",
            shown(by),
            shown(speed * spec.limits.velocity()),
            shown(spec.limits.acceleration()),
            shown(spec.limits.jerk())
        )
    };
    let dwell = format!("[[steps]]\ndwell = {{ duration_s = {DWELL} }}\n");
    let by = size * spec.displacement;
    Some(format!(
        "# There and back, {purpose}.\nstart_{unit} = {}\n\n{dwell}\n{}\n{dwell}\n{}\n{dwell}",
        shown(axis.stroke.start),
        step(by),
        step(-by)
    ))
}
