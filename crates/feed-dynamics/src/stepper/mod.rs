//! Time stepping: one interface, and the two steppers of the ball screw.
//!
//! [`ModalStepper`] is the fast one: the rotating chain does not depend on
//! the table's position, so its modes are propagated exactly and only the
//! nut, two neighbouring nodes and the table are solved for in a step.
//! [`ImplicitStepper`] is the obvious one: Newmark's average acceleration on
//! M(x), C(x), K(x); it also takes the paper's moving node.

mod implicit;
mod load;
mod modal;
mod nut;

pub use implicit::{ImplicitState, ImplicitStepper};
pub(crate) use load::find_load_within;
pub use load::{LoadSearch, find_load};
pub use modal::{ModalState, ModalStepper};
pub(crate) use nut::Contact;
pub use nut::NutErrors;

use crate::error::finite;
use crate::{DriveError, FeedDrive};

/// The motion of the load (the table of a ball screw) at the end of a step, as far
/// as it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct TableMotion {
    /// Displacement from where the simulation began, m.
    pub displacement: f64,
    /// Speed, m/s.
    pub speed: f64,
}

/// What can be seen of a drive's state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Observation {
    /// Motor angle, rad, from where the simulation began.
    pub motor_angle: f64,
    /// Motor speed, rad/s.
    pub motor_speed: f64,
    /// Displacement of the load, m, from where the simulation began.
    pub displacement: f64,
    /// Its speed, m/s.
    pub speed: f64,
    /// Force of the transmission (the nut of a ball screw) on the load, N.
    pub transmission_force: f64,
}

/// Uniformly accelerated motion in which every deflection has settled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Settled {
    /// Speed of the load (the table of a ball screw), m/s.
    pub speed: f64,
    /// Its acceleration, m/s².
    pub acceleration: f64,
    /// What acts on it, N, positive against positive motion.
    pub load: f64,
}

impl Settled {
    /// Force that the nut of a ball screw must put on the table, N.
    pub fn nut_force(&self, drive: &FeedDrive) -> f64 {
        drive.parameters().table_mass * self.acceleration + self.load
    }

    /// Motor torque that keeps this motion of a ball screw's table up, N·m; of any drive
    /// it is [`TimeStepper::settled_torque`].
    pub fn motor_torque(&self, drive: &FeedDrive) -> f64 {
        let r = drive.travel_per_radian();
        drive.rotating_inertia() * self.acceleration / r + r * self.nut_force(drive)
    }
}

/// How a step went.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use = "a step that did not converge, or left the screw, must not be continued from"]
pub struct StepReport {
    /// How the load at the step's end was found.
    pub load: LoadSearch,
    /// Whether the table is on the screw at the step's end. Where not, the step
    /// was made as if the nut stood at that end of the screw. A drive without a
    /// screw has no such end: always true.
    pub on_screw: bool,
}

/// Advances a drive by steps of a fixed length.
///
/// The motor torque goes linearly from its last value to the one given (but see
/// [`RigidStepper`](crate::RigidStepper)). What acts on the load, the table of a
/// ball screw, may depend on its motion at the end of the step;
/// it is searched for ([`find_load`]), so `load` is called a few times with
/// better and better motions, the last of which counts.
///
/// It is not object-safe: each stepper has a state of its own that `step` changes in place without
/// allocating, and a step calls the load several times, inlined. For one type over several kinds of
/// drive, put the stepper and its state into a struct of yours behind a trait of yours whose `step`
/// takes `&mut dyn FnMut(TableMotion) -> f64`; such a closure is a valid load here.
pub trait TimeStepper {
    /// The state that a step changes.
    type State: Clone;

    /// The stepper for loads that change by at most `steepness` (N·s/m) with the load's
    /// speed at the end of a step, rising or falling: it may then know a load after
    /// fewer calls. One that gains nothing by it stays as it is.
    #[must_use]
    fn with_steepest_load(self, steepness: f64) -> Self
    where
        Self: Sized,
    {
        let _ = steepness;
        self
    }

    /// Length of a step, s.
    fn step_length(&self) -> f64;

    /// The same stepper with steps of `step` seconds, to which a state of this one can go over:
    /// what a state holds does not depend on the length of the steps that led to it. A
    /// [steepest load](TimeStepper::with_steepest_load) has to be stated anew.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] unless the step is above zero and at most 1 s.
    fn of_length(&self, step: f64) -> Result<Self, DriveError>
    where
        Self: Sized;

    /// Load travel per radian of the motor r, m/rad, or rad/rad where the load turns.
    fn travel_per_radian(&self) -> f64;

    /// Motor torque that keeps a settled motion up at the load's position `x` (m), N·m.
    fn settled_torque(&self, x: f64, motion: &Settled) -> f64;

    /// A state with the load at `x` (m; of a ball screw, from the driven end) in
    /// settled motion; the default of [`Settled`] is rest.
    ///
    /// # Errors
    /// [`DriveError::OffScrew`] if `x` is not on the screw;
    /// [`DriveError::Parameter`] for a motion or, without a screw, a position that is
    /// not finite.
    fn settled(&self, x: f64, motion: &Settled) -> Result<Self::State, DriveError>;

    /// One step, to the motor torque `torque` (N·m) and the load's `load`
    /// (N, positive against positive motion) at its end.
    ///
    /// A torque or load that is not finite gives a state that is not, and a report
    /// that says so: it has not converged.
    fn step(
        &self,
        state: &mut Self::State,
        torque: f64,
        load: impl FnMut(TableMotion) -> f64,
    ) -> StepReport {
        self.step_through(state, torque, &NutErrors::default(), load)
    }

    /// As [`TimeStepper::step`], with errors of the transmission's kinematics. Without
    /// any the result is the same to the bit.
    fn step_through(
        &self,
        state: &mut Self::State,
        torque: f64,
        nut: &NutErrors,
        load: impl FnMut(TableMotion) -> f64,
    ) -> StepReport;

    /// What can be seen of a state.
    fn observe(&self, state: &Self::State) -> Observation;

    /// Kinetic energy of all that moves and strain energy of all that gives way, J.
    fn energy(&self, state: &Self::State) -> f64;
}

impl Settled {
    /// Refuses what is not finite.
    pub(crate) fn check(&self) -> Result<(), DriveError> {
        finite([
            ("speed", self.speed),
            ("acceleration", self.acceleration),
            ("load", self.load),
        ])
    }
}

pub(crate) fn check_step(step: f64) -> Result<(), DriveError> {
    // Beyond a second no number of an axis' stiffest mode would be left.
    if step > 0.0 && step <= 1.0 {
        return Ok(());
    }
    Err(DriveError::Parameter {
        name: "step",
        value: step,
        valid: "above zero and at most 1 s",
    })
}
