//! Friction and transfer functions, identified on a simulated axis.

use std::sync::atomic::{AtomicU64, Ordering};

use axis_pipeline::identification::{IdentificationPlan, identify};
use axis_pipeline::strategies::TransferModels;
use axis_pipeline::transfer::{TransferPlan, identify_transfer};
use axis_sim::NoiseLevels;
use compensator::TransferFunctionModel;
use lugre::LuGre;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays;
use crate::axis::PyAxis;
use crate::errors::{StrategyError, raise};
use crate::long::{Hook, long};
use crate::lugre_law::PyLuGre;
use crate::value::{Value, value};

/// Linear models of an axis' tracking error, without and with friction feed-forward.
#[pyclass(module = "feed_axis", frozen)]
pub(crate) struct TransferFunctions(pub(crate) TransferModels);

/// Period, direct feed-through, poles, coefficients.
type Numbers = (f64, f64, Vec<f64>, Vec<f64>);

impl Value for TransferFunctions {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let numbers = |model: &TransferFunctionModel| {
            let poles = PyTuple::new(py, model.poles())?;
            let coefficients = PyTuple::new(py, model.coefficients())?;
            (model.period(), model.direct(), poles, coefficients).into_pyobject(py)
        };
        let TransferModels {
            alone,
            with_feedforward,
        } = &self.0;
        (numbers(alone)?, numbers(with_feedforward)?).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (alone, with_feedforward): (Numbers, Numbers) = state.extract()?;
        let model = |(period, direct, poles, coefficients): Numbers| {
            let model = TransferFunctionModel::new(period, direct, &poles, &coefficients);
            model.map_err(raise::<StrategyError>)
        };
        Ok(Self(TransferModels {
            alone: model(alone)?,
            with_feedforward: model(with_feedforward)?,
        }))
    }
}

value!(TransferFunctions, hash);

#[pymethods]
impl TransferFunctions {
    fn __repr__(&self) -> &'static str {
        "TransferFunctions(of the tracking error, without and with friction feed-forward)"
    }
}

/// Counts what is done, from any thread.
fn counting<'a>(hook: &'a Hook, what: &'a str, total: u64) -> impl Fn() + Sync + 'a {
    let done = AtomicU64::new(0);
    let hook = std::sync::Mutex::new(hook.clone());
    move || {
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        let hook = hook.lock().map(|hook| hook.clone());
        if let Ok(hook) = hook {
            hook.done(what, done, total);
        }
    }
}

#[pymethods]
impl PyAxis {
    /// Identifies the friction of this axis from simulated experiments: constant speeds and
    /// small motions about a standstill, as its sensors log them, with `noise` times the noise
    /// of a good scale, motor encoder and current sensor besides.
    #[pyo3(signature = (*, noise = 1.0, seed = 0, progress = None))]
    fn identify_friction(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arrays::noise)] noise: f64,
        #[pyo3(from_py_with = arrays::seed)] seed: u64,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyLuGre> {
        let axis = self.axis.clone();
        let law = long(py, progress, move |hook| {
            let plan = IdentificationPlan {
                seed,
                ..IdentificationPlan::of(&axis)
            };
            let sensors = NoiseLevels::good(&axis).scaled(noise).sensors(seed);
            let count = counting(hook, "friction runs", plan.motions());
            let session = identify(&axis, &axis, &plan, sensors, count);
            let found = session.map_err(raise::<StrategyError>)?.found;
            LuGre::new(found.law).map_err(raise::<StrategyError>)
        })?;
        Ok(PyLuGre(law))
    }

    /// Identifies transfer functions of this axis' tracking error from simulated moves.
    #[pyo3(signature = (*, seed = 0, progress = None))]
    fn identify_transfer(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arrays::seed)] seed: u64,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<TransferFunctions> {
        let axis = self.axis.clone();
        let models = long(py, progress, move |hook| {
            let plan = TransferPlan {
                seed,
                ..TransferPlan::default()
            };
            let total = 2 * (plan.training + plan.validation) as u64;
            let count = counting(hook, "moves", total);
            let fit = |feedforward| {
                let fit = identify_transfer(&axis, &plan, feedforward, &count);
                Ok::<_, PyErr>(fit.map_err(raise::<StrategyError>)?.model)
            };
            Ok(TransferModels {
                alone: fit(false)?,
                with_feedforward: fit(true)?,
            })
        })?;
        Ok(TransferFunctions(models))
    }
}
