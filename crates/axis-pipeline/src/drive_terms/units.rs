//! Units of an axis, and those that drives use.

use std::f64::consts::{PI, TAU};

use axis_sim::Axis;
use axis_sim::mechanism::Freedom;

/// Units of an axis, and factors from SI to those that drives use.
pub(super) struct Units {
    pub load: &'static str,
    pub inertia: &'static str,
    pub torque: &'static str,
    pub angle: &'static str,
    pub effort: &'static str,
    /// Speed of the load.
    pub feed: (f64, &'static str),
    /// Speed of the motor.
    pub speed: (f64, &'static str),
    pub drive_inertia: (f64, &'static str),
    pub viscous: (f64, &'static str),
    pub turn: (f64, &'static str),
}

impl Units {
    /// That of the load's position per a unit of time or a power of one.
    pub fn per_time(&self, time: &str) -> String {
        format!("{}/{time}", self.load)
    }

    pub fn motor_speed(&self) -> String {
        format!("{}/s", self.angle)
    }

    pub fn of(axis: &Axis) -> Self {
        const RPM: f64 = 30.0 / PI;
        let load = axis.freedom().unit();
        let linear = (60e3, "mm/min");
        let feed = if load == "m" { linear } else { (RPM, "rpm") };
        let effort = axis.actuator.effort().unit();
        if axis.mechanism.motor_freedom() == Freedom::Linear {
            return Self {
                load,
                inertia: "kg",
                torque: "N",
                angle: "m",
                effort,
                feed,
                speed: linear,
                drive_inertia: (1.0, "kg"),
                viscous: (1.0 / 60.0, "N/(m/min)"),
                turn: (1.0, "1"),
            };
        }
        Self {
            load,
            inertia: "kg·m²",
            torque: "N·m",
            angle: "rad",
            effort,
            feed,
            speed: (RPM, "rpm"),
            drive_inertia: (1e4, "kg·cm²"),
            viscous: (1e3 / RPM, "N·m/(1000 rpm)"),
            turn: match load {
                "m" => (1e3 * TAU, "mm/rev"),
                _ => (1.0, "rev/rev"),
            },
        }
    }
}
