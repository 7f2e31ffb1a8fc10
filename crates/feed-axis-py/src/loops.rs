//! Margins of an axis' loops, and gains that have them.

use drive_loop::{LoopAnalysis, LoopSet, MeasureSettings, TuneSettings, TunedKey, Tuning};
use pyo3::prelude::*;
use pyo3::types::PyModule;
use serde::Serialize;
use toml::{Table, Value};

use crate::arrays::line;
use crate::axis::PyAxis;
use crate::errors::{AxisError, LoopError, raise};
use crate::log::Renamed;
use crate::long::long;

/// The cases over which margins are computed; the defaults are those of the command.
fn set_of(
    positions: Option<&Bound<'_, PyAny>>,
    masses: Option<&Bound<'_, PyAny>>,
    frictions: Option<&Bound<'_, PyAny>>,
    delay: f64,
) -> PyResult<LoopSet> {
    let or = |given: Option<&Bound<'_, PyAny>>, name: &str, default: Vec<f64>| {
        let given = given.map(|given| line::<LoopError>(given, name));
        given.unwrap_or(Ok(default))
    };
    let set = LoopSet::default();
    Ok(LoopSet {
        positions: or(positions, "positions", set.positions)?,
        masses: or(masses, "masses", set.masses)?,
        frictions: or(frictions, "frictions", set.frictions)?,
        delay,
        measured: set.measured,
    })
}

/// What serde writes, as dicts, lists, numbers and strings.
pub(crate) fn plain<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = feed_axis::json::for_python(value).map_err(raise::<LoopError>)?;
    PyModule::import(py, "json")?.call_method1("loads", (text,))
}

#[pymethods]
impl PyAxis {
    /// Margins of the position and speed loops: over positions, masses and frictions of the load,
    /// sliding and stuck.
    #[pyo3(signature = (*, positions = None, masses = None, frictions = None, delay_cycles = 0.0))]
    fn analyse<'py>(
        &self,
        py: Python<'py>,
        positions: Option<&Bound<'py, PyAny>>,
        masses: Option<&Bound<'py, PyAny>>,
        frictions: Option<&Bound<'py, PyAny>>,
        delay_cycles: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let set = set_of(positions, masses, frictions, delay_cycles)?;
        let axis = self.axis.clone();
        let found = long(py, None, move |_| {
            LoopAnalysis::of(&axis, &set).map_err(raise::<LoopError>)
        })?;
        plain(py, &found)
    }

    /// Gains of the loops within limits of the sensitivity: the axis that has them, and what was
    /// found.
    #[pyo3(signature = (*, sensitivity = 1.6, sensitivity_late = 2.0, ripple = 0.02, positions = None, masses = None, frictions = None, acceleration = true, notch = true, current = false, frf = None))]
    fn tune<'py>(
        &self,
        py: Python<'py>,
        sensitivity: f64,
        sensitivity_late: f64,
        ripple: f64,
        positions: Option<&Bound<'py, PyAny>>,
        masses: Option<&Bound<'py, PyAny>>,
        frictions: Option<&Bound<'py, PyAny>>,
        acceleration: bool,
        notch: bool,
        current: bool,
        frf: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Self, Bound<'py, PyAny>)> {
        let mut set = set_of(positions, masses, frictions, 0.0)?;
        if let Some(logs) = frf {
            let settings = MeasureSettings::default();
            let all = self.measured(py, "frf", logs, &Renamed::default(), settings)?;
            let measured = set.with_measured(&self.axis, &all);
            set = measured.map_err(raise::<LoopError>)?;
        }
        let settings = TuneSettings {
            sensitivity,
            sensitivity_late,
            ripple,
            set,
            acceleration,
            notch,
            current,
            simulated: true,
        };
        let axis = self.axis.clone();
        let tuned = long(py, None, move |_| {
            Tuning::of(&axis, &settings).map_err(raise::<LoopError>)
        })?;
        let keys = tuned.keys(&self.axis);
        let axis = self.with_keys(&keys)?;
        let found = plain(py, &tuned.report)?;
        found.set_item("keys", plain(py, &keys)?)?;
        Ok((axis, found))
    }
}

impl PyAxis {
    /// This axis with the keys of its file that were set.
    fn with_keys(&self, keys: &[TunedKey]) -> PyResult<Self> {
        let mut table: Table = self.text.parse().map_err(raise::<AxisError>)?;
        for key in keys {
            let section = table
                .entry(key.section)
                .or_insert_with(|| Value::Table(Table::new()));
            if let Some(section) = section.as_table_mut() {
                section.insert(key.key.clone(), Value::Float(key.value));
            }
        }
        Self::parsed("<tuned axis>", table.to_string())
    }
}
