//! What the mechanisms of two inertias have in common.

use std::sync::Arc;

use feed_dynamics::{DriveError, ElasticDrive, ElasticDriveParameters, ElasticStepper, Stiffness};

use super::{Freedom, KinematicError, Mechanism, ScrewShape, SolutionMethod};
use crate::part::{PartError, Values};
use crate::plant::{Assembly, Plant};
use crate::value_range::ValueRange;

/// Motor and load with a transmission between.
pub(super) struct Elastic {
    pub drive: ElasticDrive,
    pub freedom: Freedom,
    pub backlash: f64,
    pub reach: Option<ValueRange>,
    pub screw: Option<ScrewShape>,
    pub belt: bool,
    pub kinematic_error: Option<KinematicError>,
    /// Amplitude, order and phase of it.
    pub harmonic: Option<[f64; 3]>,
}

impl std::fmt::Debug for Elastic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut shown = f.debug_struct("Elastic");
        shown.field("drive", &self.drive).finish_non_exhaustive()
    }
}

impl Elastic {
    /// A linear drive without errors; `stiffness` at the load.
    pub fn new(
        v: &Values,
        [motor_inertia, load_inertia]: [f64; 2],
        travel_per_radian: f64,
        stiffness: Arc<dyn Stiffness>,
    ) -> Result<Self, PartError> {
        let drive = ElasticDrive::new(ElasticDriveParameters {
            motor_inertia,
            load_inertia,
            travel_per_radian,
            stiffness,
            stiffness_damping: v.number("stiffness_damping")?,
        })
        .map_err(|e| PartError::together(e, "other parameters"))?;
        Ok(Self {
            drive,
            freedom: Freedom::Linear,
            backlash: v.or("backlash", 0.0),
            reach: None,
            screw: None,
            belt: false,
            kinematic_error: None,
            harmonic: None,
        })
    }

    /// Where its stiffness is looked at: the middle of its reach.
    fn middle(&self) -> f64 {
        self.reach.map_or(0.0, |r| 0.5 * (r.least + r.most))
    }
}

impl Mechanism for Elastic {
    fn freedom(&self) -> Freedom {
        self.freedom
    }

    fn has_belt(&self) -> bool {
        self.belt
    }

    fn travel_per_radian(&self) -> f64 {
        self.drive.parameters().travel_per_radian
    }

    fn total_inertia(&self) -> f64 {
        let p = self.drive.parameters();
        p.motor_inertia + p.load_inertia * p.travel_per_radian.powi(2)
    }

    fn load_inertia(&self) -> f64 {
        self.drive.parameters().load_inertia
    }

    fn compliance(&self, x: f64) -> f64 {
        let p = self.drive.parameters();
        1.0 / (p.stiffness.at(x) * p.travel_per_radian.powi(2))
    }

    fn stiffness_damping(&self) -> f64 {
        self.drive.parameters().stiffness_damping
    }

    fn stiffness(&self) -> Option<f64> {
        Some(self.drive.parameters().stiffness.at(self.middle()))
    }

    fn backlash(&self) -> f64 {
        self.backlash
    }

    fn reach(&self) -> Option<ValueRange> {
        self.reach
    }

    fn screw(&self) -> Option<ScrewShape> {
        self.screw
    }

    fn modes(&self, x: f64) -> Result<Vec<f64>, DriveError> {
        Ok(vec![self.drive.resonance(x)])
    }

    fn kinematic_error(&self) -> Option<KinematicError> {
        self.kinematic_error.clone()
    }

    fn kinematic_harmonic(&self) -> Option<[f64; 3]> {
        self.harmonic
    }

    /// The same method in short steps: a resonance of 230 Hz is late by 0.2 % of its period in
    /// steps of 100 µs.
    fn exact_step(&self) -> Option<f64> {
        Some(2e-5)
    }

    fn plant(
        &self,
        _: SolutionMethod,
        step: f64,
        assembly: Assembly,
    ) -> Result<Arc<dyn Plant>, DriveError> {
        Ok(assembly.on(ElasticStepper::new(&self.drive, step)?))
    }
}
