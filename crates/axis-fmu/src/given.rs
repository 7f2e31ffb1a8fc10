//! What is set at a communication point, as simulations take it.

use axis_sim::Axis;
use trajectories::Setpoint;

use crate::outputs::is_force;

/// Most axes of a unit.
pub(crate) const MOST_AXES: usize = 3;

/// The inputs of all axes; those of an axis alone are the first.
pub(crate) type Inputs = [Given; MOST_AXES];

/// What an input of an axis is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Reference of the position, m or rad.
    Position,
    /// Of the speed, m/s or rad/s.
    Velocity,
    /// Of the acceleration, m/s² or rad/s².
    Acceleration,
    /// Torque (N·m) or force (N) of the motor; in a closed loop, what is added to the controller's.
    Motor,
    /// Current of a plant's motor, A, whose torque is added.
    Current,
    /// Force on the load, N or N·m, positive against positive motion.
    Load,
}

/// What is given to an axis.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Given {
    /// Of a plant, its position is where it begins.
    pub reference: Setpoint,
    /// N·m at the motor, or N at a load that is one with it.
    pub motor: f64,
    /// Current of the motor beside that, A.
    pub current: f64,
    /// N or N·m.
    pub load: f64,
}

impl Given {
    /// Sets one.
    pub fn set(&mut self, quantity: Quantity, value: f64) {
        *match quantity {
            Quantity::Position => &mut self.reference.position,
            Quantity::Velocity => &mut self.reference.velocity,
            Quantity::Acceleration => &mut self.reference.acceleration,
            Quantity::Motor => &mut self.motor,
            Quantity::Current => &mut self.current,
            Quantity::Load => &mut self.load,
        } = value;
    }

    /// Torque that it asks of the motor, N·m.
    pub fn motor_torque(&self, axis: &Axis) -> f64 {
        let own = match is_force(axis) {
            true => self.motor * axis.travel_per_radian(),
            false => self.motor,
        };
        own + self.current * axis.torque_constant()
    }
}
