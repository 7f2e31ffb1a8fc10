//! What a model lacks, from logs.

use std::sync::Arc;

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, OnsetForm};
use discrepancy::logs::{NamedLog, check_distinct, set_apart};
use discrepancy::{LogSet, Settings, discovery, search};
use pyo3::prelude::*;
use toml::{Table, Value};

use crate::axis::PyAxis;
use crate::discovery::Discovery;
use crate::errors::{AxisError, LogError, SearchError, raise};
use crate::log::log_of;
use crate::long::{Hook, long};

/// Finds what an axis' model lacks beside measured logs.
///
/// `fit` are logs to fit to, `check` logs of other motion on which what is named must prove
/// itself, `test` logs that take no part in any choice, for the figures. Each log is a path, a
/// pandas or polars frame, a Run, or a dict of arrays with channels as names.
/// `progress(what, stage, None)`.
///
/// Ctrl-C raises at once; the search itself ends at its next stage.
#[pyfunction]
#[pyo3(signature = (axis, fit, check, *, test = Vec::new(), accept = Vec::new(), reject = Vec::new(), balance = false, progress = None))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn discover(
    py: Python<'_>,
    axis: PyRef<'_, PyAxis>,
    fit: Vec<Bound<'_, PyAny>>,
    check: Vec<Bound<'_, PyAny>>,
    test: Vec<Bound<'_, PyAny>>,
    accept: Vec<String>,
    reject: Vec<String>,
    balance: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Discovery> {
    let mut machine = (*axis.axis).clone();
    if balance {
        machine = machine.without_control().map_err(raise::<AxisError>)?;
    }
    let settings = Settings {
        accepted: accept,
        rejected: reject,
        ..Settings::default()
    };
    settings.check(&machine).map_err(raise::<SearchError>)?;
    let mut notes = Vec::new();
    let mut read = |kind: &str, logs: &[Bound<'_, PyAny>]| -> PyResult<Vec<NamedLog>> {
        let one = |(i, log)| log_of(log, &format!("{kind} {}", i + 1), &machine, &mut notes);
        logs.iter().enumerate().map(one).collect()
    };
    let logs = [
        read("fit", &fit)?,
        read("check", &check)?,
        read("test", &test)?,
    ];
    let (text, machine) = (axis.text.clone(), Arc::new(machine));
    let (discovery, text) = long(py, progress, move |hook| {
        let (mut found, effects) = searched(&machine, logs, &settings, hook)?;
        notes.append(&mut found.notes);
        found.notes = notes;
        Ok((found, with_effects(text, &effects)?))
    })?;
    Discovery::new(discovery, text)
}

/// The search, as the command makes it.
fn searched(
    machine: &Axis,
    [fit, check, test]: [Vec<NamedLog>; 3],
    settings: &Settings,
    hook: &Hook,
) -> PyResult<(discrepancy::Discovery, Vec<ActiveEffect>)> {
    for (seen, new) in [(&fit, &check), (&fit, &test), (&check, &test)] {
        check_distinct(seen, new).map_err(raise::<LogError>)?;
    }
    let (check, test) = match test.is_empty() {
        true => set_apart(check, machine),
        false => (check, test),
    };
    let set = |logs| LogSet::new(logs, machine).map_err(raise::<LogError>);
    let (fit, check) = (set(fit)?, set(check)?);
    let test = (!test.is_empty()).then(|| set(test)).transpose()?;
    let mut stage = 0;
    let mut found = search(machine, &fit, &check, settings, |what| {
        stage += 1;
        hook.stage(what, stage);
    })
    .map_err(raise::<SearchError>)?;
    if let Some(test) = test {
        found = found.tested_on(machine, test);
    }
    hook.stage("verdict", stage + 1);
    let told = discovery(machine, &fit, &check, &found).map_err(raise::<SearchError>)?;
    let effects = found.fit.state.effects.into_iter();
    // A form of the axis' own friction has no entry in a file.
    let effects = effects.filter(|active| OnsetForm::of(active).is_none());
    Ok((told.discovery, effects.collect()))
}

/// The text of an axis file with these effects added.
fn with_effects(text: String, effects: &[ActiveEffect]) -> PyResult<String> {
    if effects.is_empty() {
        return Ok(text);
    }
    let mut table: Table = text.parse().map_err(raise::<AxisError>)?;
    let all = table.entry("effects").or_insert(Value::Array(Vec::new()));
    if let Value::Array(all) = all {
        for active in effects {
            let mut entry = Table::new();
            entry.insert("name".to_owned(), active.effect.name.into());
            for (parameter, value) in active.effect.parameters.iter().zip(&active.values) {
                entry.insert(parameter.name.to_owned(), (*value).into());
            }
            all.push(Value::Table(entry));
        }
    }
    Ok(table.to_string())
}
