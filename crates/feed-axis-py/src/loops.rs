//! Margins of an axis' loops, and gains that have them.

use axis_sim::control::units_of_gain;
use axis_sim::part::{Key, Values};
use drive_loop::{LoopAnalysis, LoopSet, TuneSettings, Tuned, Tuning};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyModule};
use serde::Serialize;
use toml::{Table, Value};

use crate::arrays::line;
use crate::axis::PyAxis;
use crate::errors::{AxisError, LoopError, raise};
use crate::long::long;

/// The cases over which margins are computed: what is left out is as the command has it.
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
    })
}

/// What serde writes, as dicts, lists, numbers and strings.
fn plain<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(raise::<LoopError>)?;
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
    #[pyo3(signature = (*, sensitivity = 1.6, sensitivity_late = 2.0, ripple = 0.02, positions = None, masses = None, frictions = None, acceleration = true, notch = true, current = false))]
    #[allow(clippy::too_many_arguments, reason = "keywords of a Python function")]
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
    ) -> PyResult<(Self, Bound<'py, PyAny>)> {
        let settings = TuneSettings {
            sensitivity,
            sensitivity_late,
            ripple,
            set: set_of(positions, masses, frictions, 0.0)?,
            acceleration,
            notch,
            current,
            simulated: true,
        };
        let axis = self.axis.clone();
        let Tuned { axis, report } = long(py, None, move |_| {
            Tuning::of(&axis, &settings).map_err(raise::<LoopError>)
        })?;
        let (axis, keys) = self.with_gains(&axis)?;
        let found = plain(py, &report)?;
        let list = keys.into_iter().map(|(key, before, value)| {
            let dict = PyDict::new(py);
            dict.set_item("key", key)?;
            dict.set_item("before", before)?;
            dict.set_item("value", value)?;
            Ok(dict)
        });
        found.set_item("keys", list.collect::<PyResult<Vec<_>>>()?)?;
        Ok((axis, found))
    }
}

/// A key with its unit, its value before, and now.
type SetKey = (String, Option<f64>, f64);

impl PyAxis {
    /// This axis with what is other in the tuned one's control and actuator, and the keys that were
    /// set, in the units of its file.
    fn with_gains(&self, tuned: &axis_sim::Axis) -> PyResult<(Self, Vec<SetKey>)> {
        let axis = &self.axis;
        let mut table: Table = self.text.parse().map_err(raise::<AxisError>)?;
        // A file of schema 1 has the current controllers among the others.
        let of_actuator = match table.contains_key("actuator") {
            true => "actuator",
            false => "control",
        };
        let effort = axis.actuator.effort();
        let gain = |key: &Key| units_of_gain(&*axis.control, key, effort, &*axis.mechanism);
        let of_control = other_keys(
            tuned.control.kind().keys,
            axis.control.values(),
            tuned.control.values(),
            gain,
        );
        let of_drive = other_keys(
            tuned.actuator.kind().keys,
            axis.actuator.values(),
            tuned.actuator.values(),
            |key| key.units().to_vec(),
        );
        let mut all = Vec::new();
        for (section, keys) in [("control", of_control), (of_actuator, of_drive)] {
            for (key, before, value) in keys {
                let section = table
                    .entry(section)
                    .or_insert_with(|| Value::Table(Table::new()));
                if let Some(section) = section.as_table_mut() {
                    section.insert(key.clone(), Value::Float(value));
                }
                all.push((key, before, value));
            }
        }
        Ok((Self::parsed("<tuned axis>", table.to_string())?, all))
    }
}

/// What one set of values has other than another.
fn other_keys(
    keys: &[Key],
    before: &Values,
    after: &Values,
    units: impl Fn(&Key) -> Vec<(&'static str, f64)>,
) -> Vec<SetKey> {
    let one = |key: &Key| {
        let [old, new] = [before, after].map(|values| values.optional(key.name()));
        let new = new.filter(|_| new != old)?;
        let (units, own) = (units(key), before.unit(key.name()));
        let unit = units.iter().find(|(unit, _)| *unit == own);
        let (name, factor) = match unit.or(units.first()) {
            Some((unit, factor)) => (format!("{}_{unit}", key.name()), *factor),
            None => (key.name().to_owned(), 1.0),
        };
        Some((name, old.map(|old| old / factor), new / factor))
    };
    keys.iter().filter_map(one).collect()
}
