//! Networks, their training and prediction.

use std::path::PathBuf;

use axis_pipeline::training::test;
use cfnn::artifact::{network_from_bytes, network_to_bytes};
use cfnn::train::{Dataset, Trainer, TrainingSettings};
use cfnn::{Network, Shape};
use numpy::{
    AllowTypeChange, IntoPyArray, PyArray1, PyArray2, PyArrayLike2, PyArrayMethods,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::errors::{NetworkError, raise};
use crate::long::long;
use crate::one_cycle::Samples;

/// A cascade-forward network.
#[pyclass(module = "feed_axis", name = "Network", frozen)]
pub(crate) struct PyNetwork {
    pub(crate) network: Network,
    /// Mean square of the scaled residuals after each epoch.
    pub(crate) losses: Vec<f64>,
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
