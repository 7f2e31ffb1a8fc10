//! What a model lacks, from logs.

use std::sync::Arc;

use axis_sim::Axis;
use axis_sim::effects::Scales;
use discrepancy::logs::NamedLog;
use discrepancy::{Evidence, Found, Settings};
use pyo3::prelude::*;
use toml::Table;

use crate::arrays::{Logs, Names};
use crate::axis::PyAxis;
use crate::discovery::Discovery;
use crate::errors::{AxisError, LogError, SearchError, raise};
use crate::log::{Given, Renamed, log_of};
use crate::long::long;

/// Finds what an axis' model lacks beside measured logs.
///
/// `fit` are logs to fit to, `check` logs of other motion on which what is named must prove
/// itself, `test` logs that take no part in any choice, for the figures. Each log is a path, a
/// pandas or polars frame, a Run, or a dict of arrays with channels as names.
/// `columns` has names of columns of frames and dicts with the channels that they are.
/// `progress(what, stage, None)`.
///
/// Ctrl-C raises at once; the search itself ends at its next stage.
#[pyfunction]
#[pyo3(signature = (axis, fit, check, *, test = Logs(Vec::new()), accept = Names(Vec::new()), reject = Names(Vec::new()), balance = false, columns = Renamed::default(), progress = None))]
pub(crate) fn discover(
    py: Python<'_>,
    axis: PyRef<'_, PyAxis>,
    fit: Logs<'_>,
    check: Logs<'_>,
    test: Logs<'_>,
    accept: Names,
    reject: Names,
    balance: bool,
    columns: Renamed,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Discovery> {
    for (kind, logs) in [("fit", &fit.0), ("check", &check.0)] {
        if logs.is_empty() {
            return Err(LogError::new_err(format!(
                "{kind} holds no log; valid: one at least"
            )));
        }
    }
    let mut machine = (*axis.axis).clone();
    if balance {
        machine = machine.without_control().map_err(raise::<AxisError>)?;
    }
    let settings = Settings {
        accepted: accept.0,
        rejected: reject.0,
        ..Settings::default()
    };
    settings.check(&machine).map_err(raise::<SearchError>)?;
    let mut notes = Vec::new();
    let mut read = |kind: &str, logs: &[Bound<'_, PyAny>]| -> PyResult<Vec<NamedLog>> {
        let one = |(i, log)| {
            let name = format!("{kind} {}", i + 1);
            let given = Given {
                value: log,
                name: &name,
                columns: &columns,
            };
            log_of(&given, &machine, &mut notes)
        };
        logs.iter().enumerate().map(one).collect()
    };
    let logs = [
        read("fit", &fit.0)?,
        read("check", &check.0)?,
        read("test", &test.0)?,
    ];
    let [fit, check, test] = logs;
    let (text, machine) = (axis.text.clone(), Arc::new(machine));
    let (discovery, text, page) = long(py, progress, move |hook| {
        let evidence = Evidence::new(&machine, fit, check, test).map_err(raise::<LogError>)?;
        let mut stage = 0;
        let tell = |what: &str| {
            stage += 1;
            hook.stage(what, stage);
        };
        let searched = evidence.discover(&machine, &settings, tell);
        let (found, mut told) = searched.map_err(raise::<SearchError>)?;
        notes.append(&mut told.discovery.notes);
        told.discovery.notes = notes;
        let page = feed_axis::discovery_page(&told);
        let page = page.map_err(|error| SearchError::new_err(error.to_string()))?;
        let text = with_effects(text, &machine, &found)?;
        Ok((told.discovery, text, page))
    })?;
    Discovery::new(discovery, text, page)
}

/// The text of an axis file with the effects that were found.
fn with_effects(mut text: String, machine: &Axis, found: &Found) -> PyResult<String> {
    let mut table: Table = text.parse().map_err(raise::<AxisError>)?;
    // A list in line takes no further table: written anew, it is tables or, empty, nothing.
    if let Some(effects) = table.get("effects") {
        if effects.as_array().is_some_and(Vec::is_empty) {
            table.remove("effects");
        }
        text = table.to_string();
    }
    let scales = Scales::of(machine);
    let effects = found.effects_for_file();
    text.extend(effects.map(|active| active.entry(&scales, |value| format!("{value:e}"))));
    Ok(text)
}
