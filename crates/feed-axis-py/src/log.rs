//! Logs from files, frames, runs and arrays.

use std::path::PathBuf;

use axis_log::intake::{Options, files, prepare, prepare_channels};
use axis_log::{Channel, Log, TIME_CHANNEL};
use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, CHANNELS, LogChannel, commanded_channels};
use discrepancy::logs::{NamedLog, admit, most_samples, needed_channels};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyMapping, PyTuple};

use crate::arrays::{key, samples};
use crate::errors::{LogError, raise, readable};
use crate::run::Run;

/// A log as a caller gives it, and what was done to it, in words.
///
/// A path is read as the axis' `[log]` maps its columns, several with `+` between them as one log. A pandas or polars frame, a Run, or a
/// dict of arrays has its columns named as channels, `t_s` among them, and NaN if there is no value.
pub(crate) fn log_of(
    given: &Given<'_, '_>,
    axis: &Axis,
    notes: &mut Vec<String>,
) -> PyResult<NamedLog> {
    let (name, log) = given.whole(axis, &needed_channels(axis), notes)?;
    admit(name, log, axis, notes).map_err(raise::<LogError>)
}

/// What was passed as a log.
pub(crate) struct Given<'a, 'py> {
    pub value: &'a Bound<'py, PyAny>,
    /// Its name in messages, unless it is a path.
    pub name: &'a str,
    pub columns: &'a Renamed,
}

impl Given<'_, '_> {
    /// The log with channels that it must have, and nothing asked of its motion.
    pub(crate) fn whole(
        &self,
        axis: &Axis,
        needed: &[&str],
        notes: &mut Vec<String>,
    ) -> PyResult<(String, Log)> {
        let exact: Vec<&str> = commanded_channels().collect();
        let options = Options {
            exact: &exact,
            rate_hz: None,
            most_samples: most_samples(axis),
        };
        self.whole_by(axis, needed, options, notes)
    }

    /// The same, made ready as `options` say.
    pub(crate) fn whole_by(
        &self,
        axis: &Axis,
        needed: &[&str],
        options: Options<'_>,
        notes: &mut Vec<String>,
    ) -> PyResult<(String, Log)> {
        let (name, prepared) = match self.value.extract::<PathBuf>() {
            Ok(path) => {
                let files = files(&path);
                for file in &files {
                    readable(self.value.py(), file)?;
                }
                (
                    path.display().to_string(),
                    prepare(&files, &axis.log, needed, options),
                )
            }
            Err(_) => {
                let channels = columns(self.value, self.name, self.columns)?;
                (
                    self.name.to_owned(),
                    prepare_channels(self.name, channels, needed, options),
                )
            }
        };
        let prepared = prepared.map_err(raise::<LogError>)?;
        notes.extend(prepared.done.iter().map(ToString::to_string));
        Ok((name, prepared.log))
    }
}

/// A log, or each of a list or tuple of them.
pub(crate) fn each_log<'py>(logs: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
    match logs.is_instance_of::<PyList>() || logs.is_instance_of::<PyTuple>() {
        true => logs.try_iter()?.collect(),
        false => Ok(vec![logs.clone()]),
    }
}

/// Columns of frames and dicts that have other names than their channels: column, channel, and
/// the factor to the channel's unit.
#[derive(Default)]
pub(crate) struct Renamed(Vec<(String, String, f64)>);

impl FromPyObject<'_, '_> for Renamed {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let valid = "valid: a dict from column to channel, or to (channel, factor)";
        let refused = |thing: &Bound<'_, PyAny>, what: &str| {
            let kind = thing.get_type().name();
            let kind = kind.map_or_else(|_| "thing".to_owned(), |kind| kind.to_string());
            PyTypeError::new_err(format!("{what} is a {kind}; {valid}"))
        };
        let pairs = given.cast::<PyMapping>();
        let pairs = pairs.map_err(|_| refused(&given, "columns"))?.items()?;
        let one = |pair: Bound<'_, PyAny>| {
            let (column, channel): (Bound<'_, PyAny>, Bound<'_, PyAny>) = pair.extract()?;
            let column = key(&column, "columns")?;
            if let Ok(channel) = channel.extract::<String>() {
                return Ok((column, channel, 1.0));
            }
            let pair = channel.extract::<(String, f64)>();
            let (name, factor) = pair.map_err(|_| refused(&channel, &format!("{column:?}")))?;
            Ok((column, name, factor))
        };
        pairs.iter().map(one).collect::<PyResult<_>>().map(Self)
    }
}

/// The columns of a frame, a mapping or a Run as channels, the time first.
pub(crate) fn columns(
    given: &Bound<'_, PyAny>,
    log: &str,
    renamed: &Renamed,
) -> PyResult<Vec<Channel>> {
    let names = match given.getattr_opt("columns")? {
        Some(columns) => columns,
        None if given.hasattr("keys")? => given.call_method0("keys")?,
        None => {
            return Err(PyTypeError::new_err(format!(
                "a {} is no log; valid: a path, a pandas or polars DataFrame, a Run, a dict of arrays",
                given.get_type().name()?
            )));
        }
    };
    let names: Vec<String> = (names.try_iter()?)
        .map(|name| key(&name?, log))
        .collect::<PyResult<_>>()?;
    let missing = renamed
        .0
        .iter()
        .find(|(column, ..)| !names.contains(column));
    // A Run has its channels' names already.
    let is_own = given.is_instance_of::<Run>();
    if let Some((column, ..)) = missing.filter(|_| !is_own) {
        return Err(LogError::new_err(format!(
            "{log} has no column {column:?}, of which columns speaks; it has: {}",
            names.join(", ")
        )));
    }
    // Column, channel, factor.
    let mut all: Vec<(String, String, f64)> = match is_own {
        true => Vec::new(),
        false => renamed.0.clone(),
    };
    for name in names {
        let is_mapped = all.iter().any(|(column, ..)| *column == name);
        // Where columns are named, others count by their own names if these are channels'.
        let counts = renamed.0.is_empty() || is_own || is_channel(&name);
        if !is_mapped && counts {
            all.push((name.clone(), name, 1.0));
        }
    }
    all.sort_by_key(|(_, channel, _)| channel != TIME_CHANNEL);
    let channels = all.into_iter().map(|(column, channel, factor)| {
        let samples = samples::<LogError>(&given.get_item(&column)?, &column)?;
        let samples = samples.into_iter().map(|x| factor * x).collect();
        Channel::new(channel, samples).map_err(|error| match renamed.0.is_empty() {
            true => LogError::new_err(format!(
                "{log}: {error}; or say which columns are which channels: columns={{{column:?}: ...}}"
            )),
            false => raise::<LogError>(error),
        })
    });
    channels.collect()
}

/// Whether a log of any axis has a channel of that name.
fn is_channel(name: &str) -> bool {
    let of = |freedom| move |c: &LogChannel| c.of_freedom(freedom)[0] == name;
    name == TIME_CHANNEL
        || CHANNELS.iter().any(of(Freedom::Linear))
        || CHANNELS.iter().any(of(Freedom::Rotary))
}
