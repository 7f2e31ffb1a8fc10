//! Motions: a move, an S-curve, a program.

use std::path::PathBuf;
use std::sync::Arc;

use axis_log::{Channel, Log, TIME_CHANNEL};
use axis_pipeline::strategies::SharedMotion;
use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, LoggedReference, MoveSpec};
use numpy::IntoPyArray;
use pyo3::exceptions::{PyAttributeError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple, PyType};
use trajectories::{Limits, Motion, ProgramUnit, SCurve};

use crate::arrays::samples;
use crate::errors::{MotionError, raise, text_of};
use crate::value::{Value, value};

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
    curve: SCurve,
    freedom: Freedom,
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

/// Moves, dwells, sines and chirps one after the other.
#[pyclass(module = "feed_axis", frozen)]
pub(crate) struct Program {
    program: trajectories::Program,
    /// From which it was read, so that a copy has the same numbers to the last bit.
    text: String,
}

impl Program {
    fn parsed(text: String) -> PyResult<Self> {
        let program = toml::from_str(&text)
            .map_err(|error| MotionError::new_err(axis_sim::toml_message(&text, &error)))?;
        Ok(Self { program, text })
    }

    /// As it comes back from its own text.
    pub(crate) fn of(program: &trajectories::Program) -> PyResult<Self> {
        Self::parsed(toml::to_string(program).map_err(raise::<MotionError>)?)
    }
}

impl Value for Program {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (&self.text,).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (text,) = state.extract()?;
        Self::parsed(text)
    }

    /// Comments and order do not count.
    fn key<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (self.to_toml()?,).into_pyobject(py)
    }
}

value!(Program, hash);

#[pymethods]
impl Program {
    /// Reads a motion program (TOML).
    #[classmethod]
    fn load(kind: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        Self::parsed(text_of::<MotionError>(kind.py(), &path)?)
    }

    /// Reads the text of a motion program.
    #[classmethod]
    fn from_toml(_: &Bound<'_, PyType>, text: String) -> PyResult<Self> {
        Self::parsed(text)
    }

    /// Its text, as `from_toml` reads it.
    fn to_toml(&self) -> PyResult<String> {
        toml::to_string(&self.program).map_err(raise::<MotionError>)
    }

    /// Time from the first to the last instant, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.program.duration()
    }

    /// The motion every `period_s`, as `SCurve.sample`.
    fn sample<'py>(&self, py: Python<'py>, period_s: f64) -> PyResult<Bound<'py, PyDict>> {
        let freedom = match self.program.unit() {
            ProgramUnit::Millimetres => Freedom::Linear,
            ProgramUnit::Degrees => Freedom::Rotary,
        };
        sampled(py, &self.program, period_s, freedom)
    }

    fn __repr__(&self) -> String {
        let steps = self.program.steps().len();
        format!("Program({steps} steps, {:.6} s)", self.program.duration())
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
            "period_s is {period:?}, but must be greater than 0 and give at most {MOST_SAMPLES:e} samples"
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
pub(crate) enum AnyMotion<'py> {
    Move(PyRef<'py, Move>),
    SCurve(PyRef<'py, PySCurve>),
    Program(PyRef<'py, Program>),
    /// Positions at instants that lie evenly, or at each control cycle.
    Sampled {
        instants: Option<Vec<f64>>,
        positions: Vec<f64>,
    },
}

impl<'py> FromPyObject<'_, 'py> for AnyMotion<'py> {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(one) = given.extract() {
            return Ok(Self::Move(one));
        }
        if let Ok(curve) = given.extract() {
            return Ok(Self::SCurve(curve));
        }
        if let Ok(program) = given.extract() {
            return Ok(Self::Program(program));
        }
        // An array, a list, a series: what has a length, and is neither words nor a mapping.
        let is_array = given.len().is_ok() && !given.hasattr("keys")?;
        if !is_array || given.is_instance_of::<PyString>() {
            return Err(PyTypeError::new_err(format!(
                "a {} is no motion; valid: a Move, an SCurve, a Program, positions (one each control period), or a tuple (t_s, positions)",
                given.get_type().name()?
            )));
        }
        let pair: Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)> = match given.cast::<PyTuple>() {
            Ok(pair) if pair.len() == 2 => Some(pair.extract()?),
            _ => None,
        };
        match pair.filter(|(instants, _)| instants.len().is_ok()) {
            Some((instants, positions)) => Ok(Self::Sampled {
                instants: Some(samples::<MotionError>(&instants, "t_s")?),
                positions: samples::<MotionError>(&positions, "positions")?,
            }),
            None => Ok(Self::Sampled {
                instants: None,
                positions: samples::<MotionError>(&given, "positions")?,
            }),
        }
    }
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
            Self::Program(one) => {
                axis.takes(&one.program).map_err(MotionError::new_err)?;
                Arc::new(one.program.clone())
            }
            Self::Sampled {
                instants,
                positions,
            } => Arc::new(sampled_reference(axis, instants.as_deref(), positions)?),
        })
    }
}

/// Share of a period by which time stamps may be off an even grid: what printing them with four
/// digits a period leaves.
const UNEVEN: f64 = 1e-3;

/// The motion through positions, as a log's reference is taken.
fn sampled_reference(
    axis: &Axis,
    instants: Option<&[f64]>,
    positions: &[f64],
) -> PyResult<LoggedReference> {
    let refused = |words: String| Err(MotionError::new_err(words));
    let count = positions.len();
    if count < 2 {
        return refused(format!(
            "there are {count} positions; valid: two at least, one each period"
        ));
    }
    for (name, numbers) in [("positions", positions), ("t_s", instants.unwrap_or(&[]))] {
        if let Some(k) = numbers.iter().position(|x| !x.is_finite()) {
            let bad = numbers[k];
            return refused(format!(
                "{name}[{k}] is {bad}; valid: finite numbers, without holes"
            ));
        }
    }
    let period = match instants {
        None => axis.period,
        Some(instants) if instants.len() != count => {
            let stamps = instants.len();
            return refused(format!(
                "there are {stamps} instants t_s and {count} positions; valid: as many of both"
            ));
        }
        Some(instants) => {
            let period = (instants[count - 1] - instants[0]) / (count - 1) as f64;
            let off = |(k, t): (usize, &f64)| (t - instants[0] - k as f64 * period).abs();
            if period <= 0.0 {
                return refused("t_s does not rise; valid: instants in s, evenly apart".to_owned());
            }
            let uneven = instants.iter().enumerate();
            if let Some((k, t)) = uneven.into_iter().find(|at| off(*at) > UNEVEN * period) {
                return refused(format!(
                    "t_s[{k}] is {t}, off the even grid of {period} s that the ends of t_s give; valid: instants evenly apart (numpy.interp makes them so)"
                ));
            }
            period
        }
    };
    let instants = (0..count).map(|k| k as f64 * period).collect();
    let name = match axis.freedom() {
        Freedom::Linear => "position_ref_m",
        Freedom::Rotary => "position_ref_rad",
    };
    let channels = [(TIME_CHANNEL, instants), (name, positions.to_vec())];
    let channels = channels.map(|(name, samples)| Channel::new(name, samples));
    let channels = channels.into_iter().collect::<Result<Vec<_>, _>>();
    let log = Log::new(channels.map_err(raise::<MotionError>)?).map_err(raise::<MotionError>)?;
    LoggedReference::new(&log, period).map_err(raise::<MotionError>)
}
