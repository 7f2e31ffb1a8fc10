//! Logs that take no part in any choice of a search, for the figures that are reported.

use std::ops::Range;

use axis_log::Log;
use axis_sim::Axis;

use super::checks::check_log;
use super::standstill::Standstill;

/// Where in a log it may be cut, as shares of its length: the search proves what it names on
/// more than half of it.
const CUT: Range<f64> = 0.5..0.85;

/// Where it is cut best.
const BEST: f64 = 2.0 / 3.0;

/// A log with its name, itself and its sampling period, s.
pub type NamedLog = (String, Log, f64);

/// Splits check logs into those that a search proves on what it names, and those from which
/// only figures are taken: the last log, or of a single one what comes after a standstill of
/// reference and measured channels near two thirds of its length. Empty if neither is possible:
/// the figures then come from logs that took part.
pub fn set_apart(mut check: Vec<NamedLog>, machine: &Axis) -> (Vec<NamedLog>, Vec<NamedLog>) {
    let Some(last) = check.pop() else {
        return (check, Vec::new());
    };
    if !check.is_empty() {
        return (check, vec![last]);
    }
    match cut(&last, machine) {
        Some([before, after]) => (vec![before], vec![after]),
        None => (vec![last], Vec::new()),
    }
}

/// Both parts of a log, cut in the middle of a standstill, where each is sound by itself.
fn cut((name, log, period): &NamedLog, machine: &Axis) -> Option<[NamedLog; 2]> {
    let standstill = Standstill::of(log, *period, machine).ok();
    let standstill = standstill.filter(|_| machine.has_control())?;
    let rest = standstill.length;
    let length = log.len() as f64;
    let share = |at: usize| (at + rest / 2) as f64 / length;
    let mut rests = standstill.starts;
    rests.retain(|&at| CUT.contains(&share(at)));
    let off = |at: &usize| (share(*at) - BEST).abs();
    rests.sort_by(|a, b| off(a).total_cmp(&off(b)));
    // One try a standstill.
    let mut tried: Vec<usize> = Vec::new();
    rests.retain(|&at| {
        let new = tried.iter().all(|&other| at.abs_diff(other) > 2 * rest);
        if new {
            tried.push(at);
        }
        new
    });
    let at = |start: &usize| cut_at((name, log, *period), start + rest / 2, machine);
    rests.iter().find_map(at)
}

fn cut_at(
    (name, log, period): (&str, &Log, f64),
    at: usize,
    machine: &Axis,
) -> Option<[NamedLog; 2]> {
    let time = log.time()[at];
    let parts = [
        (
            format!("{name} up to {time:.3} s"),
            log.first(at).ok()?,
            period,
        ),
        (
            format!("{name} from {time:.3} s on"),
            log.skip(at).ok()?,
            period,
        ),
    ];
    let sound = |(name, log, _): &NamedLog| check_log(name, log, machine).is_ok();
    parts.iter().all(sound).then_some(parts)
}
