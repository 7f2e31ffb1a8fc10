//! `rigid-mass`: motor, transmission and load as one mass.

use std::sync::Arc;

use feed_dynamics::{DriveError, RigidDrive, RigidStepper};

use super::{Mechanism, SolutionMethod};
use crate::part::units::{LENGTH, MASS};
use crate::part::{Known, PartError, PartKind, Role, Values, quantity};
use crate::plant::{Assembly, Plant};

pub(super) static KIND: PartKind<dyn Mechanism> = PartKind {
    name: "rigid-mass",
    summary: "one rigid mass on a screw, by its lead",
    keys: &[
        quantity("mass", &MASS, 1e-3, 1e6).role(Role::LoadInertia),
        quantity("lead", &LENGTH, 1e-4, 10.0),
    ],
    known: &[Known::key("mass")],
    build: |v: &Values| -> Result<Arc<dyn Mechanism>, PartError> {
        let travel = v.number("lead")? / std::f64::consts::TAU;
        let drive = RigidDrive::new(v.number("mass")?, travel)
            .map_err(|e| PartError::together(e, "a mass above zero"))?;
        Ok(Arc::new(RigidMass(drive)))
    },
};

#[derive(Debug)]
struct RigidMass(RigidDrive);

impl Mechanism for RigidMass {
    fn travel_per_radian(&self) -> f64 {
        self.0.travel_per_radian()
    }

    fn total_inertia(&self) -> f64 {
        self.0.inertia() * self.travel_per_radian().powi(2)
    }

    fn load_inertia(&self) -> f64 {
        self.0.inertia()
    }

    fn stiffness(&self) -> Option<f64> {
        None
    }

    fn modes(&self, _: f64) -> Result<Vec<f64>, DriveError> {
        Ok(Vec::new())
    }

    fn plant(
        &self,
        _: SolutionMethod,
        step: f64,
        assembly: Assembly,
    ) -> Result<Arc<dyn Plant>, DriveError> {
        Ok(assembly.on(RigidStepper::new(&self.0, step)?))
    }
}
