//! What a plan is made of, and what it says of a cycle.

use lugre::Exponential;

use crate::{Correction, Reference};

/// How a plan is made.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PlanSettings<T = f64> {
    /// Deviation of the Gaussian over the wind-up, s. 2 ms by default; it costs four
    /// times itself of look-ahead. 0: none, with two set points ahead.
    pub smoothing: T,
}

impl<T: Exponential> Default for PlanSettings<T> {
    fn default() -> Self {
        Self {
            smoothing: T::of(2e-3),
        }
    }
}

/// What comes to the planner: a set point, and what was learned for it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Target<T = f64> {
    /// The set point.
    pub reference: Reference<T>,
    /// Where the load is to be led besides, relative to it: a learned correction.
    pub shift: Reference<T>,
    /// Force against the load that the model does not have, N.
    pub force: T,
    /// Dry and viscous friction at the temperature of then, as multiples of the model's; as at the set point
    /// before if that is not stated, and the model's at first.
    pub friction: Option<[T; 2]>,
}

impl<T: Exponential> Target<T> {
    /// A set point without anything learned.
    pub fn of(reference: Reference<T>) -> Self {
        Self {
            reference,
            ..Self::default()
        }
    }
}

/// Where and under what a position loop that is closed at the motor was homed: there the
/// position that it shows is the load's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HomedAt<T = f64> {
    /// Position of the load, m or rad.
    pub position: T,
    /// Command that the drive held it with, in the actuator's unit.
    pub effort: T,
}

/// How an axis stands before a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Standstill<T = f64> {
    /// Command that the drive holds the axis with, in the actuator's unit: what it has
    /// commanded last, or the mean over a standstill where that is noisy. With the load
    /// known, the bristles' force follows from it.
    pub effort: T,
    /// Part of it that is a compensator's own; the drive's integrator holds the rest.
    pub own: T,
    /// Angle of the motor, rad: where what repeats with its turn is.
    pub motor_angle: T,
    /// Where a position loop that is closed at the motor was homed, where that was not here:
    /// the wind-up that the axis stands with now, after a motion, is not the one of then.
    pub homed: Option<HomedAt<T>>,
    /// Force that the friction's bristles hold the load with, N, where that is known: as the
    /// plan of the motion before has left them. Where a motion has just ended, `effort` is not
    /// yet that of a standstill, and says less of that force.
    pub held: Option<T>,
}

/// What the plan says of a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Planned<T = f64> {
    /// The set point.
    pub reference: Reference<T>,
    /// Where the load is to be, m or rad: the set point, and what was learned.
    pub position: T,
    /// Speed of the motor ω_d, rad/s.
    pub motor_speed: T,
    /// Wind-up s of the motor against the load, rad.
    pub wind_up: T,
    /// That with which a position loop that is closed at the motor was homed, rad.
    pub home: T,
    /// Torque of the motor at the start of the cycle, N·m.
    pub torque: T,
    /// Friction force on the load, N.
    pub friction: T,
    /// Share χ of bristles that follow the motion: 1 in pre-sliding, 0 in sliding.
    pub sticking: T,
    /// q current at the start of the cycle, A; of another actuator, the command that
    /// would hold its torque.
    pub current: T,
    /// The command of the cycle, in the actuator's unit.
    pub effort: T,
    /// Whether a limit of the actuator keeps the plan from being followed.
    pub limited: bool,
    /// The offsets.
    pub correction: Correction<T>,
}
