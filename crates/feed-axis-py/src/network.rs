//! Networks, their training and prediction.

use std::path::PathBuf;

use axis_pipeline::sampling::ranges;
use axis_pipeline::training::{INITIAL_DAMPING, NetworkPlan, test, train};
use cfnn::artifact::{network_from_bytes, network_to_bytes};
use cfnn::train::{Dataset, Trainer, TrainingSettings};
use cfnn::{Network, Shape};
use controller_export::onnx::{self, Description, NetworkSignal};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple, PyType};

use crate::arrays;
use crate::arrays::{Layers, rows, rows_of};
use crate::axis::PyAxis;
use crate::errors::{NetworkError, bytes_of, of_file, raise};
use crate::long::long;
use crate::one_cycle::Samples;
use crate::value::{Value, value};

/// A cascade-forward network.
#[pyclass(module = "feed_axis", name = "Network", frozen)]
pub(crate) struct PyNetwork {
    pub(crate) network: Network,
    /// Mean square of the scaled residuals after each epoch.
    pub(crate) losses: Vec<f64>,
}

impl PyNetwork {
    fn bytes(&self) -> PyResult<Vec<u8>> {
        network_to_bytes(&self.network, "feed_axis").map_err(raise::<NetworkError>)
    }

    fn of_bytes(bytes: &[u8], losses: Vec<f64>) -> PyResult<Self> {
        let (network, _) = network_from_bytes(bytes).map_err(raise::<NetworkError>)?;
        Ok(Self { network, losses })
    }
}

impl Value for PyNetwork {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let losses = PyTuple::new(py, &self.losses)?;
        (PyBytes::new(py, &self.bytes()?), losses).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (bytes, losses): (Bound<'_, PyBytes>, Vec<f64>) = state.extract()?;
        Self::of_bytes(bytes.as_bytes(), losses)
    }

    /// How it was trained does not count.
    fn key<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (PyBytes::new(py, &self.bytes()?),).into_pyobject(py)
    }
}

value!(PyNetwork, hash);

#[pymethods]
impl PyNetwork {
    /// Trains by Levenberg–Marquardt on inputs x and targets y, a row a sample; of one variable
    /// also arrays of one dimension.
    /// `progress("train", epoch, epochs)`.
    #[classmethod]
    #[pyo3(signature = (x, y, *, hidden = Layers(vec![10]), epochs = 100, seed = 1, threads = 0, progress = None))]
    fn train<'py>(
        _: &Bound<'py, PyType>,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        y: &Bound<'py, PyAny>,
        hidden: Layers,
        #[pyo3(from_py_with = arrays::epochs)] epochs: usize,
        #[pyo3(from_py_with = arrays::seed)] seed: u64,
        #[pyo3(from_py_with = arrays::threads)] threads: usize,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let (x, inputs) = rows::<NetworkError>(x, "x")?;
        let (y, outputs) = rows::<NetworkError>(y, "y")?;
        let data = Dataset::new(inputs, outputs, x, y);
        let data = data.map_err(raise::<NetworkError>)?;
        let shape = Shape {
            inputs,
            hidden: hidden.0,
            outputs,
        };
        let settings = TrainingSettings {
            epochs,
            seed,
            threads,
            ..TrainingSettings::default()
        };
        long(py, progress, move |hook| {
            let scaling = data.scaling().map_err(raise::<NetworkError>)?;
            let trainer = Trainer::new(shape, scaling, &data, settings);
            let mut trainer = trainer.map_err(raise::<NetworkError>)?;
            trainer.run(|report| hook.done("train", report.epoch as u64, epochs as u64));
            Ok(Self {
                network: trainer.network(),
                losses: trainer.history().iter().map(|r| r.loss).collect(),
            })
        })
    }

    /// The outputs for inputs x, a row a sample; one row, or inputs of one variable, also as an
    /// array of one dimension.
    fn predict<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (inputs, outputs) = (self.network.shape().inputs, self.network.shape().outputs);
        let x = rows_of::<NetworkError>(x, "x", inputs)?;
        let mut scratch = self.network.scratch();
        let count = x.len() / inputs;
        let mut predicted = vec![0.0; count * outputs];
        for (row, output) in x.chunks(inputs).zip(predicted.chunks_mut(outputs)) {
            let done = self.network.evaluate(row, &mut scratch, output);
            done.map_err(raise::<NetworkError>)?;
        }
        predicted.into_pyarray(py).reshape([count, outputs])
    }

    /// Maximum and mean absolute error on one-cycle samples, µm or µrad.
    fn test(&self, samples: PyRef<'_, Samples>) -> PyResult<(f64, f64)> {
        let figures = test(&self.network, &samples.0).map_err(raise::<NetworkError>)?;
        Ok((figures.max, figures.mean))
    }

    /// Mean square of the scaled residuals after each epoch; empty for a network from a file.
    #[getter]
    fn losses<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.losses.clone().into_pyarray(py)
    }

    /// Numbers of inputs, neurons of the hidden layers, and outputs.
    #[getter]
    fn shape(&self) -> (usize, Vec<usize>, usize) {
        let shape = self.network.shape();
        (shape.inputs, shape.hidden.clone(), shape.outputs)
    }

    /// The network as bytes with a hash, for a file.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.bytes()?))
    }

    /// Reads a network's file, also one of the stage `train`.
    #[classmethod]
    fn load(kind: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        Self::of_bytes(&bytes_of(kind.py(), &path)?, Vec::new())
    }

    /// Writes the network to a file, which `load` reads.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let written = std::fs::write(&path, self.bytes()?);
        written.map_err(|error| of_file(py, &error, &path))
    }

    /// Writes the network as an ONNX file; its inputs and outputs are named in it.
    #[pyo3(signature = (path, *, inputs = None, outputs = None))]
    fn to_onnx(
        &self,
        py: Python<'_>,
        path: PathBuf,
        inputs: Option<Vec<String>>,
        outputs: Option<Vec<String>>,
    ) -> PyResult<()> {
        let shape = self.network.shape();
        let named = |names: Option<Vec<String>>, letter: &str, count: usize| {
            let numbered = || (1..=count).map(|i| format!("{letter}{i}")).collect();
            let signal = |name| NetworkSignal {
                name,
                unit: String::new(),
            };
            let names = names.unwrap_or_else(numbered).into_iter();
            names.map(signal).collect::<Vec<_>>()
        };
        let description = Description {
            summary: "a cascade-forward network".to_owned(),
            inputs: named(inputs, "x", shape.inputs),
            outputs: named(outputs, "y", shape.outputs),
            metadata: Vec::new(),
        };
        let bytes = onnx::export(&self.network, &description).map_err(raise::<NetworkError>)?;
        std::fs::write(&path, bytes).map_err(|error| of_file(py, &error, &path))
    }

    fn __repr__(&self) -> String {
        let shape = self.network.shape();
        let sizes = [&[shape.inputs], shape.hidden.as_slice(), &[shape.outputs]].concat();
        let sizes: Vec<String> = sizes.iter().map(ToString::to_string).collect();
        let parameters = self.network.weights().len();
        format!("Network({}, {parameters} parameters)", sizes.join("-"))
    }
}

#[pymethods]
impl PyAxis {
    /// Trains the one-cycle predictor: what the best linear map of the samples leaves.
    #[pyo3(signature = (samples, *, hidden = Layers(vec![34, 19, 8]), epochs = 500, seed = 1, threads = 0, progress = None))]
    fn train(
        &self,
        py: Python<'_>,
        samples: PyRef<'_, Samples>,
        hidden: Layers,
        #[pyo3(from_py_with = arrays::epochs)] epochs: usize,
        #[pyo3(from_py_with = arrays::seed)] seed: u64,
        #[pyo3(from_py_with = arrays::threads)] threads: usize,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyNetwork> {
        let (axis, samples) = (self.axis.clone(), samples.0.clone());
        long(py, progress, move |hook| {
            let plan = NetworkPlan {
                hidden: hidden.0,
                epochs,
                initial_damping: INITIAL_DAMPING,
                seed,
                threads,
            };
            let ranges = ranges(&axis).map_err(raise::<NetworkError>)?;
            let trained = train(&ranges, &samples, &plan, None, |report, _| {
                hook.done("train", report.epoch as u64, epochs as u64);
            });
            let trained = trained.map_err(raise::<NetworkError>)?;
            Ok(PyNetwork {
                losses: trained.history.iter().map(|r| r.loss).collect(),
                network: trained.network,
            })
        })
    }
}
