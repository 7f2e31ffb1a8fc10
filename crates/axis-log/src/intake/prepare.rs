//! Files to a log.

use std::path::{Path, PathBuf};

use super::done::Done;
use super::error::IntakeError;
use super::join::join;
use super::recording::Recording;
use super::repair::{bridged, take_out};
use super::unwrapped::unwrapped;
use crate::channel::Channel;
use crate::log::{Log, TIME_CHANNEL};
use crate::mapping::Mapping;

/// What is done to files besides reading them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options<'a> {
    /// Channels that are commands and not measured: nothing in them is an outlier, nor is what others do in the ten samples
    /// after a pulse in them.
    pub exact: &'a [&'a str],
    /// Rate of the joined log, Hz; `None` for that of the slowest file. Of a single file
    /// it means a resampling.
    pub rate_hz: Option<f64>,
    /// Most samples of the log where no rate is asked for: a longer one is resampled to a whole
    /// part of its rate. `None` for any number.
    pub most_samples: Option<usize>,
}

/// A log, and what was done to it.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedLog {
    /// The log.
    pub log: Log,
    /// What was done, in its order.
    pub done: Vec<Done>,
}

/// The files of a path that joins them with `+`, unless there is a file of that very name.
pub fn files(path: &Path) -> Vec<PathBuf> {
    match path.to_str() {
        Some(text) if !path.exists() => text.split('+').map(PathBuf::from).collect(),
        _ => vec![path.to_owned()],
    }
}

/// Reads files as one log. [The module](super) tells the steps.
///
/// Several files are resampled on the grid that begins where the last of them begins and
/// ends where the first ends. Where a rate falls, a windowed sinc without phase takes out
/// what is above 0.54 of the new rate and keeps what is below 0.36 of it; else it keeps what
/// is below 0.41 of a channel's own rate. A sample that rests on missing ones is missing. The
/// delay of a file against the first is found where both have a channel of one name, or one
/// has the derivative of the other's (`position` and `velocity` or `speed`, likewise
/// `angle`), which correlate above 0.95: the peak of the cross-correlation by a parabola,
/// refined by least squares, with its standard error. It is taken out unless a column of
/// either file has a delay of its own; where it cannot be found, [`Done::DelayUnknown`]
/// says so. Clocks must agree to half of the time that the files share.
///
/// # Errors
/// An [`IntakeError`]: a file that cannot be read ([`read_log`](crate::read_log), except
/// that missing values and rows are taken), a required channel that none has, time stamps
/// without any even grid where something is resampled, no time in
/// common, a rate above that of all files.
pub fn prepare<P: AsRef<Path>>(
    paths: &[P],
    mapping: &Mapping,
    required: &[&str],
    options: Options<'_>,
) -> Result<PreparedLog, IntakeError> {
    let is_alone = paths.len() == 1;
    let alone: &[&str] = if is_alone { required } else { &[] };
    let read = |path: &P| Recording::read(path.as_ref(), mapping, alone, is_alone);
    let parts: Result<_, _> = paths.iter().map(read).collect();
    prepared(parts?, required, options)
}

/// As [`prepare`], of channels that are there already under the `name` that messages give them,
/// as a table of a program has them: the time first, NaN if there is no value.
///
/// # Errors
/// As [`prepare`]; [`IntakeError::Log`] if the channels are not of one length, the time does
/// not rise, or a value is infinite.
pub fn prepare_channels(
    name: &str,
    channels: Vec<Channel>,
    required: &[&str],
    options: Options<'_>,
) -> Result<PreparedLog, IntakeError> {
    let filled = |(place, channel): (usize, &Channel)| {
        let mut channel = channel.clone();
        if place > 0 {
            let holes = channel.samples.iter_mut().filter(|v| v.is_nan());
            holes.for_each(|v| *v = 0.0);
        }
        channel
    };
    // All that a log asks for, but that every value is there.
    Log::new(channels.iter().enumerate().map(filled).collect()).map_err(|problem| {
        IntakeError::Log {
            file: name.to_owned(),
            problem,
        }
    })?;
    let mut channels = channels;
    let done = unwrapped(&mut channels, |_| 1.0);
    let part = Recording::of(name.to_owned(), channels, |_| 0.0)?;
    prepared(vec![Recording { done, ..part }], required, options)
}

/// Recordings made one log.
fn prepared(
    mut parts: Vec<Recording>,
    required: &[&str],
    options: Options<'_>,
) -> Result<PreparedLog, IntakeError> {
    let mut done = Vec::new();
    for part in &mut parts {
        let (file, [rows, gaps]) = (part.name.clone(), part.missing);
        done.append(&mut part.done);
        done.extend(part.evened.take());
        if gaps > 0 {
            done.push(Done::Rows { file, rows, gaps });
        }
        take_out(part, options.exact, &mut done);
    }
    let names: Vec<&str> = parts.iter().map(|p| p.name.as_str()).collect();
    let file = names.join(" + ");
    let slower = options
        .most_samples
        .and_then(|most| slowed(&parts, most, &mut done));
    let rate = options.rate_hz.or(slower);
    let single = parts.len() == 1 && rate.is_none();
    let channels = match parts.pop() {
        None => return Err(IntakeError::None),
        Some(part) if single && part.delays.iter().all(|&d| d == 0.0) => as_it_is(part),
        Some(part) => {
            parts.push(part);
            join(parts, rate, &mut done)?
        }
    };
    let log = into_log(channels, &mut done).and_then(|log| {
        required
            .iter()
            .try_for_each(|name| log.channel(name).map(drop))?;
        Ok(log)
    });
    match log {
        Ok(log) => Ok(PreparedLog { log, done }),
        Err(problem) => Err(IntakeError::Log { file, problem }),
    }
}

/// A whole part of the slowest recording's rate at which it has no more samples than these; `None`
/// if it has no more.
fn slowed(parts: &[Recording], most: usize, done: &mut Vec<Done>) -> Option<f64> {
    let of = |part: &Recording| Some((part.grid?.period, part.time.len(), part.name.clone()));
    let slowest = parts.iter().filter_map(of);
    let (period, samples, file) = slowest.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let parts = samples.div_ceil(most.max(1));
    (parts > 1).then(|| {
        let rates = [1.0 / period, 1.0 / (period * parts as f64)];
        done.push(Done::Slowed {
            file,
            samples,
            rates,
        });
        rates[1]
    })
}

fn as_it_is(part: Recording) -> Vec<Channel> {
    let time = Channel {
        name: TIME_CHANNEL.to_owned(),
        unit: "s".to_owned(),
        samples: part.time,
    };
    std::iter::once(time).chain(part.channels).collect()
}

fn into_log(mut channels: Vec<Channel>, done: &mut Vec<Done>) -> Result<Log, crate::LogError> {
    let mut marks = Vec::new();
    if let Some((time, others)) = channels.split_first_mut() {
        for channel in others {
            marks.push((channel.name.clone(), bridged(channel, &time.samples, done)));
        }
    }
    let mut log = Log::new(channels)?;
    for (name, holes) in marks {
        log.mark_missing(&name, holes)?;
    }
    Ok(log)
}
