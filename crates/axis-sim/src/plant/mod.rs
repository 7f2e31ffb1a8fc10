//! The machine between two samples: actuator, mechanism, friction and loads.

mod begin;
mod law;
mod state;

use std::fmt;
use std::sync::Arc;

use feed_dynamics::{DriveError, Observation};

pub use self::law::Assembly;
use crate::actuator::Actuating;
use crate::effects::ScrewState;
pub use crate::error::AdvanceError;
pub use crate::start::Start;

/// A machine that motions can be started on.
pub trait Plant: fmt::Debug + Send + Sync {
    /// The machine at rest or in even motion, everything settled.
    ///
    /// # Errors
    /// [`DriveError::OffScrew`]; [`DriveError::Parameter`] for a motion that is
    /// not finite.
    fn start(self: Arc<Self>, start: &Start) -> Result<Box<dyn Running>, DriveError>;

    /// Motor torque that keeps the settled motion of `start` up, N·m, by all
    /// forces that act in it.
    fn torque(&self, start: &Start) -> f64;
}

/// A machine in motion.
pub trait Running: fmt::Debug + Send + Sync {
    /// One control cycle. Where it carries the load over the end of the mechanism's
    /// reach, the transmission stays at that end: a cycle is too short for more than
    /// some 10 µm, and the loop looks at the next sample where the load is.
    ///
    /// # Errors
    /// [`AdvanceError`]; time and what is seen are then those at the start of the step that
    /// failed.
    fn advance(&mut self, actuator: &mut dyn Actuating) -> Result<(), AdvanceError>;

    /// A part of a control cycle: `share` of it, above 0 and at most 1, in equal steps that are no
    /// longer than those of [`Running::advance`]. What comes of it shows the machine between two
    /// samples; a whole cycle in parts is not the cycle to the last bit.
    ///
    /// # Errors
    /// As [`Running::advance`].
    fn advance_part(
        &mut self,
        share: f64,
        actuator: &mut dyn Actuating,
    ) -> Result<(), AdvanceError>;

    /// What can be seen of it.
    fn seen(&self) -> &Seen;

    /// Lets a force from outside act on the load from now on, N or N·m, positive against
    /// positive motion, beside friction and loads: constant until it is set again, 0 at the
    /// start.
    fn set_outer_load(&mut self, force: f64);

    /// A copy.
    fn copy(&self) -> Box<dyn Running>;

    /// Kinetic and strain energy of the mechanism, J.
    fn energy(&self) -> f64;

    /// Friction at the load as it acts now, N or N·m, and the share of its
    /// Coulomb deflection that the bristles have.
    fn friction(&self) -> [f64; 2];
}

/// What can be seen of a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// Since the motion began, s.
    pub time: f64,
    /// Position of the load, m or rad.
    pub position: f64,
    /// Its way since the motion began, m or rad.
    pub displacement: f64,
    /// Its speed, m/s or rad/s.
    pub speed: f64,
    /// Angle of the motor, rad: absolute, so that what repeats with the turn has
    /// one phase on one machine.
    pub motor_angle: f64,
    /// Speed of the motor, rad/s.
    pub motor_speed: f64,
    /// Force of the transmission on the load, N or N·m.
    pub transmission_force: f64,
    /// Torque of the motor at the end of the last step, N·m.
    pub torque: f64,
    /// Force on the load, friction and loads, N or N·m, against positive motion.
    pub load: f64,
}

impl Seen {
    /// What is seen of a drive whose load and motor began at `origins`.
    fn of(at: &Observation, origins: [f64; 2], time: f64, torque: f64, load: f64) -> Self {
        Self {
            time,
            position: origins[0] + at.displacement,
            displacement: at.displacement,
            speed: at.speed,
            motor_angle: origins[1] + at.motor_angle,
            motor_speed: at.motor_speed,
            transmission_force: at.transmission_force,
            torque,
            load,
        }
    }

    /// The transmission at `time`, where the motor will be at `angle` and its force be
    /// `transmitted`.
    fn screw(&self, time: f64, angle: f64, transmitted: f64) -> ScrewState {
        ScrewState {
            time,
            angle,
            rate: self.motor_speed,
            position: self.position,
            speed: self.speed,
            transmitted,
        }
    }
}
