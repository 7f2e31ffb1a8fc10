//! Mechanisms: what carries the motor's rotation to the load.

mod ball_screw;
mod belt;
mod direct;
mod elastic;
mod gear;
mod rack;
mod rigid_mass;
mod screw_datasheet;

use std::fmt;
use std::sync::Arc;

use compensator::Mode;
use feed_dynamics::DriveError;

use crate::effects::ScrewState;
pub use crate::freedom::Freedom;
use crate::part::PartKind;
use crate::plant::{Assembly, Plant};
use crate::value_range::ValueRange;

/// All kinds of mechanism, one line each.
pub const MECHANISMS: &[&PartKind<dyn Mechanism>] = &[
    &ball_screw::KIND,
    &screw_datasheet::KIND,
    &rack::KIND,
    &belt::KIND,
    &gear::KIND,
    &direct::LINEAR,
    &direct::ROTARY,
    &rigid_mass::KIND,
];

/// How a mechanism's equations are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SolutionMethod {
    /// The fast method: the default of every simulation.
    #[default]
    Fast,
    /// The most exact method, another one than the fast if the mechanism has one: to check
    /// the fast method, and to simulate what stands for a real machine.
    Exact,
}

/// A screw as its heat and its growth know it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScrewShape {
    /// Length that the nut may be on, m.
    pub length: f64,
    /// Diameter, m.
    pub diameter: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Axial rigidity E A, N.
    pub rigidity: f64,
    /// Axial stiffness of each bearing, N/m, of a screw that is held at both ends; none of one that
    /// is free to grow.
    pub held_at_both_ends: Option<f64>,
}

/// An error of a transmission's kinematics: displacement at the load, its rate, and its derivative over the
/// motor's angle, as [`Changes::offset`](crate::effects::Changes::offset) has them.
pub type KinematicError = Arc<dyn Fn(&ScrewState) -> [f64; 3] + Send + Sync>;

/// A mechanism. Positions, forces and masses are the load's ([`Freedom`]).
pub trait Mechanism: fmt::Debug + Send + Sync {
    /// How the load moves.
    fn freedom(&self) -> Freedom {
        Freedom::Linear
    }

    /// Travel r of the load per radian of the motor, m/rad or rad/rad; 1 where
    /// the load is the motor.
    fn travel_per_radian(&self) -> f64;

    /// How the motor moves: along a line where its coordinate is that of a load that does,
    /// and its torque is a force; else about an axis.
    fn motor_freedom(&self) -> Freedom {
        match self.travel_per_radian() == 1.0 {
            true => self.freedom(),
            false => Freedom::Rotary,
        }
    }

    /// Inertia of all that moves, seen at the motor, kg·m² (kg where r is 1 m).
    fn total_inertia(&self) -> f64;

    /// Stiffness that decides on positioning, seen at the load; none if motor
    /// and load are one.
    fn stiffness(&self) -> Option<f64>;

    /// Free travel of the transmission, m or rad at the load.
    fn backlash(&self) -> f64 {
        0.0
    }

    /// Where the load can be at all, besides the stroke.
    fn reach(&self) -> Option<ValueRange> {
        None
    }

    /// The screw that it has, if it has one.
    fn screw(&self) -> Option<ScrewShape> {
        None
    }

    /// Whether a toothed belt moves it.
    fn has_belt(&self) -> bool {
        false
    }

    /// Whether the motor's angle is known apart from the load's position.
    fn has_motor_encoder(&self) -> bool {
        self.stiffness().is_some()
    }

    /// Natural frequencies with the load at `x`, rigid motion left out, rad/s.
    ///
    /// # Errors
    /// [`DriveError`] if the load cannot be at `x`.
    fn modes(&self, x: f64) -> Result<Vec<f64>, DriveError>;

    /// What turns with the motor, near the position `x`: inertia at the motor (kg·m²), and
    /// the share of the static wind-up between motor and load by which it lags the motor.
    fn rotating(&self, _x: f64) -> Vec<[f64; 2]> {
        let load = self.load_inertia() * self.travel_per_radian().powi(2);
        vec![[self.total_inertia() - load, 0.0]]
    }

    /// Inertia of the load, kg or kg·m².
    fn load_inertia(&self) -> f64;

    /// Compliance from motor to load with the load at `x`, seen at the motor, rad/(N·m);
    /// 0 if they are one.
    fn compliance(&self, _x: f64) -> f64 {
        let r = self.travel_per_radian();
        self.stiffness().map_or(0.0, |k| 1.0 / (k * r * r))
    }

    /// Stiffness-proportional damping β of its transmission, s.
    fn stiffness_damping(&self) -> f64 {
        0.0
    }

    /// All natural modes with the load at `x`, the rigid motion first, as motor and load
    /// take part in them: those of two inertias on the compliance, unless the mechanism
    /// knows better.
    ///
    /// # Errors
    /// As [`Mechanism::modes`].
    fn participation(&self, x: f64) -> Result<Vec<Mode>, DriveError> {
        let compliance = self.compliance(x);
        if compliance == 0.0 {
            return Ok(vec![self.rigid_mode()]);
        }
        let (r, m) = (self.travel_per_radian(), self.load_inertia());
        let motor = self.total_inertia() - m * r * r;
        // Orthogonal to the rigid motion, and normalised: J a² + m b² = 1, J a + m r b = 0.
        let ratio = m * r / motor;
        let load = 1.0 / (m * (1.0 + ratio * r)).sqrt();
        let squared = (1.0 / m + r * r / motor) / (compliance * r * r);
        let elastic = Mode {
            frequency: squared.sqrt(),
            damping: self.stiffness_damping() * squared,
            motor: -ratio * load,
            load,
        };
        Ok(vec![self.rigid_mode(), elastic])
    }

    /// The rigid motion.
    fn rigid_mode(&self) -> Mode {
        let share = 1.0 / self.total_inertia().sqrt();
        Mode {
            motor: share,
            load: share * self.travel_per_radian(),
            ..Mode::default()
        }
    }

    /// What its transmission's kinematics are off by, if anything.
    fn kinematic_error(&self) -> Option<KinematicError> {
        None
    }

    /// The same where it is a sin(n θ + φ) of the motor's angle θ: a (m or rad at the load), n
    /// and φ (rad). What a plan can predict.
    fn kinematic_harmonic(&self) -> Option<[f64; 3]> {
        None
    }

    /// Longest step of its exact method, s, where that differs from the fast one, be it by the
    /// step alone.
    fn exact_step(&self) -> Option<f64> {
        None
    }

    /// The machine around this mechanism, in steps of `step` seconds:
    /// `assembly.on(stepper)` with the mechanism's [`feed_dynamics::TimeStepper`].
    ///
    /// # Errors
    /// [`DriveError`] if the stepper cannot be made.
    fn plant(
        &self,
        method: SolutionMethod,
        step: f64,
        assembly: Assembly,
    ) -> Result<Arc<dyn Plant>, DriveError>;
}
