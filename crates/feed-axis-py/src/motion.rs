//! Motions: a move, an S-curve, a program.

use std::path::PathBuf;
use std::sync::Arc;

use axis_pipeline::strategies::SharedMotion;
use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, MoveSpec};
use numpy::IntoPyArray;
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use trajectories::{Limits, Motion, ProgramUnit, SCurve};

use crate::errors::{MotionError, raise};

/// A move from rest to rest, from where the axis' motions start: along a line, or with
/// `Move.turn` about an axis.
#[pyclass(module = "feed_axis", frozen, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct Move {
    spec: MoveSpec,
    freedom: Freedom,
}

impl Move {
    pub(crate) fn of(spec: &MoveSpec, freedom: Freedom) -> Self {
        let spec = *spec;
        Self { spec, freedom }
    }

    fn new_of(
        displacement: f64,
        [speed, acceleration, jerk]: [f64; 3],
        freedom: Freedom,
    ) -> PyResult<Self> {
        let limits = Limits::new(speed, acceleration, jerk).map_err(raise::<MotionError>)?;
        let spec = MoveSpec {
            displacement,
            limits,
        };
        Ok(Self { spec, freedom })
    }

    /// A value that only such a move has.
    fn only(&self, freedom: Freedom, name: &str, value: f64) -> PyResult<f64> {
        match self.freedom == freedom {
            true => Ok(value),
            false => Err(PyAttributeError::new_err(format!(
                "this move is in {}: it has no {name}",
                self.freedom.unit()
            ))),
        }
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
        let limits = [speed_m_s, acceleration_m_s2, jerk_m_s3];
        Self::new_of(distance_m, limits, Freedom::Linear)
    }

    /// A move of an axis that turns.
    #[staticmethod]
    #[pyo3(signature = (*, distance_rad, speed_rad_s, acceleration_rad_s2, jerk_rad_s3))]
    fn turn(
        distance_rad: f64,
        speed_rad_s: f64,
        acceleration_rad_s2: f64,
        jerk_rad_s3: f64,
    ) -> PyResult<Self> {
        let limits = [speed_rad_s, acceleration_rad_s2, jerk_rad_s3];
        Self::new_of(distance_rad, limits, Freedom::Rotary)
    }

    /// Distance with its sign, m.
    #[getter]
    fn distance_m(&self) -> PyResult<f64> {
        self.only(Freedom::Linear, "distance_m", self.spec.displacement)
    }

    /// Greatest speed, m/s.
    #[getter]
    fn speed_m_s(&self) -> PyResult<f64> {
        self.only(Freedom::Linear, "speed_m_s", self.spec.limits.velocity())
    }

    /// Greatest acceleration, m/s².
    #[getter]
    fn acceleration_m_s2(&self) -> PyResult<f64> {
        let value = self.spec.limits.acceleration();
        self.only(Freedom::Linear, "acceleration_m_s2", value)
    }

    /// Greatest jerk, m/s³.
    #[getter]
    fn jerk_m_s3(&self) -> PyResult<f64> {
        self.only(Freedom::Linear, "jerk_m_s3", self.spec.limits.jerk())
    }

    /// Distance with its sign, rad.
    #[getter]
    fn distance_rad(&self) -> PyResult<f64> {
        self.only(Freedom::Rotary, "distance_rad", self.spec.displacement)
    }

    /// Greatest speed, rad/s.
    #[getter]
    fn speed_rad_s(&self) -> PyResult<f64> {
        self.only(Freedom::Rotary, "speed_rad_s", self.spec.limits.velocity())
    }

    /// Greatest acceleration, rad/s².
    #[getter]
    fn acceleration_rad_s2(&self) -> PyResult<f64> {
        let value = self.spec.limits.acceleration();
        self.only(Freedom::Rotary, "acceleration_rad_s2", value)
    }

    /// Greatest jerk, rad/s³.
    #[getter]
    fn jerk_rad_s3(&self) -> PyResult<f64> {
        self.only(Freedom::Rotary, "jerk_rad_s3", self.spec.limits.jerk())
    }

    fn __repr__(&self) -> String {
        let limits = &self.spec.limits;
        let (call, unit) = match self.freedom {
            Freedom::Linear => ("Move", "m"),
            Freedom::Rotary => ("Move.turn", "rad"),
        };
        format!(
            "{call}(distance_{unit}={}, speed_{unit}_s={}, acceleration_{unit}_s2={}, jerk_{unit}_s3={})",
            self.spec.displacement,
            limits.velocity(),
            limits.acceleration(),
            limits.jerk()
        )
    }
}

/// The move in least time between two rests within limits of speed, acceleration and jerk: along a
/// line, or with `SCurve.turn` about an axis.
#[pyclass(module = "feed_axis", name = "SCurve", frozen)]
pub(crate) struct PySCurve {
    curve: SCurve,
    freedom: Freedom,
}

impl PySCurve {
    fn new_of(
        [start, end]: [f64; 2],
        [speed, acceleration, jerk]: [f64; 3],
        freedom: Freedom,
    ) -> PyResult<Self> {
        let limits = Limits::new(speed, acceleration, jerk).map_err(raise::<MotionError>)?;
        let curve = SCurve::plan(start, end, &limits).map_err(raise::<MotionError>)?;
        Ok(Self { curve, freedom })
    }
}

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
        let limits = [speed_m_s, acceleration_m_s2, jerk_m_s3];
        Self::new_of([start_m, end_m], limits, Freedom::Linear)
    }

    /// The same of an axis that turns.
    #[staticmethod]
    #[pyo3(signature = (start_rad, end_rad, *, speed_rad_s, acceleration_rad_s2, jerk_rad_s3))]
    fn turn(
        start_rad: f64,
        end_rad: f64,
        speed_rad_s: f64,
        acceleration_rad_s2: f64,
        jerk_rad_s3: f64,
    ) -> PyResult<Self> {
        let limits = [speed_rad_s, acceleration_rad_s2, jerk_rad_s3];
        Self::new_of([start_rad, end_rad], limits, Freedom::Rotary)
    }

    /// Time from rest to rest, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.curve.duration()
    }

    /// The motion every `period_s`, as a dict of arrays: t_s, position_m, speed_m_s,
    /// acceleration_m_s2, jerk_m_s3; of one that turns position_rad, speed_rad_s and so on.
    fn sample<'py>(&self, py: Python<'py>, period_s: f64) -> PyResult<Bound<'py, PyDict>> {
        sampled(py, &self.curve, period_s, self.freedom)
    }

    fn __repr__(&self) -> String {
        let curve = &self.curve;
        let (from, to) = (curve.at(0.0).position, curve.at(f64::INFINITY).position);
        let unit = self.freedom.unit();
        format!("SCurve({from} to {to} {unit} in {:.6} s)", curve.duration())
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
        let freedom = match self.0.unit() {
            ProgramUnit::Millimetres => Freedom::Linear,
            ProgramUnit::Degrees => Freedom::Rotary,
        };
        sampled(py, &self.0, period_s, freedom)
    }

    fn __repr__(&self) -> String {
        let steps = self.0.steps().len();
        format!("Program({steps} steps, {:.6} s)", self.0.duration())
    }
}

/// Most samples of a motion that are given at once.
const MOST_SAMPLES: f64 = 1e8;

fn sampled<'py>(
    py: Python<'py>,
    motion: &dyn Motion,
    period: f64,
    freedom: Freedom,
) -> PyResult<Bound<'py, PyDict>> {
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
    let names = match freedom {
        Freedom::Linear => ["position_m", "speed_m_s", "acceleration_m_s2", "jerk_m_s3"],
        Freedom::Rotary => [
            "position_rad",
            "speed_rad_s",
            "acceleration_rad_s2",
            "jerk_rad_s3",
        ],
    };
    let columns = names.into_iter().zip([
        column(|at| at.position),
        column(|at| at.velocity),
        column(|at| at.acceleration),
        column(|at| at.jerk),
    ]);
    let dict = PyDict::new(py);
    for (name, column) in columns {
        dict.set_item(name, column.into_pyarray(py))?;
    }
    dict.set_item("t_s", instants.into_pyarray(py))?;
    Ok(dict)
}

/// Refuses a motion in the unit of other axes.
fn check(freedom: Freedom, axis: &Axis, class: &str) -> PyResult<()> {
    let [found, valid] = [freedom, axis.freedom()].map(|freedom| match freedom {
        Freedom::Linear => ("in m", "moves along a line", String::new()),
        Freedom::Rotary => ("in rad", "turns", ".turn".to_owned()),
    });
    match freedom == axis.freedom() {
        true => Ok(()),
        false => Err(MotionError::new_err(format!(
            "the motion is {}, and the axis {:?} {}: give {class}{}(...), {}",
            found.0, axis.name, valid.1, valid.2, valid.0
        ))),
    }
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
                check(one.freedom, axis, "Move")?;
                let planned = axis.plan(&one.spec);
                Arc::new(planned.map_err(raise::<MotionError>)?)
            }
            Self::SCurve(curve) => {
                check(curve.freedom, axis, "SCurve")?;
                Arc::new(curve.curve)
            }
            Self::Program(program) => {
                axis.takes(&program.0).map_err(MotionError::new_err)?;
                Arc::new(program.0.clone())
            }
        })
    }
}
