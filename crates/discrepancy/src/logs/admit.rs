//! A log as it is taken into a search, or refused.

use axis_log::Log;
use axis_log::quality::CrossCheckVerdict;
use axis_sim::{Axis, needed_position};

use super::apart::NamedLog;
use super::checks::check_log;
use super::error::LogSetError;
use super::relations::cross_checks;
use super::start::from_rest;

/// The channels without which logs cannot be compared with this machine. None for a torque
/// balance, which says itself what it needs.
pub fn needed_channels(machine: &Axis) -> Vec<&'static str> {
    match machine.has_control() {
        true => {
            let position = needed_position(machine).into_iter();
            [machine.reference_channel()]
                .into_iter()
                .chain(position)
                .collect()
        }
        false => Vec::new(),
    }
}

/// Samples of a log that a torque balance takes: ten minutes at 1 kHz. What it compares is slow (at
/// a tenth of the rate and below), and what the library does is worked out along every sample.
const BALANCED: usize = 600_000;

/// Most samples of a log for this machine ([`axis_log::intake::Options`]); `None` for any number: a
/// replay goes at the controller's own rate.
pub fn most_samples(machine: &Axis) -> Option<usize> {
    (!machine.has_control()).then_some(BALANCED)
}

/// Looks at a log and takes it from its first standstill on. What must be known of it goes to
/// `notes`: channels that agree only nearly, and what was cut away.
///
/// # Errors
/// [`LogSetError`] as [`check_log`] and [`from_rest`] give it.
pub fn admit(
    name: String,
    log: Log,
    machine: &Axis,
    notes: &mut Vec<String>,
) -> Result<NamedLog, LogSetError> {
    let period = check_log(&name, &log, machine)?;
    let findings = cross_checks(&log, machine).into_iter();
    let unclear = findings.filter(|finding| finding.verdict == CrossCheckVerdict::Unclear);
    notes.extend(unclear.map(|finding| format!("{name}: check this: {finding}")));
    let (log, note) = from_rest(&name, log, period, machine)?;
    notes.extend(note);
    Ok((name, log, period))
}
