//! An unknown controller, from logs.

use discrepancy::controller::{Gain, estimate};
use discrepancy::logs::{NamedLog, check_distinct};
use feed_axis::commands::control_table::{spelling, with_control};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::Logs;
use crate::axis::PyAxis;
use crate::errors::{AxisError, LogError, SearchError, raise};
use crate::log::{Given, Renamed, log_of};
use crate::long::long;

/// Estimates structure, gains and delay of an unknown controller from logs: the axis with that
/// controller, and what was found.
#[pyfunction]
#[pyo3(signature = (axis, fit, check, *, frequency_hz = None, columns = Renamed::default()))]
pub(crate) fn identify_control<'py>(
    py: Python<'py>,
    axis: PyRef<'_, PyAxis>,
    fit: Logs<'_>,
    check: Logs<'_>,
    frequency_hz: Option<f64>,
    columns: Renamed,
) -> PyResult<(PyAxis, Bound<'py, PyDict>)> {
    let mut machine = (*axis.axis).clone();
    let [least, most] = axis_sim::FREQUENCIES;
    match frequency_hz {
        None if !machine.has_control() => {
            return Err(SearchError::new_err(
                "the axis has no [control], so nothing says how often the controller runs; valid: frequency_hz, such as frequency_hz=1000",
            ));
        }
        Some(hz) if !(least..=most).contains(&hz) => {
            return Err(SearchError::new_err(format!(
                "frequency_hz is {hz}; valid: from {least} to {most}"
            )));
        }
        Some(hz) => {
            machine.period = 1.0 / hz;
            machine.simulation.step = machine.simulation.step.min(5e-5);
        }
        None => {}
    }
    machine.actuator.runs_at(machine.period).map_err(|error| {
        SearchError::new_err(format!(
            "the controller {}; valid: {}",
            error.what, error.valid
        ))
    })?;
    let mut notes = Vec::new();
    let mut read = |kind: &str, logs: &Logs<'_>| -> PyResult<Vec<NamedLog>> {
        if logs.0.is_empty() {
            let words = format!("{kind} holds no log; valid: one at least");
            return Err(LogError::new_err(words));
        }
        let one = |(i, log)| {
            let name = format!("{kind} {}", i + 1);
            let given = Given {
                value: log,
                name: &name,
                columns: &columns,
            };
            log_of(&given, &machine, &mut notes)
        };
        logs.0.iter().enumerate().map(one).collect()
    };
    let (fit, check) = (read("fit", &fit)?, read("check", &check)?);
    check_distinct(&fit, &check).map_err(raise::<LogError>)?;
    let text = axis.text.clone();
    let (text, found, machine) = long(py, None, move |_| {
        let found = estimate(&machine, &fit, &check).map_err(raise::<SearchError>)?;
        let text = with_control(&text, &machine, &found, frequency_hz);
        let text = text.map_err(|error| AxisError::new_err(error.to_string()))?;
        Ok((text, found, machine))
    })?;
    let gains = PyDict::new(py);
    let pair = |gain: &Gain, factor: f64| {
        let [from, to] = gain.ci95.map(|end| end / factor);
        (gain.value / factor, (from, to))
    };
    for gain in &found.gains {
        let (key, factor) = spelling(&machine, &found.control, gain.key);
        gains.set_item(key, pair(gain, factor))?;
    }
    let open = found.undetermined.iter();
    let open = open.map(|(key, _)| spelling(&machine, &found.control, key).0);
    let told = PyDict::new(py);
    told.set_item(
        "controller",
        found.tried.first().map(|best| best.name.clone()),
    )?;
    told.set_item("gains", gains)?;
    told.set_item("command_delay_s", pair(&found.delay, 1.0))?;
    told.set_item("explained_fit", found.explained[0])?;
    told.set_item("explained_check", found.explained[1])?;
    told.set_item("not_determined", open.collect::<Vec<_>>())?;
    told.set_item("notes", notes)?;
    let axis = PyAxis::parsed("<axis with the controller that was found>", text)?;
    Ok((axis, told))
}
