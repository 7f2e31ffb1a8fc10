//! Where a replay can begin in a log.

use axis_log::Log;
use axis_sim::{Axis, reference_in};

use super::checks::{LEAST_WAY, moved};
use super::error::LogSetError;
use super::standstill::{AT_REST, Standstill};

/// A log as a replay can begin it, and what was done for that, in words.
///
/// A ball-screw loop begins at rest: of a log that starts in motion, what lies
/// before the last 0.1 s of its first standstill of reference and measured channels is left
/// out. A rigid machine begins with the position and the speed of the log's first samples.
///
/// # Errors
/// [`LogSetError::NeverRests`].
pub fn from_rest(
    file: &str,
    log: Log,
    period: f64,
    machine: &Axis,
) -> Result<(Log, Option<String>), LogSetError> {
    // A torque balance begins with the measured motion.
    let reference = reference_in(&log).ok().filter(|_| machine.has_control());
    let Some(reference) = reference else {
        return Ok((log, None));
    };
    let few = ((START_TIME / period).round() as usize).clamp(1, reference.len().max(2) - 1);
    let speed = match reference.get(few) {
        Some(later) => (later - reference[0]) / (few as f64 * period),
        None => 0.0,
    };
    if speed.abs() <= AT_REST {
        return Ok((log, None));
    }
    if machine.control.starts_in_motion() {
        let words = format!(
            "{file} starts in motion; position and speed at its start ({speed:.4} m/s) are taken from its first samples"
        );
        return Ok((log, Some(words)));
    }
    let standstill = Standstill::of(&log, period, machine);
    let left = standstill.ok().and_then(|standstill| {
        let half = standstill.length / 2;
        let first = *standstill.starts.first()?;
        // The later in the standstill, the better the loop has settled.
        let middle = first + half;
        let steps = reference[middle..].windows(2);
        let still = steps.take_while(|w| (w[1] - w[0]).abs() <= AT_REST * period);
        let at = middle.max((middle + still.count()).saturating_sub(half));
        // So late that no move follows is as good as never.
        let moved = moved(&reference[at..]);
        moved.iter().any(|way| *way > LEAST_WAY).then_some(())?;
        Some((at, log.skip(at).ok()?))
    });
    match left {
        Some((at, left)) => {
            let from = log.time()[at];
            let words = format!(
                "{file} starts in motion ({speed:.4} m/s); what lies before its first standstill, at t = {from:.3} s, is left out"
            );
            Ok((left, Some(words)))
        }
        None => Err(LogSetError::NeverRests {
            file: file.to_owned(),
            speed,
        }),
    }
}

/// Over what time a log's first speed is taken, s.
const START_TIME: f64 = 5e-3;
