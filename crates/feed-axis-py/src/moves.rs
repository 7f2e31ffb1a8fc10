//! Moves: from where the axis' motions start, and S-curves.

use axis_sim::MoveSpec;
use axis_sim::mechanism::Freedom;
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use trajectories::{Limits, Motion, SCurve};

use crate::errors::{MotionError, raise};
use crate::sampled_motion::sampled;
use crate::value::{Value, value};

/// A move from rest to rest, from where the axis' motions start: along a line, or with
/// `Move.turn` about an axis.
#[pyclass(module = "feed_axis", frozen, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct Move {
    pub(crate) spec: MoveSpec,
    pub(crate) freedom: Freedom,
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
        if !displacement.is_finite() {
            let unit = freedom.unit();
            return Err(MotionError::new_err(format!(
                "distance_{unit} is {displacement}; valid: a finite number"
            )));
        }
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

/// Freedom of a state.
fn freedom_of(turns: bool) -> Freedom {
    match turns {
        true => Freedom::Rotary,
        false => Freedom::Linear,
    }
}

impl Value for Move {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let MoveSpec {
            displacement,
            limits,
        } = &self.spec;
        let turns = self.freedom == Freedom::Rotary;
        (turns, *displacement, numbers(limits)).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (turns, displacement, limits): (bool, f64, (f64, f64, f64)) = state.extract()?;
        Self::new_of(displacement, limits.into(), freedom_of(turns))
    }
}

/// Speed, acceleration and jerk.
fn numbers(limits: &Limits) -> (f64, f64, f64) {
    (limits.velocity(), limits.acceleration(), limits.jerk())
}

value!(Move, hash);

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
    pub(crate) curve: SCurve,
    pub(crate) freedom: Freedom,
    /// From and to.
    ends: [f64; 2],
    limits: Limits,
}

impl Value for PySCurve {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let turns = self.freedom == Freedom::Rotary;
        let [from, to] = self.ends;
        (turns, (from, to), numbers(&self.limits)).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (turns, ends, limits): (bool, (f64, f64), (f64, f64, f64)) = state.extract()?;
        Self::new_of(ends.into(), limits.into(), freedom_of(turns))
    }
}

value!(PySCurve, hash);

impl PySCurve {
    fn new_of(
        [start, end]: [f64; 2],
        [speed, acceleration, jerk]: [f64; 3],
        freedom: Freedom,
    ) -> PyResult<Self> {
        let limits = Limits::new(speed, acceleration, jerk).map_err(raise::<MotionError>)?;
        let curve = SCurve::plan(start, end, &limits).map_err(raise::<MotionError>)?;
        Ok(Self {
            curve,
            freedom,
            ends: [start, end],
            limits,
        })
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
