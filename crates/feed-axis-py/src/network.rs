//! One-cycle samples, networks, training and prediction.

use std::path::PathBuf;

use axis_sim::CycleInput;
use cfnn::artifact::{network_from_bytes, network_to_bytes};
use cfnn::train::{Dataset, Settings, Trainer};
use cfnn::{Network, Shape};
use numpy::{
    AllowTypeChange, IntoPyArray, PyArray1, PyArray2, PyArrayLike2, PyArrayMethods,
    PyUntypedArrayMethods,
};
use pipeline::sampling::{SamplePlan, SampleSet, Sampler, SpeedDensity, ranges};
use pipeline::training::{INITIAL_DAMPING, NetworkPlan, test, train};
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::axis::PyAxis;
use crate::errors::{NetworkError, raise};
use crate::long::long;

/// Rows that are simulated between two looks at the hook.
const ROWS: usize = 256;

/// One-cycle samples: state and command at the start of a cycle, and how far the load went.
#[pyclass(module = "feed_axis", frozen)]
pub(crate) struct Samples(SampleSet);

#[pymethods]
impl Samples {
    fn __len__(&self) -> usize {
        self.0.inputs.len()
    }

    /// Position (m), speed (m/s), acceleration (m/s²) and commanded current (A), a row a sample.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let row = |i: &CycleInput| [i.position, i.speed, i.acceleration, i.iq_command];
        let rows: Vec<f64> = self.0.inputs.iter().flat_map(row).collect();
        rows.into_pyarray(py).reshape([self.0.inputs.len(), 4])
    }

    /// How far the load went in the cycle, m.
    #[getter]
    fn increments_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.increments.clone().into_pyarray(py)
    }

    fn __repr__(&self) -> String {
        format!("Samples({} cycles, simulated)", self.0.inputs.len())
    }
}

/// A cascade-forward network.
#[pyclass(module = "feed_axis", name = "Network", frozen)]
pub(crate) struct PyNetwork {
    pub(crate) network: Network,
    /// Mean square of the scaled residuals after each epoch.
    losses: Vec<f64>,
}

#[pymethods]
impl PyNetwork {
    /// Trains by Levenberg–Marquardt on inputs x and targets y, a row a sample.
    /// `progress("train", epoch, epochs)`.
    #[classmethod]
    #[pyo3(signature = (x, y, *, hidden = vec![10], epochs = 100, seed = 1, threads = 0, progress = None))]
    #[allow(clippy::too_many_arguments)]
    fn train<'py>(
        _: &Bound<'py, PyType>,
        py: Python<'py>,
        x: PyArrayLike2<'py, f64, AllowTypeChange>,
        y: PyArrayLike2<'py, f64, AllowTypeChange>,
        hidden: Vec<usize>,
        epochs: usize,
        seed: u64,
        threads: usize,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let (inputs, outputs) = (x.shape()[1], y.shape()[1]);
        let rows = |table: PyArrayLike2<'py, f64, AllowTypeChange>| -> Vec<f64> {
            table.as_array().iter().copied().collect()
        };
        let data = Dataset::new(inputs, outputs, rows(x), rows(y));
        let data = data.map_err(raise::<NetworkError>)?;
        let shape = Shape {
            inputs,
            hidden,
            outputs,
        };
        let settings = Settings {
            epochs,
            seed,
            threads,
            ..Settings::default()
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

    /// The outputs for inputs x, a row a sample.
    fn predict<'py>(
        &self,
        py: Python<'py>,
        x: PyArrayLike2<'py, f64, AllowTypeChange>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let outputs = self.network.shape().outputs;
        let mut scratch = self.network.scratch();
        let mut predicted = vec![0.0; x.shape()[0] * outputs];
        for (row, output) in (x.as_array().rows().into_iter()).zip(predicted.chunks_mut(outputs)) {
            let input: Vec<f64> = row.to_vec();
            let done = self.network.evaluate(&input, &mut scratch, output);
            done.map_err(raise::<NetworkError>)?;
        }
        predicted.into_pyarray(py).reshape([x.shape()[0], outputs])
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
    fn to_bytes(&self) -> PyResult<Vec<u8>> {
        network_to_bytes(&self.network, "feed_axis").map_err(raise::<NetworkError>)
    }

    /// Reads a network's file, also one of the stage `train`.
    #[classmethod]
    fn load(_: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        let read = network_from_bytes(&std::fs::read(path)?);
        let (network, _) = read.map_err(raise::<NetworkError>)?;
        Ok(Self {
            network,
            losses: Vec::new(),
        })
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
    /// Draws one-cycle samples over a Latin hypercube of the axis' sample ranges; `near_zero`
    /// has speeds the denser, the nearer to zero, where friction is.
    #[pyo3(signature = (count, *, seed = 1, near_zero = false, progress = None))]
    fn sample(
        &self,
        py: Python<'_>,
        count: usize,
        seed: u64,
        near_zero: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Samples> {
        let axis = self.axis.clone();
        let samples = long(py, progress, move |hook| {
            let density = match near_zero {
                true => SpeedDensity::NEAR_ZERO,
                false => SpeedDensity::Uniform,
            };
            let plan = SamplePlan {
                count,
                seed,
                density,
            };
            let sampler = Sampler::new(&axis, &plan).map_err(raise::<NetworkError>)?;
            let mut all = SampleSet::default();
            for first in (0..count).step_by(ROWS) {
                let last = (first + ROWS).min(count);
                let rows = sampler.rows(first..last);
                let rows = rows.map_err(raise::<NetworkError>)?;
                all.inputs.extend(rows.inputs);
                all.increments.extend(rows.increments);
                hook.done("sample", last as u64, count as u64);
            }
            Ok(all)
        })?;
        Ok(Samples(samples))
    }

    /// Trains the one-cycle predictor: what the best linear map of the samples leaves.
    #[pyo3(signature = (samples, *, hidden = vec![34, 19, 8], epochs = 500, seed = 1, threads = 0, progress = None))]
    #[allow(clippy::too_many_arguments)]
    fn train(
        &self,
        py: Python<'_>,
        samples: PyRef<'_, Samples>,
        hidden: Vec<usize>,
        epochs: usize,
        seed: u64,
        threads: usize,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyNetwork> {
        let (axis, samples) = (self.axis.clone(), samples.0.clone());
        long(py, progress, move |hook| {
            let plan = NetworkPlan {
                hidden,
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
