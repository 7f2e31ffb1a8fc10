//! `linear-motor` and `torque-motor`: the motor moves the load itself.

use std::sync::Arc;

use feed_dynamics::{DriveError, ForceCourse, RigidDrive, RigidStepper};

use super::{Freedom, Mechanism, SolutionMethod};
use crate::part::units::{INERTIA, MASS};
use crate::part::{Known, PartError, PartKind, Role, quantity};
use crate::plant::{Assembly, Plant};

pub(super) static LINEAR: PartKind<dyn Mechanism> = PartKind {
    name: "linear-motor",
    summary: "slide moved by a linear motor; the motor's coordinate is the slide's, in m",
    keys: &[quantity("slide_mass", &MASS, 1e-3, 1e6).role(Role::LoadInertia)],
    known: &[Known::key("slide_mass")],
    build: |v| build(v.number("slide_mass")?, Freedom::Linear),
};

pub(super) static ROTARY: PartKind<dyn Mechanism> = PartKind {
    name: "torque-motor",
    summary: "table turned by a torque motor without a gear",
    keys: &[quantity("table_inertia", &INERTIA, 1e-9, 1e6).role(Role::LoadInertia)],
    known: &[Known::key("table_inertia")],
    build: |v| build(v.number("table_inertia")?, Freedom::Rotary),
};

fn build(inertia: f64, freedom: Freedom) -> Result<Arc<dyn Mechanism>, PartError> {
    let drive = RigidDrive::new(inertia, 1.0)
        .map_err(|e| PartError::together(e, "an inertia above zero"))?;
    Ok(Arc::new(Direct { drive, freedom }))
}

#[derive(Debug)]
struct Direct {
    drive: RigidDrive,
    freedom: Freedom,
}

impl Mechanism for Direct {
    fn freedom(&self) -> Freedom {
        self.freedom
    }

    fn travel_per_radian(&self) -> f64 {
        1.0
    }

    fn total_inertia(&self) -> f64 {
        self.drive.inertia()
    }

    fn load_inertia(&self) -> f64 {
        self.drive.inertia()
    }

    fn stiffness(&self) -> Option<f64> {
        None
    }

    fn modes(&self, _: f64) -> Result<Vec<f64>, DriveError> {
        Ok(Vec::new())
    }

    /// The same method in short steps.
    fn exact_step(&self) -> Option<f64> {
        Some(2e-5)
    }

    fn plant(
        &self,
        _: SolutionMethod,
        step: f64,
        assembly: Assembly,
    ) -> Result<Arc<dyn Plant>, DriveError> {
        let stepper = RigidStepper::new(&self.drive, step)?;
        Ok(assembly.on(stepper.with_course(ForceCourse::Linear)))
    }
}
