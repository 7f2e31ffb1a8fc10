//! An elastic drive, prepared for steps of one length.

use super::ElasticDrive;
use super::average_acceleration::Course;
use super::transmission::Transmission;
use crate::stepper::check_step;
use crate::{DriveError, NutErrors};

/// An elastic drive for steps of one length.
///
/// The stiffness is held over a step at the position that speed and acceleration
/// at its start lead to. The load may be anywhere: [`StepReport::on_screw`](crate::StepReport::on_screw) is
/// always true.
#[derive(Clone, Debug)]
pub struct ElasticStepper {
    pub(super) drive: ElasticDrive,
    pub(super) step: f64,
    /// 1/m, 1/kg.
    pub(super) load_mobility: f64,
    /// 1/m + r²/J, 1/kg.
    pub(super) mobility: f64,
    /// 1/r.
    pub(super) radians_per_travel: f64,
    /// r/J: what a newton metre of the motor adds to δ̈.
    pub(super) per_torque: f64,
    /// The transmission where its stiffness is the same everywhere.
    pub(super) constant: Option<Transmission>,
    /// Most by which the load changes with the end speed, N·s/m.
    pub(super) steepest_load: f64,
}

/// State of an [`ElasticStepper`].
#[derive(Clone, Debug)]
pub struct ElasticState {
    pub(super) origin: f64,
    /// The load's displacement, m.
    pub(super) y: Course,
    /// δ = rθ − y, without errors of the kinematics, m.
    pub(super) compression: Course,
    /// Errors at the end of the last step.
    pub(super) errors: NutErrors,
    /// On the load, N.
    pub(super) force: f64,
    /// −1 or 1 where spring and damper press the flank on that side, otherwise 0.
    pub(super) flank: f64,
    pub(super) load: f64,
    pub(super) load_before: f64,
}

impl ElasticStepper {
    /// Prepares steps of `step` seconds.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] if the step is not above zero and at most 1 s.
    pub fn new(drive: &ElasticDrive, step: f64) -> Result<Self, DriveError> {
        check_step(step)?;
        let p = drive.parameters();
        let mut stepper = Self {
            step,
            load_mobility: 1.0 / p.load_inertia,
            mobility: drive.inverse_inertia(),
            radians_per_travel: 1.0 / p.travel_per_radian,
            per_torque: p.travel_per_radian / p.motor_inertia,
            constant: None,
            steepest_load: f64::INFINITY,
            drive: drive.clone(),
        };
        let stiffness = p.stiffness.constant();
        stepper.constant = stiffness.map(|k| stepper.transmission(k));
        Ok(stepper)
    }

    /// The transmission with that stiffness, N/m.
    #[inline]
    pub(super) fn transmission(&self, stiffness: f64) -> Transmission {
        let damping = stiffness * self.drive.parameters().stiffness_damping;
        Transmission::new(
            stiffness,
            damping,
            self.step,
            [self.mobility, self.load_mobility],
        )
    }
}
