//! A motor with all that it moves on one rigid shaft.

use axis_scalar::Scalar;
use foc_pmsm::{Dq, Measurement, Pmsm};

pub const RADIUS: f64 = 0.01 / core::f64::consts::TAU;
/// A table of 515 kg, and 0.005 kg·m² of rotor and screw.
pub const INERTIA: f64 = 515.0 * RADIUS * RADIUS + 0.005;

/// The currents are in the controller's scalar, what turns is always `f64`:
/// a machine does not round.
pub struct Rigid<T = f64> {
    pub motor: Pmsm<T>,
    /// kg·m².
    pub inertia: f64,
    /// m/rad.
    pub radius: f64,
    pub angle: f64,
    pub speed: f64,
    pub current: Dq<T>,
}

impl<T: Scalar> Rigid<T> {
    /// The paper's table at rest.
    pub fn table(motor: Pmsm<T>) -> Self {
        Self {
            motor,
            inertia: INERTIA,
            radius: RADIUS,
            angle: 0.0,
            speed: 0.0,
            current: Dq::ZERO,
        }
    }

    pub fn measure(&self) -> Measurement<T> {
        Measurement {
            position: T::of(self.radius * self.angle),
            motor_speed: T::of(self.speed),
            current: self.current,
        }
    }

    pub fn advance(&mut self, u: Dq<T>, load: f64, period: f64) {
        let (speed, h) = (T::of(self.speed), T::of(period));
        let next = self.motor.step(self.current, u, speed, h);
        let torque = self.motor.torque((self.current + next) * T::HALF);
        let acceleration = (torque.to_f64() - load) / self.inertia;
        self.angle += (self.speed + 0.5 * acceleration * period) * period;
        self.speed += acceleration * period;
        self.current = next;
    }
}
