//! A drive without elasticity: one inertia.

use crate::error::{finite, positive};
use crate::stepper::{check_step, find_load_within};
use crate::{DriveError, NutErrors, Observation, Settled, StepReport, TableMotion, TimeStepper};

/// A drive whose motor and load move as one. Immutable.
///
/// ```text
/// m ÿ = T / r − load,   θ = y / r
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "crate::stored::StoredRigidDrive",
        into = "crate::stored::StoredRigidDrive"
    )
)]
pub struct RigidDrive {
    inertia: f64,
    travel_per_radian: f64,
}

impl RigidDrive {
    /// A drive of `inertia` m (kg, or kg·m² where the load turns), that of everything
    /// as seen at the load, and `travel_per_radian` r (m/rad or rad/rad).
    ///
    /// # Errors
    /// [`DriveError::Parameter`] unless both are finite and above zero.
    pub fn new(inertia: f64, travel_per_radian: f64) -> Result<Self, DriveError> {
        positive([
            ("inertia", inertia),
            ("travel_per_radian", travel_per_radian),
        ])?;
        Ok(Self {
            inertia,
            travel_per_radian,
        })
    }

    /// Inertia of everything as seen at the load, kg or kg·m².
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// Load travel per radian of the motor, m/rad or rad/rad.
    pub fn travel_per_radian(&self) -> f64 {
        self.travel_per_radian
    }
}

/// How torque and load of a [`RigidStepper`] go over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum ForceCourse {
    /// Those of its end act over the whole step:
    ///
    /// ```text
    /// v₁ = v₀ + h (T₁/r − load₁) / m,   y₁ = y₀ + h (v₀ + v₁) / 2
    /// ```
    ///
    /// Exact for a torque and a load that are held, as of a sampled controller without
    /// an actuator's lag; of first order where they change.
    #[default]
    Held,
    /// They go linearly from their last values a = (T/r − load) / m:
    ///
    /// ```text
    /// v₁ = v₀ + h (a₀ + a₁) / 2,   y₁ = y₀ + h v₀ + h² (2 a₀ + a₁) / 6
    /// ```
    ///
    /// Of second order.
    Linear,
}

/// A rigid drive for steps of one length h.
///
/// Torque and load go over a step as its [`ForceCourse`] says; both are stable for
/// every step. Errors of the
/// kinematics have no elastic transmission to act through and are ignored. The force
/// on the load that is observed is T₁/r, as nothing tells which part of the inertia
/// is the load's. [`StepReport::on_screw`] is always true.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidStepper {
    drive: RigidDrive,
    step: f64,
    course: ForceCourse,
    /// Most by which the load changes with the end speed, N·s/m.
    steepest_load: f64,
    /// 1/m, 1/kg.
    mobility: f64,
    /// 1/r.
    radians_per_travel: f64,
}

/// State of a [`RigidStepper`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidState {
    displacement: f64,
    speed: f64,
    force: f64,
    load: f64,
    load_before: f64,
}

impl RigidStepper {
    /// Prepares steps of `step` seconds.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] if the step is not above zero and at most 1 s.
    pub fn new(drive: &RigidDrive, step: f64) -> Result<Self, DriveError> {
        check_step(step)?;
        Ok(Self {
            drive: *drive,
            step,
            course: ForceCourse::Held,
            steepest_load: f64::INFINITY,
            mobility: 1.0 / drive.inertia,
            radians_per_travel: 1.0 / drive.travel_per_radian,
        })
    }

    /// The same with another course of torque and load.
    #[must_use]
    pub fn with_course(self, course: ForceCourse) -> Self {
        Self { course, ..self }
    }
}

impl TimeStepper for RigidStepper {
    type State = RigidState;

    fn with_steepest_load(self, steepness: f64) -> Self {
        Self {
            steepest_load: steepness,
            ..self
        }
    }

    fn step_length(&self) -> f64 {
        self.step
    }

    fn of_length(&self, step: f64) -> Result<Self, DriveError> {
        Ok(Self::new(&self.drive, step)?.with_course(self.course))
    }

    fn travel_per_radian(&self) -> f64 {
        self.drive.travel_per_radian
    }

    fn settled_torque(&self, _: f64, motion: &Settled) -> f64 {
        self.drive.travel_per_radian * (self.drive.inertia * motion.acceleration + motion.load)
    }

    fn settled(&self, x: f64, motion: &Settled) -> Result<RigidState, DriveError> {
        finite([("position", x)])?;
        motion.check()?;
        Ok(RigidState {
            displacement: 0.0,
            speed: motion.speed,
            force: self.drive.inertia * motion.acceleration + motion.load,
            load: motion.load,
            load_before: motion.load,
        })
    }

    fn step_through(
        &self,
        state: &mut RigidState,
        torque: f64,
        _: &NutErrors,
        load: impl FnMut(TableMotion) -> f64,
    ) -> StepReport {
        let (h, mass, start) = (self.step, self.drive.inertia, *state);
        let force = torque * self.radians_per_travel;
        let before = (start.force - start.load) * self.mobility;
        let motion = |load: f64| match self.course {
            ForceCourse::Held => {
                let speed = start.speed + h * (force - load) / mass;
                TableMotion {
                    displacement: start.displacement + 0.5 * h * (start.speed + speed),
                    speed,
                }
            }
            ForceCourse::Linear => {
                let after = (force - load) * self.mobility;
                let way = start.speed + h * (2.0 * before + after) * (1.0 / 6.0);
                TableMotion {
                    displacement: start.displacement + h * way,
                    speed: start.speed + 0.5 * h * (before + after),
                }
            }
        };
        let compliance = match self.course {
            ForceCourse::Held => h * self.mobility,
            ForceCourse::Linear => 0.5 * h * self.mobility,
        };
        let guess = 2.0 * start.load - start.load_before;
        let (end_load, mut found) =
            find_load_within(self.steepest_load, guess, compliance, motion, load);
        let end = motion(end_load);
        found.converged &= end.speed.is_finite();
        *state = RigidState {
            displacement: end.displacement,
            speed: end.speed,
            force,
            load: end_load,
            load_before: start.load,
        };
        StepReport {
            load: found,
            on_screw: true,
        }
    }

    fn observe(&self, state: &RigidState) -> Observation {
        let r = self.drive.travel_per_radian;
        Observation {
            motor_angle: state.displacement / r,
            motor_speed: state.speed / r,
            displacement: state.displacement,
            speed: state.speed,
            transmission_force: state.force,
        }
    }

    fn energy(&self, state: &RigidState) -> f64 {
        0.5 * self.drive.inertia * state.speed * state.speed
    }
}
