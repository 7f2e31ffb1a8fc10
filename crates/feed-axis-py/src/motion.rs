//! Motions: a move, an S-curve, a program.

use std::path::PathBuf;
use std::sync::Arc;

use axis_pipeline::strategies::SharedMotion;
use axis_sim::{Axis, MoveSpec};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use trajectories::{Limits, Motion, SCurve};

use crate::errors::{MotionError, raise};

/// A move from rest to rest, from where the axis' motions start. On an axis that turns, read
/// rad for m.
#[pyclass(module = "feed_axis", frozen, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct Move {
    pub(crate) spec: MoveSpec,
}

impl Move {
    pub(crate) fn of(spec: &MoveSpec) -> Self {
        Self { spec: *spec }
    }
}

#[pymethods]
impl Move {
    #[new]
    #[pyo3(signature = (*, distance_m, speed_m_s, acceleration_m_s2, jerk_m_s3))]
    fn new(
        distance_m: f64,
        speed_m_s: f64,
        acceleration_m_s2: f64,
        jerk_m_s3: f64,
    ) -> PyResult<Self> {
        let limits = Limits::new(speed_m_s, acceleration_m_s2, jerk_m_s3);
        let spec = MoveSpec {
            displacement: distance_m,
            limits: limits.map_err(raise::<MotionError>)?,
        };
        Ok(Self { spec })
    }

    /// Distance with its sign, m.
    #[getter]
    fn distance_m(&self) -> f64 {
        self.spec.displacement
    }

    /// Greatest speed, m/s.
    #[getter]
    fn speed_m_s(&self) -> f64 {
        self.spec.limits.velocity()
    }

    /// Greatest acceleration, m/s².
    #[getter]
    fn acceleration_m_s2(&self) -> f64 {
        self.spec.limits.acceleration()
    }

    /// Greatest jerk, m/s³.
    #[getter]
    fn jerk_m_s3(&self) -> f64 {
        self.spec.limits.jerk()
    }

    fn __repr__(&self) -> String {
        let limits = &self.spec.limits;
        format!(
            "Move(distance_m={}, speed_m_s={}, acceleration_m_s2={}, jerk_m_s3={})",
            self.spec.displacement,
            limits.velocity(),
            limits.acceleration(),
            limits.jerk()
        )
    }
}

/// The move in least time between two rests within limits of speed, acceleration and jerk.
#[pyclass(module = "feed_axis", name = "SCurve", frozen)]
pub(crate) struct PySCurve(SCurve);

#[pymethods]
impl PySCurve {
    #[new]
    #[pyo3(signature = (start_m, end_m, *, speed_m_s, acceleration_m_s2, jerk_m_s3))]
    fn new(
        start_m: f64,
        end_m: f64,
        speed_m_s: f64,
        acceleration_m_s2: f64,
        jerk_m_s3: f64,
    ) -> PyResult<Self> {
        let limits = Limits::new(speed_m_s, acceleration_m_s2, jerk_m_s3);
        let limits = limits.map_err(raise::<MotionError>)?;
        let curve = SCurve::plan(start_m, end_m, &limits);
        Ok(Self(curve.map_err(raise::<MotionError>)?))
    }

    /// Time from rest to rest, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.0.duration()
    }

    /// The motion every `period_s`, as a dict of arrays: t_s, position_m, speed_m_s,
    /// acceleration_m_s2, jerk_m_s3.
    fn sample<'py>(&self, py: Python<'py>, period_s: f64) -> PyResult<Bound<'py, PyDict>> {
        sampled(py, &self.0, period_s)
    }

    fn __repr__(&self) -> String {
        let (from, to) = (self.0.at(0.0).position, self.0.at(f64::INFINITY).position);
        format!("SCurve({from} to {to} m in {:.6} s)", self.0.duration())
    }
}

/// Moves, dwells, sines and chirps one after the other.
#[pyclass(module = "feed_axis", frozen)]
pub(crate) struct Program(pub(crate) trajectories::Program);

#[pymethods]
impl Program {
    /// Reads a motion program (TOML).
    #[classmethod]
    fn load(kind: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        Self::from_toml(kind, &std::fs::read_to_string(path)?)
    }

    /// Reads the text of a motion program.
    #[classmethod]
    fn from_toml(_: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        toml::from_str(text).map(Self).map_err(raise::<MotionError>)
    }

    /// Its text, as `from_toml` reads it.
    fn to_toml(&self) -> PyResult<String> {
        toml::to_string(&self.0).map_err(raise::<MotionError>)
    }

    /// Time from the first to the last instant, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.0.duration()
    }

    /// The motion every `period_s`, as `SCurve.sample`.
    fn sample<'py>(&self, py: Python<'py>, period_s: f64) -> PyResult<Bound<'py, PyDict>> {
        sampled(py, &self.0, period_s)
    }

    fn __repr__(&self) -> String {
        let steps = self.0.steps().len();
        format!("Program({steps} steps, {:.6} s)", self.0.duration())
    }
}

/// Most samples of a motion that are given at once.
const MOST_SAMPLES: f64 = 1e8;

fn sampled<'py>(py: Python<'py>, motion: &dyn Motion, period: f64) -> PyResult<Bound<'py, PyDict>> {
    let count = motion.duration() / period;
    if !(period > 0.0 && count < MOST_SAMPLES) {
        return Err(MotionError::new_err(format!(
            "period_s is {period}, but must be greater than 0 and give at most {MOST_SAMPLES:e} samples"
        )));
    }
    // An end that rounding has put a hair before its instant is one.
    let instants: Vec<f64> = (0..=(count + 1e-9) as usize)
        .map(|k| k as f64 * period)
        .collect();
    let column = |of: fn(trajectories::Setpoint) -> f64| -> Vec<f64> {
        instants.iter().map(|&t| of(motion.at(t))).collect()
    };
    let columns = [
        ("position_m", column(|at| at.position)),
        ("speed_m_s", column(|at| at.velocity)),
        ("acceleration_m_s2", column(|at| at.acceleration)),
        ("jerk_m_s3", column(|at| at.jerk)),
    ];
    let dict = PyDict::new(py);
    for (name, column) in columns {
        dict.set_item(name, column.into_pyarray(py))?;
    }
    dict.set_item("t_s", instants.into_pyarray(py))?;
    Ok(dict)
}

/// A motion as a caller may give it.
#[derive(FromPyObject)]
pub(crate) enum AnyMotion<'py> {
    Move(PyRef<'py, Move>),
    SCurve(PyRef<'py, PySCurve>),
    Program(PyRef<'py, Program>),
}

impl AnyMotion<'_> {
    /// The motion on an axis.
    pub(crate) fn on(&self, axis: &Axis) -> PyResult<SharedMotion> {
        Ok(match self {
            Self::Move(one) => {
                let planned = axis.plan(&one.spec);
                Arc::new(planned.map_err(raise::<MotionError>)?)
            }
            Self::SCurve(curve) => Arc::new(curve.0),
            Self::Program(program) => {
                axis.takes(&program.0).map_err(MotionError::new_err)?;
                Arc::new(program.0.clone())
            }
        })
    }
}
