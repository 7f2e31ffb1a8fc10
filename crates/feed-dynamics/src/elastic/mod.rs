//! A drive of two inertias, motor and load, on an elastic transmission.

mod average_acceleration;
mod prepared;
mod response;
mod step_end;
mod stepper;
mod stiffness;
mod transmission;

pub use prepared::{ElasticState, ElasticStepper};
pub use response::Side;
pub use stiffness::{BeltStrands, InSeries, Stiffness};

use std::sync::Arc;

use crate::DriveError;
use crate::error::{finite, not_negative, positive};

/// Everything that makes an elastic drive. SI units; where the load turns, read
/// rad for m, N·m for N and kg·m² for kg of the load.
#[derive(Clone, Debug)]
pub struct ElasticDriveParameters {
    /// Inertia J of all that turns with the motor, kg·m².
    pub motor_inertia: f64,
    /// Inertia m of the load, kg.
    pub load_inertia: f64,
    /// Load travel per radian of the motor r, m/rad.
    pub travel_per_radian: f64,
    /// Stiffness k(x) of the transmission as seen at the load, N/m, over the load's
    /// position.
    pub stiffness: Arc<dyn Stiffness>,
    /// Stiffness-proportional damping β: the damping is βk(x), s.
    pub stiffness_damping: f64,
}

/// A motor and a load with one elastic transmission between them: belt, gear,
/// rack, direct coupling, the joint of a robot. Immutable.
///
/// With θ the motor's rotation and y the load's displacement,
///
/// ```text
/// J θ̈ = T − r F,   m ÿ = F − load,   F = k(x) δ + βk(x) δ̇,   δ = r θ − y,   x = x₀ + y
/// ```
///
/// the two-mass system of drive control, with a stiffness that may depend on the
/// load's position. Errors of the transmission's kinematics add to δ as
/// [`NutErrors`](crate::NutErrors) has it.
#[derive(Clone, Debug)]
pub struct ElasticDrive {
    parameters: ElasticDriveParameters,
}

impl ElasticDrive {
    /// Checks the parameters and makes the drive. The stiffness is checked at x = 0.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] names the first field that is out of range.
    pub fn new(parameters: ElasticDriveParameters) -> Result<Self, DriveError> {
        let p = &parameters;
        positive([
            ("motor_inertia", p.motor_inertia),
            ("load_inertia", p.load_inertia),
            ("travel_per_radian", p.travel_per_radian),
            ("stiffness", p.stiffness.at(0.0)),
        ])?;
        not_negative([("stiffness_damping", p.stiffness_damping)])?;
        Ok(Self { parameters })
    }

    /// The parameters it was made from.
    pub fn parameters(&self) -> &ElasticDriveParameters {
        &self.parameters
    }

    /// Inertia of the whole axis seen at the motor, J + m r², kg·m².
    pub fn total_inertia(&self) -> f64 {
        let p = &self.parameters;
        p.motor_inertia + p.load_inertia * p.travel_per_radian.powi(2)
    }

    /// Angular frequency at which motor and load swing against each other without
    /// damping, √(k(x) (1/m + r²/J)), rad/s; NaN if `x` is not finite.
    pub fn resonance(&self, x: f64) -> f64 {
        (self.stiffness_at(x) * self.inverse_inertia()).sqrt()
    }

    /// Angular frequency at which the load alone swings and the motor, driven,
    /// stands still without damping, √(k(x)/m), rad/s; NaN if `x` is not finite.
    pub fn antiresonance(&self, x: f64) -> f64 {
        (self.stiffness_at(x) / self.parameters.load_inertia).sqrt()
    }

    /// k(x); NaN if `x` is not finite, though a constant stiffness is the same there.
    fn stiffness_at(&self, x: f64) -> f64 {
        if x.is_finite() {
            self.parameters.stiffness.at(x)
        } else {
            f64::NAN
        }
    }

    /// What a newton of the transmission takes from δ̈, 1/m + r²/J, 1/kg.
    fn inverse_inertia(&self) -> f64 {
        let p = &self.parameters;
        1.0 / p.load_inertia + p.travel_per_radian.powi(2) / p.motor_inertia
    }

    /// Refuses a position that is not finite, or at which the stiffness is not valid.
    pub(crate) fn check_position(&self, x: f64) -> Result<(), DriveError> {
        finite([("position", x)])?;
        positive([("stiffness", self.parameters.stiffness.at(x))])
    }
}
