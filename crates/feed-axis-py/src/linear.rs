//! An axis as a linear model, for other programs of control.

use axis_sim::SetupError;
use compensator::{DriveSituation, SampledDrive};
use drive_loop::{LoopAnalysis, LoopCurves, LoopSet};
use numpy::{Complex64, IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::axis::PyAxis;
use crate::errors::{LoopError, raise};
use crate::long::long;

/// Natural modes that a linear model has, the rigid motion among them, as in `analyse`.
const MODES: usize = 3;

#[pymethods]
impl PyAxis {
    /// The drive without its position and speed controllers, sampled once in each control period,
    /// as matrices: x(k+1) = A x(k) + B u(k), y = C x + D u.
    #[pyo3(signature = (*, position = None, stuck = false))]
    fn state_space<'py>(
        &self,
        py: Python<'py>,
        position: Option<f64>,
        stuck: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let axis = &*self.axis;
        let position = self.within_stroke(position)?;
        let model = axis.drive_model().map_err(raise::<LoopError>)?;
        let mechanism = axis.planned_mechanism().map_err(raise::<LoopError>)?;
        let modes = mechanism.participation(position).map_err(SetupError::from);
        let modes = modes.map_err(raise::<LoopError>)?;
        let situation = DriveSituation {
            sticking: if stuck { 1.0 } else { 0.0 },
            mass: 1.0,
            friction: 1.0,
            bristles: 1.0,
            sliding: 0.0,
        };
        let used = &modes[..modes.len().min(MODES)];
        let drive = SampledDrive::new(&model, used, false, &situation);
        // The last state is the force against the load, which is an input to others.
        let n = drive.a.nrows() - 1;
        let force = drive.units[n];
        let input = |k: usize| [drive.b[k] / model.effort_limit, drive.a[(k, n)] / force];
        let rows = [&drive.load, &drive.motor, &drive.motor_speed];
        let matrix = |rows: Vec<Vec<f64>>, columns: usize| {
            let shape = [rows.len(), columns];
            rows.concat().into_pyarray(py).reshape(shape)
        };
        let a = (0..n).map(|k| (0..n).map(|j| drive.a[(k, j)]).collect());
        let b = (0..n).map(|k| input(k).to_vec());
        let c = rows.map(|row| (0..n).map(|j| row[j]).collect());
        let d = rows.map(|row| vec![0.0, row[n] / force]);
        let found = PyDict::new(py);
        found.set_item("A", matrix(a.collect(), n)?)?;
        found.set_item("B", matrix(b.collect(), 2)?)?;
        found.set_item("C", matrix(c.to_vec(), n)?)?;
        found.set_item("D", matrix(d.to_vec(), 2)?)?;
        found.set_item("dt_s", model.period)?;
        let effort = axis.actuator.effort().unit();
        let [load, motor] = [axis.freedom(), axis.mechanism.motor_freedom()];
        found.set_item("inputs", ["command", "force"])?;
        found.set_item("input_units", [effort, load.force()[1]])?;
        found.set_item("outputs", ["position", "motor_angle", "motor_speed"])?;
        found.set_item(
            "output_units",
            [load.unit(), motor.unit(), motor.speed_unit()],
        )?;
        Ok(found)
    }

    /// Frequency responses of the loops, as complex arrays over the frequency.
    #[pyo3(signature = (*, position = None, stuck = false, delay_cycles = 0.0))]
    fn frequency_response<'py>(
        &self,
        py: Python<'py>,
        position: Option<f64>,
        stuck: bool,
        delay_cycles: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let set = LoopSet {
            positions: vec![self.within_stroke(position)?],
            masses: vec![1.0],
            frictions: vec![1.0],
            delay: delay_cycles,
            ..LoopSet::default()
        };
        let axis = self.axis.clone();
        let found = long(py, None, move |_| {
            LoopAnalysis::of(&axis, &set).map_err(raise::<LoopError>)
        })?;
        let curves = found.curves.iter().find(|curves| curves.stuck == stuck);
        let curves = curves.ok_or_else(|| {
            LoopError::new_err("there are no responses of a load that sticks; valid: stuck=False")
        })?;
        responses(py, curves)
    }
}

impl PyAxis {
    /// A position of the load; where motions start if none is given.
    fn within_stroke(&self, position: Option<f64>) -> PyResult<f64> {
        let stroke = &self.axis.stroke;
        let position = position.unwrap_or(stroke.start);
        match (stroke.minimum..=stroke.maximum).contains(&position) {
            true => Ok(position),
            false => Err(LoopError::new_err(format!(
                "position {position} is outside the axis' stroke; valid: from {} to {} {}",
                stroke.minimum,
                stroke.maximum,
                self.axis.freedom().unit()
            ))),
        }
    }
}

fn responses<'py>(py: Python<'py>, curves: &LoopCurves) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    found.set_item("frequency_hz", curves.frequency_hz.clone().into_pyarray(py))?;
    let all = [
        ("open_command", &curves.open_command),
        ("open_position", &curves.open_position),
        ("speed_followed", &curves.speed_followed),
        ("compliance", &curves.compliance),
    ];
    for (name, pairs) in all {
        let numbers = pairs.iter().map(|[re, im]| Complex64::new(*re, *im));
        found.set_item(name, numbers.collect::<Vec<_>>().into_pyarray(py))?;
    }
    Ok(found)
}
