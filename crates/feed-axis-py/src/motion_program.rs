//! Motion programs.

use std::path::PathBuf;

use axis_sim::mechanism::Freedom;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};
use trajectories::{Motion, ProgramUnit};

use crate::errors::{MotionError, raise, text_of};
use crate::sampled_motion::sampled;
use crate::value::{Value, value};

/// Moves, dwells, sines and chirps one after the other.
#[pyclass(module = "feed_axis", frozen)]
pub(crate) struct Program {
    pub(crate) program: trajectories::Program,
    /// From which it was read, so that a copy has the same numbers to the last bit.
    text: String,
}

impl Program {
    fn parsed(text: String) -> PyResult<Self> {
        let program = toml::from_str(&text)
            .map_err(|error| MotionError::new_err(axis_sim::toml_message(&text, &error)))?;
        Ok(Self { program, text })
    }

    /// As it comes back from its own text.
    pub(crate) fn of(program: &trajectories::Program) -> PyResult<Self> {
        Self::parsed(toml::to_string(program).map_err(raise::<MotionError>)?)
    }
}

impl Value for Program {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (&self.text,).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (text,) = state.extract()?;
        Self::parsed(text)
    }

    /// Comments and order do not count.
    fn key<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (self.to_toml()?,).into_pyobject(py)
    }
}

value!(Program, hash);

#[pymethods]
impl Program {
    /// Reads a motion program (TOML).
    #[classmethod]
    fn load(kind: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        Self::parsed(text_of::<MotionError>(kind.py(), &path)?)
    }

    /// Reads the text of a motion program.
    #[classmethod]
    fn from_toml(_: &Bound<'_, PyType>, text: String) -> PyResult<Self> {
        Self::parsed(text)
    }

    /// Its text, as `from_toml` reads it.
    fn to_toml(&self) -> PyResult<String> {
        toml::to_string(&self.program).map_err(raise::<MotionError>)
    }

    /// Time from the first to the last instant, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.program.duration()
    }

    /// The motion every `period_s`, as `SCurve.sample`.
    fn sample<'py>(&self, py: Python<'py>, period_s: f64) -> PyResult<Bound<'py, PyDict>> {
        let freedom = match self.program.unit() {
            ProgramUnit::Millimetres => Freedom::Linear,
            ProgramUnit::Degrees => Freedom::Rotary,
        };
        sampled(py, &self.program, period_s, freedom)
    }

    fn __repr__(&self) -> String {
        let steps = self.program.steps().len();
        format!("Program({steps} steps, {:.6} s)", self.program.duration())
    }
}
