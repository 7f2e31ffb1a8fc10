//! Time stepping: one interface, two steppers.
//!
//! [`ModalStepper`] is the fast one: the rotating chain does not depend on
//! the table's position, so its modes are propagated exactly and only the
//! nut, two neighbouring nodes and the table are solved for in a step.
//! [`ImplicitStepper`] is the obvious one: Newmark's average acceleration on
//! M(x), C(x), K(x); it also takes the paper's moving node.

mod implicit;
mod modal;

pub use implicit::{ImplicitState, ImplicitStepper};
pub use modal::{ModalState, ModalStepper};

use crate::FeedDrive;

/// The table's motion at the end of a step, as far as it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TableMotion {
    /// Displacement from where the simulation began, m.
    pub displacement: f64,
    /// Speed, m/s.
    pub speed: f64,
}

/// What can be seen of a drive's state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observation {
    /// Motor angle, rad, from where the simulation began.
    pub motor_angle: f64,
    /// Motor speed, rad/s.
    pub motor_speed: f64,
    /// Table displacement, m, from where the simulation began.
    pub displacement: f64,
    /// Table speed, m/s.
    pub speed: f64,
    /// Force of the nut on the table, N.
    pub nut_force: f64,
}

/// Uniformly accelerated motion in which every deflection has settled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settled {
    /// Table speed, m/s.
    pub speed: f64,
    /// Table acceleration, m/s².
    pub acceleration: f64,
    /// Load on the table, N, positive against positive motion.
    pub load: f64,
}

impl Settled {
    /// Force that the nut must put on the table, N.
    pub fn nut_force(&self, drive: &FeedDrive) -> f64 {
        drive.parameters().table_mass * self.acceleration + self.load
    }

    /// Motor torque that keeps this motion up, N·m.
    pub fn motor_torque(&self, drive: &FeedDrive) -> f64 {
        let r = drive.travel_per_radian();
        drive.rotating_inertia() * self.acceleration / r + r * self.nut_force(drive)
    }
}

/// What the nut's kinematics have beyond `table = r · rotation`, at the end of
/// a step. The default is none.
///
/// The nut is compressed by `δ = r θ + offset − y`; within ± half the gap it
/// carries nothing, beyond it `k (δ ∓ gap/2) + βk δ̇`, and it never pulls. The
/// reaction on the screw keeps the lever r: a lead error of 1e-4 changes it by
/// as little.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NutErrors {
    /// Displacement that is added to what the rotation commands, m.
    pub offset: f64,
    /// Its rate, m/s.
    pub offset_rate: f64,
    /// Free travel between the flanks, m, zero or more.
    pub gap: f64,
}

/// Advances the drive by steps of a fixed length.
///
/// The motor torque goes linearly from its last value to the one given. The
/// load on the table may depend on the table's motion at the end of the step;
/// it is found by iteration, so `load` is called a few times with better and
/// better motions, the last of which counts.
pub trait TimeStepper {
    /// The state that a step changes.
    type State: Clone;

    /// Length of a step, s.
    fn step_length(&self) -> f64;

    /// A state at table position `x` (m from the driven end) in settled motion;
    /// the default of [`Settled`] is rest.
    fn settled(&self, x: f64, motion: &Settled) -> Self::State;

    /// One step, to the motor torque `torque` (N·m) and the table load `load`
    /// (N, positive against positive motion) at its end.
    fn step(&self, state: &mut Self::State, torque: f64, load: impl FnMut(TableMotion) -> f64) {
        self.step_through(state, torque, &NutErrors::default(), load);
    }

    /// As [`TimeStepper::step`], with errors of the nut's kinematics. Without
    /// any the result is the same to the bit.
    fn step_through(
        &self,
        state: &mut Self::State,
        torque: f64,
        nut: &NutErrors,
        load: impl FnMut(TableMotion) -> f64,
    );

    /// What can be seen of a state.
    fn observe(&self, state: &Self::State) -> Observation;
}

/// Solves `load = law(motion(load))` for the load at the end of a step, where
/// the speed falls by `compliance` (m/s per N, small) with each newton.
///
/// A fixed-point iteration that starts from `guess`: the table's mass makes it
/// contract by a few hundredths a round, and it ends when a further round
/// could not move the speed by a part in 10¹² of a millimetre a second.
fn settle_load(
    guess: f64,
    compliance: f64,
    motion: impl Fn(f64) -> TableMotion,
    mut law: impl FnMut(TableMotion) -> f64,
) -> f64 {
    const MOST_ROUNDS: usize = 12;
    const SPEED_TOLERANCE: f64 = 1e-11;
    let mut load = guess;
    for _ in 0..MOST_ROUNDS {
        let next = law(motion(load));
        let change = (next - load).abs() * compliance;
        load = next;
        if change <= SPEED_TOLERANCE || !change.is_finite() {
            break;
        }
    }
    load
}
