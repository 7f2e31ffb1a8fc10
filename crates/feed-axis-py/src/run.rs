//! What a run leaves: channels as arrays.

use axis_sim::{Axis, Cycle, LogChannel, channels};
use numpy::{IntoPyArray, PyArray1, PyArrayMethods};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::html::table;

/// The samples of a run, a column a channel.
pub(crate) struct Columns {
    channels: Vec<LogChannel>,
    names: Vec<[&'static str; 2]>,
    samples: Vec<Vec<f64>>,
    errors: Vec<f64>,
}

impl Columns {
    /// For a run of so many cycles.
    pub(crate) fn of(axis: &Axis, cycles: usize) -> Self {
        let channels = channels(axis);
        Self {
            names: (channels.iter())
                .map(|c| c.of_freedom(axis.freedom()))
                .collect(),
            samples: vec![Vec::with_capacity(cycles); channels.len()],
            errors: Vec::with_capacity(cycles),
            channels,
        }
    }

    /// Adds a cycle.
    pub(crate) fn push(&mut self, cycle: &Cycle) {
        for (samples, channel) in self.samples.iter_mut().zip(&self.channels) {
            samples.push((channel.read)(cycle));
        }
        self.errors.push(cycle.error());
    }
}

/// A simulated run: its channels as NumPy arrays, by name (`run["position_m"]`).
#[pyclass(module = "feed_axis", frozen, mapping)]
pub(crate) struct Run {
    pub(crate) channels: Vec<(&'static str, &'static str, Py<PyArray1<f64>>)>,
    error: Py<PyArray1<f64>>,
    most: f64,
    mean: f64,
    axis: String,
    unit: &'static str,
    pub(crate) cycles: usize,
}

impl Run {
    /// The columns become NumPy's where they lie.
    pub(crate) fn new(py: Python<'_>, axis: &Axis, columns: Columns) -> Self {
        let cycles = columns.errors.len();
        let sizes = columns.errors.iter().map(|e| e.abs());
        let (most, sum) = sizes.fold((0.0_f64, 0.0), |(m, s), e| (m.max(e), s + e));
        let named = columns.names.into_iter().zip(columns.samples);
        Self {
            channels: named
                .map(|([name, unit], samples)| (name, unit, samples.into_pyarray(py).unbind()))
                .collect(),
            error: columns.errors.into_pyarray(py).unbind(),
            most,
            mean: sum / cycles.max(1) as f64,
            axis: axis.name.clone(),
            unit: axis.freedom().unit(),
            cycles,
        }
    }

    fn dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, _, samples) in &self.channels {
            dict.set_item(name, samples.bind(py))?;
        }
        Ok(dict)
    }
}

#[pymethods]
impl Run {
    /// The samples of a channel, one a control cycle; the same array each time.
    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyArray1<f64>>> {
        let found = self.channels.iter().find(|(n, ..)| *n == name);
        let found = found.map(|(.., samples)| samples.clone_ref(py));
        found.ok_or_else(|| {
            PyKeyError::new_err(format!(
                "there is no channel {name:?}; there are: {}",
                self.keys().join(", ")
            ))
        })
    }

    fn __contains__(&self, name: &str) -> bool {
        self.keys().contains(&name)
    }

    /// Number of channels.
    fn __len__(&self) -> usize {
        self.channels.len()
    }

    fn __iter__(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let names = self.keys().into_pyobject(py)?;
        Ok(names.try_iter()?.into_any().unbind())
    }

    /// Names of the channels; the last part of each is its unit.
    fn keys(&self) -> Vec<&'static str> {
        self.channels.iter().map(|(name, ..)| *name).collect()
    }

    /// Unit of each channel.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, unit, _) in &self.channels {
            dict.set_item(name, unit)?;
        }
        Ok(dict)
    }

    /// Control cycles.
    #[getter]
    fn cycles(&self) -> usize {
        self.cycles
    }

    /// Tracking error, reference minus true position of the load, m or rad.
    #[getter]
    fn error(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.error.clone_ref(py)
    }

    /// Unit of the errors: m, or rad where the load turns.
    #[getter]
    fn error_unit(&self) -> &'static str {
        self.unit
    }

    /// Greatest absolute tracking error, m or rad.
    #[getter]
    fn max_error(&self) -> f64 {
        self.most
    }

    /// Mean absolute tracking error, m or rad.
    #[getter]
    fn mean_error(&self) -> f64 {
        self.mean
    }

    /// The channels as a pandas DataFrame.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("pandas")?
            .getattr("DataFrame")?
            .call1((self.dict(py)?,))
    }

    /// The channels as a polars DataFrame.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("polars")?
            .getattr("DataFrame")?
            .call1((self.dict(py)?,))
    }

    fn _repr_html_(&self, py: Python<'_>) -> String {
        let rows = self.channels.iter().map(|(name, unit, samples)| {
            let samples = samples.bind(py).readonly();
            let ends = (samples.as_array().iter())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &x| {
                    (least.min(x), most.max(x))
                });
            let (least, most) = (format!("{:.5e}", ends.0), format!("{:.5e}", ends.1));
            vec![(*name).to_owned(), least, most, (*unit).to_owned()]
        });
        let heads = ["channel", "least", "greatest", "unit"];
        table(&self.__repr__(), &heads, &rows.collect::<Vec<_>>())
    }

    fn __repr__(&self) -> String {
        format!(
            "Run({:?}: {} cycles, {} channels, tracking error max {:.4} µ{unit}, mean {:.4} µ{unit}, simulated)",
            self.axis,
            self.cycles,
            self.channels.len(),
            1e6 * self.most,
            1e6 * self.mean,
            unit = self.unit
        )
    }
}
