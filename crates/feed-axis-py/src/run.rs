//! What a run leaves: channels as arrays.

use std::path::PathBuf;

use axis_log::TIME_CHANNEL;
use axis_report::{Cell, Figure, Page, Section, Series, Table, engineering};
use axis_sim::{Axis, Cycle, LogChannel, channels, excitation_channel};
use numpy::{IntoPyArray, PyArray1, PyArrayMethods};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::errors::{SimulationError, package, raise};
use crate::html::{page_to, table};
use crate::value::{Value, value};

/// The samples of a run, a column a channel.
pub(crate) struct Columns {
    channels: Vec<LogChannel>,
    names: Vec<[&'static str; 2]>,
    samples: Vec<Vec<f64>>,
    errors: Vec<f64>,
}

impl Columns {
    /// For a run of so many cycles, with what an excitation adds where there is one.
    pub(crate) fn of(axis: &Axis, cycles: usize, is_excited: bool) -> Self {
        let mut channels = channels(axis);
        channels.extend(is_excited.then(|| excitation_channel(axis)));
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

/// A simulated run: its channels as NumPy arrays, by name (`run["position_m"]`), which cannot be
/// written to.
#[pyclass(module = "feed_axis", frozen, mapping)]
pub(crate) struct Run {
    channels: Vec<RunChannel>,
    error: Py<PyArray1<f64>>,
    most: f64,
    mean: f64,
    axis: String,
    unit: String,
    cycles: usize,
}

/// Name, unit, samples.
type RunChannel = (String, String, Py<PyArray1<f64>>);

/// An array that refuses to be written to: the run stays what was simulated.
fn still(array: Bound<'_, PyArray1<f64>>) -> PyResult<Py<PyArray1<f64>>> {
    let how = PyDict::new(array.py());
    how.set_item("write", false)?;
    array.call_method("setflags", (), Some(&how))?;
    Ok(array.unbind())
}

impl Run {
    /// The columns become NumPy's where they lie.
    pub(crate) fn new(py: Python<'_>, axis: &Axis, columns: Columns) -> PyResult<Self> {
        let named = columns.names.into_iter().zip(columns.samples);
        let channels = named.map(|([name, unit], samples)| {
            let samples = still(samples.into_pyarray(py))?;
            Ok((name.to_owned(), unit.to_owned(), samples))
        });
        let error = columns.errors.into_pyarray(py);
        let unit = axis.freedom().unit().to_owned();
        Self::of(
            channels.collect::<PyResult<_>>()?,
            error,
            axis.name.clone(),
            unit,
        )
    }

    fn of(
        channels: Vec<RunChannel>,
        error: Bound<'_, PyArray1<f64>>,
        axis: String,
        unit: String,
    ) -> PyResult<Self> {
        let (most, sum, cycles) = {
            let errors = error.try_readonly()?;
            let sizes = errors.as_array();
            let sizes = sizes.iter().map(|e| e.abs());
            sizes.fold((0.0_f64, 0.0, 0_usize), |(m, s, n), e| {
                (m.max(e), s + e, n + 1)
            })
        };
        Ok(Self {
            channels,
            error: still(error)?,
            most,
            mean: sum / cycles.max(1) as f64,
            axis,
            unit,
            cycles,
        })
    }

    fn dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, _, samples) in &self.channels {
            dict.set_item(name, samples.bind(py))?;
        }
        Ok(dict)
    }
}

impl Value for Run {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let channels = (self.channels.iter())
            .map(|(name, unit, samples)| (name, unit, samples.bind(py)).into_pyobject(py));
        let channels = PyTuple::new(py, channels.collect::<PyResult<Vec<_>>>()?)?;
        (channels, self.error.bind(py), &self.axis, &self.unit).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        type State<'py> = (
            Vec<(String, String, Bound<'py, PyArray1<f64>>)>,
            Bound<'py, PyArray1<f64>>,
            String,
            String,
        );
        let (channels, error, axis, unit): State<'_> = state.extract()?;
        let channels = channels
            .into_iter()
            .map(|(name, unit, samples)| Ok((name, unit, still(samples)?)));
        Self::of(channels.collect::<PyResult<_>>()?, error, axis, unit)
    }

    /// Samples as bytes: equal are runs that are equal to the bit.
    fn key<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let channels = self.channels.iter().map(|(name, unit, samples)| {
            let bytes = samples.bind(py).call_method0("tobytes")?;
            (name, unit, bytes).into_pyobject(py)
        });
        let channels = PyTuple::new(py, channels.collect::<PyResult<Vec<_>>>()?)?;
        (channels, &self.axis, &self.unit).into_pyobject(py)
    }
}

value!(Run);

#[pymethods]
impl Run {
    /// The samples of a channel, one a control cycle; the same array each time.
    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyArray1<f64>>> {
        let found = self.channels.iter().find(|(n, ..)| n == name);
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
    fn keys(&self) -> Vec<&str> {
        self.channels
            .iter()
            .map(|(name, ..)| name.as_str())
            .collect()
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
    fn error_unit(&self) -> &str {
        &self.unit
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
        package(py, "pandas", "to_pandas")?
            .getattr("DataFrame")?
            .call1((self.dict(py)?,))
    }

    /// The channels as a polars DataFrame.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        package(py, "polars", "to_polars")?
            .getattr("DataFrame")?
            .call1((self.dict(py)?,))
    }

    /// Draws channels over time with matplotlib; the tracking error if none is named.
    #[pyo3(signature = (*channels, ax = None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        channels: &Bound<'py, PyTuple>,
        ax: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let plots = slf.py().import("feed_axis._plot")?;
        plots.call_method1("plot_run", (slf, channels, ax))
    }

    /// A page of the run: figures of the tracking error and of every channel; to a file too where
    /// one is named.
    #[pyo3(signature = (path = None))]
    fn to_html(&self, py: Python<'_>, path: Option<PathBuf>) -> PyResult<String> {
        let all = |array: &Py<PyArray1<f64>>| array.bind(py).readonly().as_array().to_vec();
        let time = self.channels.iter().find(|(name, ..)| name == TIME_CHANNEL);
        let time = time.map(|(.., samples)| all(samples)).unwrap_or_default();
        let figure = |title: &str, values: Vec<f64>, unit: &str| {
            Figure::new(title, "time", title)
                .units("s", unit)
                .linked("time")
                .series(Series::line(title, time.clone(), values))
        };
        let table = Table::new("Size of the tracking error", ["figure", "value"])
            .row([
                Cell::text("greatest"),
                Cell::text(engineering(self.most, &self.unit, 4)),
            ])
            .row([
                Cell::text("mean"),
                Cell::text(engineering(self.mean, &self.unit, 4)),
            ]);
        let error = Section::new("Tracking error").table(table).figure(figure(
            "tracking error",
            all(&self.error),
            &self.unit,
        ));
        let channels = self
            .channels
            .iter()
            .filter(|(name, ..)| name != TIME_CHANNEL);
        let channels = channels.fold(
            Section::new("Channels"),
            |section, (name, unit, samples)| {
                // The unit stands at the axis: the name without it.
                let suffix = format!("_{}", unit.replace(['·', '/'], "_").to_lowercase());
                let title = name.strip_suffix(suffix.as_str()).unwrap_or(name);
                section.figure(figure(&title.replace('_', " "), all(samples), unit))
            },
        );
        let page = Page::new(format!("Motion of {}", self.axis))
            .lead("Simulated, not measured.")
            .section(error)
            .section(channels);
        let text = axis_report::render(&page).map_err(raise::<SimulationError>)?;
        page_to(py, text, path)
    }

    fn _repr_html_(&self, py: Python<'_>) -> String {
        let rows = self.channels.iter().map(|(name, unit, samples)| {
            let samples = samples.bind(py).readonly();
            let ends = (samples.as_array().iter())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &x| {
                    (least.min(x), most.max(x))
                });
            let (least, most) = (format!("{:.5e}", ends.0), format!("{:.5e}", ends.1));
            vec![name.clone(), least, most, unit.clone()]
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
