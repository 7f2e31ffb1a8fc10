//! What a compensator gets and what it answers, each cycle.

use compensator::{Reference, Sample};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::Triple;
use crate::value::{Value, value};

/// What a controller knows at the start of a control cycle. SI units, at the load; rad for m
/// on an axis that turns.
#[pyclass(module = "feed_axis", name = "Sample", from_py_object)]
#[derive(Clone, Default)]
pub(crate) struct PySample {
    /// Reference now, m, m/s, m/s².
    #[pyo3(get)]
    reference: (f64, f64, f64),
    /// Reference one cycle ahead, m, m/s, m/s².
    #[pyo3(get)]
    next_reference: (f64, f64, f64),
    /// Measured position of the load, m.
    #[pyo3(get, set)]
    position_m: f64,
    /// Measured motor angle, rad.
    #[pyo3(get, set)]
    motor_angle_rad: f64,
    /// Measured motor speed, rad/s.
    #[pyo3(get, set)]
    motor_speed_rad_s: f64,
    /// Measured q current, A; 0 if the actuator has none.
    #[pyo3(get, set)]
    iq_a: f64,
    /// Command of the cycle before in the actuator's unit: q current, A, of a motor with current control.
    #[pyo3(get, set)]
    last_command: f64,
}

impl Value for PySample {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (
            self.reference,
            self.next_reference,
            self.position_m,
            self.motor_angle_rad,
            self.motor_speed_rad_s,
            self.iq_a,
            self.last_command,
        )
            .into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (
            reference,
            next_reference,
            position_m,
            motor_angle_rad,
            motor_speed_rad_s,
            iq_a,
            last_command,
        ) = state.extract()?;
        Ok(Self {
            reference,
            next_reference,
            position_m,
            motor_angle_rad,
            motor_speed_rad_s,
            iq_a,
            last_command,
        })
    }
}

value!(PySample);

#[pymethods]
impl PySample {
    #[new]
    #[pyo3(signature = (*, reference = Triple(0.0, 0.0, 0.0), next_reference = Triple(0.0, 0.0, 0.0), position_m = 0.0, motor_angle_rad = 0.0, motor_speed_rad_s = 0.0, iq_a = 0.0, last_command = 0.0))]
    fn new(
        reference: Triple,
        next_reference: Triple,
        position_m: f64,
        motor_angle_rad: f64,
        motor_speed_rad_s: f64,
        iq_a: f64,
        last_command: f64,
    ) -> Self {
        Self {
            reference: reference.tuple(),
            next_reference: next_reference.tuple(),
            position_m,
            motor_angle_rad,
            motor_speed_rad_s,
            iq_a,
            last_command,
        }
    }

    #[setter]
    fn set_reference(&mut self, reference: Triple) {
        self.reference = reference.tuple();
    }

    #[setter]
    fn set_next_reference(&mut self, next_reference: Triple) {
        self.next_reference = next_reference.tuple();
    }

    fn __repr__(&self) -> String {
        format!(
            "Sample(reference={:?}, position_m={}, motor_speed_rad_s={}, iq_a={})",
            self.reference, self.position_m, self.motor_speed_rad_s, self.iq_a
        )
    }
}

impl PySample {
    pub(crate) fn sample(&self) -> Sample {
        let reference = |(position, velocity, acceleration): (f64, f64, f64)| Reference {
            position,
            velocity,
            acceleration,
        };
        Sample {
            reference: reference(self.reference),
            next_reference: reference(self.next_reference),
            position: self.position_m,
            motor_angle: self.motor_angle_rad,
            motor_speed: self.motor_speed_rad_s,
            iq: self.iq_a,
            last_command: self.last_command,
        }
    }

    pub(crate) fn of(sample: &Sample) -> Self {
        let reference = |r: &Reference| (r.position, r.velocity, r.acceleration);
        Self {
            reference: reference(&sample.reference),
            next_reference: reference(&sample.next_reference),
            position_m: sample.position,
            motor_angle_rad: sample.motor_angle,
            motor_speed_rad_s: sample.motor_speed,
            iq_a: sample.iq,
            last_command: sample.last_command,
        }
    }
}

/// What is added to the controller in a cycle.
#[pyclass(
    module = "feed_axis",
    name = "Correction",
    get_all,
    frozen,
    from_py_object
)]
#[derive(Clone, Default)]
pub(crate) struct PyCorrection {
    /// Added to the position error, m or rad.
    pub(crate) position_m: f64,
    /// Added to the speed controller's command, in the actuator's unit: A, N·m, N or V.
    pub(crate) command: f64,
}

impl Value for PyCorrection {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (self.position_m, self.command).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (position_m, command) = state.extract()?;
        Ok(Self::new(position_m, command))
    }
}

value!(PyCorrection, hash);

#[pymethods]
impl PyCorrection {
    #[new]
    #[pyo3(signature = (position_m = 0.0, command = 0.0))]
    fn new(position_m: f64, command: f64) -> Self {
        Self {
            position_m,
            command,
        }
    }

    fn __repr__(&self) -> String {
        format!(
            "Correction(position_m={}, command={})",
            self.position_m, self.command
        )
    }
}
