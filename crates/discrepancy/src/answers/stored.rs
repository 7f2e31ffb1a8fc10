//! What a log's start has stored: force in the bristles, charge in the integrator.
//!
//! At rest the drive and the bristles hold all loads together,
//!
//! ```text
//! T(command) / r = Σ loads + F(bristles),     |F(bristles)| ≤ break-away
//! ```
//!
//! (r: travel per radian.) The command at rest is logged, mostly, so that the share of the
//! bristles follows from it and from the loads of whatever model is tried: it is a state of
//! the log, no unknown of the machine. A log whose command comes up at its beginning was
//! begun together with what acts on it, and has nothing stored.

use axis_log::Log;
use axis_sim::{
    Axis, ChannelPart, ClosedLoop, Replay, Stored, channels, position_shown, reference_in,
};
use trajectories::Motion;

use super::effort::of_drive;

/// Shortest rest that tells what is stored, s: loads come up over 20 ms.
const SHORTEST: f64 = 0.04;

/// Time over which the beginning of a log is looked at, s.
const BEGINNING: f64 = 0.003;

/// Share of the reference's way that is no motion: of files, and of the end of a curve.
const STILL: f64 = 1e-7;

/// Longest part of a standstill that is looked at, s.
const LONGEST: f64 = 2.0;

/// Standard deviations of a mean beyond which it is not chance.
const DEVIATIONS: f64 = 8.0;

/// Time over which noise in a loop remembers itself, s: samples nearer than that are one.
const MEMORY: f64 = 1e-3;

/// Share of the command of a standstill, against what the axis' own loads ask for, that its
/// beginning shows at most where what acts came up with the log.
const COMES_UP: f64 = 0.3;

/// Largest part of a standstill's power that its beginning may have, as that of the rest of it,
/// where nothing happens there.
const QUIET: f64 = 4.0;

/// Tells a replay what its log has stored at its start, by the machine as its file says
/// (`closed_loop`); and the command with which the drive may have held the axis, or not, where
/// the first samples are too noisy to tell.
pub(super) fn storing(
    replay: Replay,
    log: &Log,
    period: f64,
    closed_loop: &ClosedLoop,
) -> (Replay, Option<f64>) {
    let control = &closed_loop.axis().control;
    if !control.integrates() || control.starts_in_motion() {
        return (replay, None);
    }
    let Some(rest) = first_rest(log, period) else {
        return (replay, None);
    };
    let few = ((BEGINNING / period).round() as usize).max(2);
    let (stored, tells) = match command(log, closed_loop.axis(), rest) {
        Some(command) => {
            let position = replay.reference().at(0.0).position;
            by_command(command, few, MEMORY / period, closed_loop, position)
        }
        None => (by_position(log, closed_loop.axis(), rest, few), true),
    };
    tracing::debug!(?stored, tells, rest, "start of a log");
    let doubtful = match stored {
        Stored::Effort(effort) if !tells => Some(effort),
        _ => None,
    };
    (replay.storing(stored), doubtful)
}

/// Command that the drive holds at the start of a replay, in the actuator's unit; `None` if
/// that is not what is stored.
pub(super) fn held_effort(replay: &Replay) -> Option<f64> {
    match replay.stored() {
        Stored::Effort(effort) => Some(effort),
        _ => None,
    }
}

/// How well a log shows the command of the standstill that it begins with.
#[derive(Clone, Copy, Debug)]
pub(super) struct EffortShown {
    /// Noise, RMS, or one step of a coarser command, in the actuator's unit.
    pub(super) noise: f64,
    /// Whether the command is coarser than its noise: the mean of a standstill is then off by what
    /// it
    /// was rounded by.
    pub(super) is_coarse: bool,
    /// Most by which the mean of the standstill may be off: three standard deviations of the means of parts of its second half, as noise that
    /// is slow for one part may be slow for all of it; half a step of a coarse command.
    pub(super) reach: f64,
}

/// Parts of half a standstill whose means show how slow its noise is.
const PARTS: usize = 8;

/// How well a log shows the command of its first standstill; `None` if it has no such rest, or
/// does
/// not show the command.
pub(super) fn effort_shown(log: &Log, period: f64, machine: &Axis) -> Option<EffortShown> {
    let rest = first_rest(log, period)?;
    let whole = command(log, machine, log.len().max(rest));
    let command = whole.or_else(|| command(log, machine, rest))?;
    // What an earlier move has left dies away in the first half.
    let late = &command[rest / 2..rest];
    let noise = power(late).sqrt();
    let changes = command.windows(2).map(|w| (w[1] - w[0]).abs());
    let least = 1e-9 * machine.actuator.limit().min(1e9);
    let step = changes.filter(|by| *by > least).fold(f64::MAX, f64::min);
    let step = if step < f64::MAX { step } else { 0.0 };
    let parts = late.chunks(late.len().div_ceil(PARTS).max(1));
    let means: Vec<f64> = parts.map(mean).collect();
    let is_coarse = step > noise;
    let of_step = if is_coarse { 0.5 * step } else { 0.0 };
    Some(EffortShown {
        noise: noise.max(step),
        is_coarse,
        reach: f64::max(3.0 * power(&means).sqrt(), of_step),
    })
}

/// Samples until the reference first moves, where they are enough.
fn first_rest(log: &Log, period: f64) -> Option<usize> {
    let reference = reference_in(log).ok()?;
    let ends = reference
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    let still = |x: &&f64| (**x - reference[0]).abs() <= STILL * (ends.1 - ends.0);
    let samples = reference.iter().take_while(still).count();
    let longest = (LONGEST / period) as usize;
    (samples as f64 * period >= SHORTEST).then(|| samples.min(longest))
}

/// What the log shows of the drive's command in its first samples, in the actuator's unit.
fn command<'a>(log: &'a Log, machine: &Axis, rest: usize) -> Option<&'a [f64]> {
    let own = channels(machine).into_iter();
    let own = own.filter(|c| matches!(c.part, ChannelPart::Sensed | ChannelPart::Made));
    let mut names = own.map(|c| c.name(machine));
    names.find_map(|name| {
        let whole = !log.missing(name).iter().any(|hole| hole.start < rest);
        let samples = log.channel(name).ok().filter(|_| whole)?;
        let shows = of_drive().any(|effort| effort == name);
        shows.then(|| &samples[..rest])
    })
}

fn mean(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len().max(1) as f64
}

/// Mean square about the mean.
fn power(samples: &[f64]) -> f64 {
    let mean = mean(samples);
    samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / samples.len().max(1) as f64
}

/// By the commands of a standstill, of which the first `few` are its beginning and `memory`
/// samples on end count as one; and whether its beginning tells.
fn by_command(
    rest: &[f64],
    few: usize,
    memory: f64,
    closed_loop: &ClosedLoop,
    position: f64,
) -> (Stored, bool) {
    let Ok(own) = closed_loop.resting_effort(position) else {
        return (Stored::Nothing, true);
    };
    let (begun, later) = rest.split_at(few);
    let late = &rest[rest.len() / 2..];
    let noise = power(late).sqrt();
    let chance = |samples: usize| {
        let independent = samples as f64 / memory.max(1.0);
        DEVIATIONS * noise / independent.max(1.0).sqrt()
    };
    let (first, level) = (mean(begun), mean(later));
    // What a file with few digits shows is off by its rounding.
    let least = 1e-9 * closed_loop.axis().actuator.limit().min(1e9);
    let [begins, stands] = [first - own, level - own].map(f64::abs);
    if begins <= chance(few).max(least) && stands <= chance(later.len()).max(least) {
        return (Stored::InBristles, true);
    }
    if begins <= COMES_UP * stands && stands > chance(few).max(least) {
        return (Stored::Nothing, true);
    }
    // What an earlier move has left dies away.
    let dies = (first - level).abs() > chance(few).max(COMES_UP * stands);
    let effort = Stored::Effort(if dies { first } else { mean(rest) });
    (effort, begins > chance(few).max(least))
}

/// Where no command is logged: a standstill in which nothing happens has something stored, and
/// what the bristles hold is to be found.
fn by_position(log: &Log, axis: &Axis, rest: usize, few: usize) -> Stored {
    let Ok(position) = position_shown(log, axis) else {
        return Stored::Nothing;
    };
    // Loads that come up move the load before the loop answers, within a few periods of it.
    let (begun, late) = (
        &position[..(15 * few).min(rest / 2)],
        &position[rest / 2..rest],
    );
    match power(begun) <= QUIET * power(late).max(f64::MIN_POSITIVE) {
        true => Stored::Share(0.0),
        false => Stored::Nothing,
    }
}
