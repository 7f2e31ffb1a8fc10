//! One test binary: matrices, modes and stiffnesses against laws and closed forms,
//! the steppers against each other and against independent integrations.

mod any_stepper;
mod axial;
mod bits;
mod boundary;
mod elastic_energy;
mod elastic_reference;
mod elastic_response;
mod elastic_stepping;
mod frequency_response;
mod friction;
mod matrices;
mod modes;
mod nut_errors;
mod parameters;
mod reference;
mod rigid;
mod settled;
mod state_space;
mod stepping;
mod stiffness;
#[cfg(feature = "serde")]
mod stored;

use beam_fem::{CrossSection, Material};
use feed_dynamics::{DriveParameters, FeedDrive, NutCoupling};

const COUPLINGS: [NutCoupling; 2] = [NutCoupling::ShapeFunctions, NutCoupling::MovingNode];

/// The drive of Liu et al. 2025 (doi:10.3390/machines13050433, Tables 2 and 3).
fn paper() -> DriveParameters {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    DriveParameters {
        section: CrossSection::solid_circle(0.040, &steel).unwrap(),
        material: steel,
        screw_length: 1.5,
        elements: 10,
        lead: 0.010,
        motor_inertia: 0.0053,
        sensor_inertia: 1e-4,
        motor_coupling_stiffness: 2800.0,
        screw_coupling_stiffness: 2800.0,
        table_mass: 515.0,
        nut_stiffness: 7.45e7,
        axial: None,
        stiffness_damping: 1e-5,
    }
}

fn drive() -> FeedDrive {
    FeedDrive::new(paper()).unwrap()
}

/// |a − b| relative to the greater of the two.
fn relative(a: f64, b: f64) -> f64 {
    (a - b).abs() / a.abs().max(b.abs())
}
