//! One-cycle samples of an axis, and the predictor that is trained on them.

use axis_pipeline::sampling::{SamplePlan, SampleSet, Sampler, SpeedDensity};
use axis_sim::CycleInput;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use crate::arrays;
use crate::axis::PyAxis;
use crate::errors::{NetworkError, raise};
use crate::long::long;
use crate::value::{Value, value};

/// Rows that are simulated between two looks at the hook.
const ROWS: usize = 256;

/// One-cycle samples: state and command at the start of a cycle, and how far the load went.
#[pyclass(module = "feed_axis", frozen)]
pub(crate) struct Samples(pub(crate) SampleSet);

/// As bytes of little-endian numbers, five a sample: equal to the bit, and small.
impl Value for Samples {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let all = self.0.inputs.iter().zip(&self.0.increments);
        let row =
            |(i, s): (&CycleInput, &f64)| [i.position, i.speed, i.acceleration, i.command, *s];
        let numbers = all.flat_map(row).flat_map(f64::to_le_bytes);
        (PyBytes::new(py, &numbers.collect::<Vec<u8>>()),).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (bytes,): (Bound<'_, PyBytes>,) = state.extract()?;
        let (numbers, _) = bytes.as_bytes().as_chunks::<8>();
        let numbers: Vec<f64> = numbers.iter().map(|n| f64::from_le_bytes(*n)).collect();
        let mut all = SampleSet::default();
        for row in numbers.as_chunks::<5>().0 {
            let [position, speed, acceleration, command, increment] = *row;
            all.inputs.push(CycleInput {
                position,
                speed,
                acceleration,
                command,
            });
            all.increments.push(increment);
        }
        Ok(Self(all))
    }
}

value!(Samples);

#[pymethods]
impl Samples {
    fn __len__(&self) -> usize {
        self.0.inputs.len()
    }

    /// Position (m), speed (m/s), acceleration (m/s²) and commanded current (A), a row a sample.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let row = |i: &CycleInput| [i.position, i.speed, i.acceleration, i.command];
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

#[pymethods]
impl PyAxis {
    /// Draws one-cycle samples over a Latin hypercube of the axis' sample ranges; `near_zero`
    /// has speeds the denser, the nearer to zero, where friction is.
    #[pyo3(signature = (count, *, seed = 1, near_zero = false, progress = None))]
    fn sample(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arrays::count)] count: usize,
        #[pyo3(from_py_with = arrays::seed)] seed: u64,
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
}
