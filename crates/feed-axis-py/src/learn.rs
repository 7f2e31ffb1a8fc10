//! Corrections of a move, learned from logs of its repetitions; friction, from logs.

use std::path::PathBuf;

use axis_pipeline::identification::identify_from_logs;
use axis_pipeline::learning::StoredCorrection;
use axis_sim::needed_position;
use compensator::Advice;
use lugre::LuGre;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::arrays::Logs;
use crate::axis::PyAxis;
use crate::errors::{LogError, StrategyError, of_file, raise, text_of};
use crate::log::{Given, Renamed};
use crate::long::long;
use crate::lugre_law::PyLuGre;
use crate::value::{Value, value};

/// What was learned of a move: where its load is to be led besides, cycle by cycle.
#[pyclass(module = "feed_axis", frozen, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct MoveCorrection(pub(crate) StoredCorrection);

impl MoveCorrection {
    fn text(&self) -> PyResult<String> {
        serde_json::to_string(&self.0).map_err(raise::<StrategyError>)
    }

    fn of_text(text: &str) -> PyResult<Self> {
        let read = serde_json::from_str(text);
        let read = read.map_err(|error| {
            StrategyError::new_err(format!(
                "this is no correction of a move ({error}); valid: what save or the command learn has written"
            ))
        });
        read.map(Self)
    }
}

impl Value for MoveCorrection {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (self.text()?,).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (text,): (String,) = state.extract()?;
        Self::of_text(&text)
    }
}

value!(MoveCorrection, hash);

#[pymethods]
impl MoveCorrection {
    /// Reads a correction, also one that the command `learn` has written.
    #[classmethod]
    fn load(kind: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        Self::of_text(&text_of::<StrategyError>(kind.py(), &path)?)
    }

    /// Writes it to a file, which `load` and the command read.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let written = std::fs::write(&path, self.text()?);
        written.map_err(|error| of_file(py, &error, &path))
    }

    /// Rounds of learning so far.
    #[getter]
    fn rounds(&self) -> u32 {
        self.0.rounds
    }

    fn __repr__(&self) -> String {
        let (axis, rounds) = (&self.0.axis, self.0.rounds);
        format!("MoveCorrection(of a move of {axis:?}, {rounds} rounds)")
    }
}

/// The next correction of a move, from the log of a repetition that was made with `correction`;
/// and what was found.
#[pyfunction]
#[pyo3(signature = (axis, log, correction = None, *, columns = Renamed::default()))]
pub(crate) fn learn<'py>(
    py: Python<'py>,
    axis: PyRef<'_, PyAxis>,
    log: &Bound<'_, PyAny>,
    correction: Option<PyRef<'_, MoveCorrection>>,
    columns: Renamed,
) -> PyResult<(MoveCorrection, Bound<'py, PyDict>)> {
    let axis = &*axis.axis;
    let position = needed_position(axis).into_iter();
    let needed: Vec<&str> = [axis.reference_channel()]
        .into_iter()
        .chain(position)
        .collect();
    let given = Given {
        value: log,
        name: "log",
        columns: &columns,
    };
    let (_, log) = given.whole(axis, &needed, &mut Vec::new())?;
    let mut next = match correction {
        Some(correction) => correction.0.clone(),
        None => StoredCorrection::of(axis, &log).map_err(raise::<StrategyError>)?,
    };
    let round = next.learn(axis, &log).map_err(raise::<StrategyError>)?;
    let found = PyDict::new(py);
    found.set_item("rounds", round.rounds)?;
    found.set_item("max_error", round.peak)?;
    found.set_item("learnable_rms", round.learnable)?;
    found.set_item("noise_rms", round.floor)?;
    let advice = match round.advice {
        Advice::Again => "again",
        Advice::Done => "done",
        Advice::Enough => "enough",
        Advice::Restarted => "restarted",
    };
    found.set_item("advice", advice)?;
    Ok((MoveCorrection(next), found))
}

/// Identifies the friction of an axis from logs of its own runs.
#[pyfunction]
#[pyo3(signature = (axis, logs, *, columns = Renamed::default()))]
pub(crate) fn identify<'py>(
    py: Python<'py>,
    axis: PyRef<'_, PyAxis>,
    logs: Logs<'_>,
    columns: Renamed,
) -> PyResult<(PyLuGre, Bound<'py, PyDict>)> {
    let axis = axis.axis.clone();
    let mut notes = Vec::new();
    let mut read = |(i, log)| {
        let name = format!("log {}", i + 1);
        let given = Given {
            value: log,
            name: &name,
            columns: &columns,
        };
        given.whole(&axis, &[], &mut notes)
    };
    let read: Vec<_> = logs
        .0
        .iter()
        .enumerate()
        .map(&mut read)
        .collect::<PyResult<_>>()?;
    let (law, identified) = long(py, None, move |_| {
        let found = identify_from_logs(&axis, &read).map_err(raise::<LogError>)?;
        let law = LuGre::new(found.law).map_err(raise::<StrategyError>)?;
        Ok((law, found))
    })?;
    let parameters = PyDict::new(py);
    for parameter in &identified.parameters {
        let interval = parameter.interval.map(|[from, to]| (from, to));
        parameters.set_item(parameter.name, (parameter.value, interval))?;
    }
    notes.extend(identified.notes);
    let found = PyDict::new(py);
    found.set_item("parameters", parameters)?;
    found.set_item("notes", notes)?;
    Ok((PyLuGre(law), found))
}
