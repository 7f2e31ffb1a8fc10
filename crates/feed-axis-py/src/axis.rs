//! Axes: from a file, a text or a dict.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use axis_sim::{Axis, channels};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyTuple, PyType};
use toml::Table;

use crate::dict::{dict_of, table_of};
use crate::errors::{AxisError, ParameterError, raise, text_of};
use crate::moves::Move;
use crate::value::{Value, value};

/// A feed axis: mechanism, motor, control, sensors, friction and loads, checked once.
#[pyclass(module = "feed_axis", name = "Axis", frozen, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyAxis {
    pub(crate) axis: Arc<Axis>,
    /// The text that it was made from.
    pub(crate) text: String,
}

impl PyAxis {
    /// Of an axis file.
    pub(crate) fn read(py: Python<'_>, path: &Path) -> PyResult<Self> {
        let text = text_of::<AxisError>(py, path)?;
        let axis = Axis::read_changed(path, &text).map_err(raise::<AxisError>)?;
        Ok(Self {
            axis: Arc::new(axis),
            text,
        })
    }

    pub(crate) fn parsed(name: &str, text: String) -> PyResult<Self> {
        let axis = Axis::parse(name, &text).map_err(raise::<AxisError>)?;
        Ok(Self {
            axis: Arc::new(axis),
            text,
        })
    }
}

impl Value for PyAxis {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (&self.text,).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (text,) = state.extract()?;
        Self::parsed("<text>", text)
    }

    fn key<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (&self.axis.fingerprint,).into_pyobject(py)
    }
}

value!(PyAxis, hash);

#[pymethods]
impl PyAxis {
    /// Reads an axis file.
    #[classmethod]
    fn load(kind: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        Self::read(kind.py(), &path)
    }

    /// Reads the text of an axis file; `name` stands for it in messages.
    #[classmethod]
    #[pyo3(signature = (text, name = "<text>"))]
    fn from_toml(_: &Bound<'_, PyType>, text: String, name: &str) -> PyResult<Self> {
        Self::parsed(name, text)
    }

    /// An axis from a dict with the keys of an axis file.
    #[classmethod]
    fn from_dict(_: &Bound<'_, PyType>, values: &Bound<'_, PyMapping>) -> PyResult<Self> {
        Self::parsed("<dict>", table_of(values)?.to_string())
    }

    /// The values of its file as a dict, to change and to give to `from_dict`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table: Table = (self.text.parse()).map_err(raise::<AxisError>)?;
        dict_of(py, &table)
    }

    /// The text of its file.
    fn to_toml(&self) -> &str {
        &self.text
    }

    /// Short name.
    #[getter]
    fn name(&self) -> &str {
        &self.axis.name
    }

    /// One line for people.
    #[getter]
    fn description(&self) -> &str {
        &self.axis.description
    }

    /// Control period, s.
    #[getter]
    fn period_s(&self) -> f64 {
        self.axis.period
    }

    /// Unit of the load's position: "m", or "rad" where it turns.
    #[getter]
    fn unit(&self) -> &'static str {
        self.axis.freedom().unit()
    }

    /// Least position, greatest position, and where motions start, m or rad.
    #[getter]
    fn stroke(&self) -> (f64, f64, f64) {
        let stroke = &self.axis.stroke;
        (stroke.minimum, stroke.maximum, stroke.start)
    }

    /// Names of the channels that its runs and logs have, with their units as last part.
    #[getter]
    fn channels(&self) -> Vec<&'static str> {
        let channels = channels(&self.axis).into_iter();
        channels.map(|c| c.name(&self.axis)).collect()
    }

    /// The moves on which it is judged, those of `[[trajectory]]`.
    #[getter]
    fn trajectories(&self) -> Vec<Move> {
        let freedom = self.axis.freedom();
        let moves = self.axis.trajectories.iter();
        moves.map(|spec| Move::of(spec, freedom)).collect()
    }

    /// Natural frequencies with the load at a position (m or rad; where motions start, if it is
    /// left out), rigid motion left out, Hz.
    #[pyo3(signature = (position = None))]
    fn frequencies_hz<'py>(
        &self,
        py: Python<'py>,
        position: Option<f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let position = position.unwrap_or(self.axis.stroke.start);
        let modes = self.axis.mechanism.modes(position);
        let modes = modes.map_err(raise::<ParameterError>)?;
        let hertz: Vec<f64> = modes.iter().map(|w| w / std::f64::consts::TAU).collect();
        Ok(hertz.into_pyarray(py))
    }

    /// Hash of all values: the same for files that differ in comments, units or order only.
    #[getter]
    fn fingerprint(&self) -> &str {
        &self.axis.fingerprint
    }

    fn __repr__(&self) -> String {
        let axis = &self.axis;
        format!(
            "Axis({:?}: {}; {} to {} {}, {} µs)",
            axis.name,
            axis.description,
            axis.stroke.minimum,
            axis.stroke.maximum,
            axis.freedom().unit(),
            1e6 * axis.period
        )
    }
}
