//! What a compensator is told and what it answers, each cycle.

use compensator::{Reference, Sample};
use pyo3::prelude::*;

/// What a controller knows at the start of a control cycle. SI units, at the load; rad for m
/// on an axis that turns.
#[pyclass(
    module = "feed_axis",
    name = "Sample",
    get_all,
    set_all,
    from_py_object
)]
#[derive(Clone, Default)]
pub(crate) struct PySample {
    /// Reference now, m, m/s, m/s².
    reference: (f64, f64, f64),
    /// Reference one cycle ahead, m, m/s, m/s².
    next_reference: (f64, f64, f64),
    /// Measured position of the load, m.
    position_m: f64,
    /// Measured motor angle, rad.
    motor_angle_rad: f64,
    /// Measured motor speed, rad/s.
    motor_speed_rad_s: f64,
    /// Measured q current, A.
    iq_a: f64,
    /// q current that was commanded in the cycle before, A.
    iq_command_a: f64,
}

#[pymethods]
impl PySample {
    #[new]
    #[pyo3(signature = (*, reference = (0.0, 0.0, 0.0), next_reference = (0.0, 0.0, 0.0), position_m = 0.0, motor_angle_rad = 0.0, motor_speed_rad_s = 0.0, iq_a = 0.0, iq_command_a = 0.0))]
    fn new(
        reference: (f64, f64, f64),
        next_reference: (f64, f64, f64),
        position_m: f64,
        motor_angle_rad: f64,
        motor_speed_rad_s: f64,
        iq_a: f64,
        iq_command_a: f64,
    ) -> Self {
        Self {
            reference,
            next_reference,
            position_m,
            motor_angle_rad,
            motor_speed_rad_s,
            iq_a,
            iq_command_a,
        }
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
            iq_command: self.iq_command_a,
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
            iq_command_a: sample.iq_command,
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
    /// Added to the speed controller's current command, A.
    pub(crate) iq_a: f64,
}

#[pymethods]
impl PyCorrection {
    #[new]
    #[pyo3(signature = (position_m = 0.0, iq_a = 0.0))]
    fn new(position_m: f64, iq_a: f64) -> Self {
        Self { position_m, iq_a }
    }

    fn __repr__(&self) -> String {
        format!(
            "Correction(position_m={}, iq_a={})",
            self.position_m, self.iq_a
        )
    }
}
