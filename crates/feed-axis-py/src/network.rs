//! Networks, their training and prediction.

use std::path::PathBuf;

use axis_pipeline::training::test;
use cfnn::artifact::{network_from_bytes, network_to_bytes};
use cfnn::train::{Dataset, Trainer, TrainingSettings};
use cfnn::{Network, Shape};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::arrays::{Layers, rows, rows_of};
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
    /// Trains by Levenberg–Marquardt on inputs x and targets y, a row a sample; of one variable
    /// also arrays of one dimension.
    /// `progress("train", epoch, epochs)`.
    #[classmethod]
    #[pyo3(signature = (x, y, *, hidden = Layers(vec![10]), epochs = 100, seed = 1, threads = 0, progress = None))]
    #[allow(clippy::too_many_arguments)]
    fn train<'py>(
        _: &Bound<'py, PyType>,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        y: &Bound<'py, PyAny>,
        hidden: Layers,
        epochs: usize,
        seed: u64,
        threads: usize,
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
