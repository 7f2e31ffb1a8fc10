//! Logs from files, frames, runs and arrays.

use std::path::PathBuf;

use axis_log::intake::{Options, files, prepare, prepare_channels};
use axis_log::{Channel, TIME_CHANNEL};
use axis_sim::Axis;
use discrepancy::logs::{NamedLog, admit, exact_channels, most_samples, needed_channels};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::arrays::samples;
use crate::errors::{LogError, raise};

/// A log as a caller gives it, and what was done to it, in words.
///
/// A path is read as the axis' `[log]` maps its columns, several with `+` between them as one log. A pandas or polars frame, a Run, or a
/// dict of arrays has its columns named as channels, `t_s` among them, and NaN if there is no value.
pub(crate) fn log_of(
    given: &Bound<'_, PyAny>,
    name: &str,
    axis: &Axis,
    notes: &mut Vec<String>,
) -> PyResult<NamedLog> {
    let (needed, exact) = (needed_channels(axis), exact_channels(axis));
    let options = Options {
        exact: &exact,
        rate_hz: None,
        most_samples: most_samples(axis),
    };
    let (name, prepared) = match given.extract::<PathBuf>() {
        Ok(path) => (
            path.display().to_string(),
            prepare(&files(&path), &axis.log, &needed, options),
        ),
        Err(_) => (
            name.to_owned(),
            prepare_channels(name, columns(given)?, &needed, options),
        ),
    };
    let prepared = prepared.map_err(raise::<LogError>)?;
    notes.extend(prepared.done.iter().map(ToString::to_string));
    admit(name, prepared.log, axis, notes).map_err(raise::<LogError>)
}

/// The columns of a frame, a mapping or a Run.
fn columns(given: &Bound<'_, PyAny>) -> PyResult<Vec<Channel>> {
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
    let mut names: Vec<String> = (names.try_iter()?)
        .map(|name| name?.extract())
        .collect::<PyResult<_>>()?;
    // Time stands first in a log.
    names.sort_by_key(|name| name != TIME_CHANNEL);
    let channels = names.into_iter().map(|name| {
        let column: Bound<'_, PyAny> = given.get_item(&name)?;
        let samples = samples::<LogError>(&column, &name)?;
        Channel::new(name, samples).map_err(raise::<LogError>)
    });
    channels.collect()
}
