//! `chain-hoist`: motor, gearbox, and a load on a chain that is stiffer the shorter it is.
//!
//! With c the force for each unit of strain, L the free length with the load at 0 and x
//! the load's position, up being positive, the chain is a spring of k(x) = c/(L − x).

use std::sync::Arc;

use axis_sim::ValueRange;
use axis_sim::mechanism::{Mechanism, SolutionMethod};
use axis_sim::part::units::{FORCE, INERTIA, LENGTH, MASS, TIME};
use axis_sim::part::{Known, PartError, PartKind, Role, Values, number, quantity};
use axis_sim::plant::{Assembly, Plant};
use feed_dynamics::{DriveError, ElasticDrive, ElasticDriveParameters, ElasticStepper, Stiffness};

/// A chain hoist. It holds while the chain is taut: the load must not come down faster
/// than it falls.
pub static CHAIN_HOIST: PartKind<dyn Mechanism> = PartKind {
    name: "chain-hoist",
    summary: "motor with a gearbox, and a load on a chain",
    keys: &[
        quantity("motor_inertia", &INERTIA, 1e-9, 1e3).role(Role::MotorInertia),
        number("ratio", 1e-2, 1e4),
        quantity("sprocket_radius", &LENGTH, 1e-3, 10.0),
        quantity("chain_stiffness", &FORCE, 1.0, 1e12).role(Role::TransmissionStiffness),
        quantity("free_length", &LENGTH, 0.1, LONGEST),
        quantity("load_mass", &MASS, 1e-3, 1e6).role(Role::LoadInertia),
        quantity("stiffness_damping", &TIME, 0.0, 0.1),
    ],
    known: &[Known::key("chain_stiffness"), Known::key("load_mass")],
    build,
};

/// How near to the sprocket the load can come, and how far from it, m.
const SHORTEST: f64 = 0.05;
const LONGEST: f64 = 1e3;

/// The chain between sprocket and load.
#[derive(Debug)]
struct Chain {
    /// Force for each unit of strain, N.
    per_strain: f64,
    /// m, with the load at 0.
    free_length: f64,
}

impl Stiffness for Chain {
    fn at(&self, x: f64) -> f64 {
        self.per_strain / (self.free_length - x).max(SHORTEST)
    }
}

#[derive(Debug)]
struct ChainHoist {
    drive: ElasticDrive,
    reach: ValueRange,
}

fn build(v: &Values) -> Result<Arc<dyn Mechanism>, PartError> {
    let free_length = v.number("free_length")?;
    let stiffness = Chain {
        per_strain: v.number("chain_stiffness")?,
        free_length,
    };
    let drive = ElasticDrive::new(ElasticDriveParameters {
        motor_inertia: v.number("motor_inertia")?,
        load_inertia: v.number("load_mass")?,
        travel_per_radian: v.number("sprocket_radius")? / v.number("ratio")?,
        stiffness: Arc::new(stiffness),
        stiffness_damping: v.number("stiffness_damping")?,
    })
    .map_err(|e| PartError::together(e, "other parameters"))?;
    Ok(Arc::new(ChainHoist {
        drive,
        reach: ValueRange {
            least: free_length - LONGEST,
            most: free_length - SHORTEST,
        },
    }))
}

impl Mechanism for ChainHoist {
    fn travel_per_radian(&self) -> f64 {
        self.drive.parameters().travel_per_radian
    }

    fn total_inertia(&self) -> f64 {
        self.drive.total_inertia()
    }

    fn load_inertia(&self) -> f64 {
        self.drive.parameters().load_inertia
    }

    fn stiffness(&self) -> Option<f64> {
        Some(self.drive.parameters().stiffness.at(0.0))
    }

    fn reach(&self) -> Option<ValueRange> {
        Some(self.reach)
    }

    fn modes(&self, x: f64) -> Result<Vec<f64>, DriveError> {
        Ok(vec![self.drive.resonance(x)])
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
