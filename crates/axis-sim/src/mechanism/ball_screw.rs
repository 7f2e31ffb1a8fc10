//! `ball-screw`: Timoshenko screw between motor and table, nut and couplings.

use std::sync::Arc;

use beam_fem::{CrossSection, Material};
use compensator::Mode;
use feed_dynamics::{
    AxialSupport, DriveError, DriveParameters, FeedDrive, ImplicitStepper, ModalStepper, Mounting,
    NutCoupling,
};

use super::{Mechanism, ScrewShape, SolutionMethod};
use crate::part::units::{DENSITY, INERTIA, LENGTH, MASS, PRESSURE, STIFFNESS, TIME, TORSION};
use crate::part::{Known, PartError, PartKind, Role, Values, count, number, quantity, word};
use crate::plant::{Assembly, Plant};
use crate::value_range::ValueRange;

pub(super) static KIND: PartKind<dyn Mechanism> = PartKind {
    name: "ball-screw",
    summary: "ball screw of Timoshenko elements with couplings, nut and table",
    keys: &[
        quantity("length", &LENGTH, 0.01, 100.0),
        quantity("diameter", &LENGTH, 1e-3, 1.0),
        quantity("lead", &LENGTH, 1e-4, 1.0),
        count("elements", 2, 1000),
        quantity("youngs_modulus", &PRESSURE, 1e8, 1e13),
        number("poisson_ratio", -0.99, 0.49),
        quantity("density", &DENSITY, 100.0, 1e5),
        quantity("motor_inertia", &INERTIA, 1e-9, 1e3).role(Role::MotorInertia),
        quantity("torque_sensor_inertia", &INERTIA, 1e-9, 1e3),
        quantity("motor_coupling", &TORSION, 0.1, 1e9),
        quantity("screw_coupling", &TORSION, 0.1, 1e9),
        quantity("nut_stiffness", &STIFFNESS, 1e3, 1e12).role(Role::TransmissionStiffness),
        quantity("table_mass", &MASS, 1e-3, 1e6).role(Role::LoadInertia),
        quantity("stiffness_damping", &TIME, 0.0, 0.1),
        quantity("bearing_stiffness", &STIFFNESS, 1e3, 1e12).optional(),
        word("mounting", &["fixed-free", "fixed-fixed"]).optional(),
        quantity("backlash", &LENGTH, 0.0, 0.1)
            .or(0.0)
            .role(Role::Backlash),
    ],
    known: &[
        Known::key("motor_inertia"),
        Known::key("motor_coupling"),
        Known::key("screw_coupling"),
        Known::key("nut_stiffness"),
        Known::key("table_mass"),
        Known::key("torque_sensor_inertia"),
        Known::key("youngs_modulus"),
        Known::key("density"),
        Known::key("stiffness_damping"),
        Known::key("bearing_stiffness"),
    ],
    build,
};

#[derive(Debug)]
struct BallScrew {
    drive: FeedDrive,
    backlash: f64,
    screw: ScrewShape,
}

fn build(v: &Values) -> Result<Arc<dyn Mechanism>, PartError> {
    let other = |e: &dyn std::fmt::Display| PartError::together(e, "other parameters");
    let material = Material::new(
        v.number("youngs_modulus")?,
        v.number("poisson_ratio")?,
        v.number("density")?,
    )
    .map_err(|e| PartError::together(e, "another material"))?;
    let section = CrossSection::solid_circle(v.number("diameter")?, &material)
        .map_err(|e| PartError::together(e, "another section"))?;
    let axial = axial(v)?;
    let rigidity = v.number("youngs_modulus")? * section.area();
    let drive = FeedDrive::new(DriveParameters {
        section,
        material,
        screw_length: v.number("length")?,
        elements: v.count("elements")? as usize,
        lead: v.number("lead")?,
        motor_inertia: v.number("motor_inertia")?,
        sensor_inertia: v.number("torque_sensor_inertia")?,
        motor_coupling_stiffness: v.number("motor_coupling")?,
        screw_coupling_stiffness: v.number("screw_coupling")?,
        table_mass: v.number("table_mass")?,
        nut_stiffness: v.number("nut_stiffness")?,
        stiffness_damping: v.number("stiffness_damping")?,
        axial,
    })
    .map_err(|e| other(&e))?;
    let held = axial.filter(|axial| axial.mounting == Mounting::FixedFixed);
    Ok(Arc::new(BallScrew {
        screw: ScrewShape {
            length: v.number("length")?,
            diameter: v.number("diameter")?,
            density: v.number("density")?,
            rigidity,
            held_at_both_ends: held.map(|axial| axial.bearing_stiffness),
        },
        drive,
        backlash: v.or("backlash", 0.0),
    }))
}

/// The bearing's and the shaft's axial stiffness, where the file has the bearing's.
fn axial(v: &Values) -> Result<Option<AxialSupport>, PartError> {
    let Some(bearing_stiffness) = v.optional("bearing_stiffness") else {
        return Ok(None);
    };
    let mounting = match v.word("mounting") {
        Some("fixed-free") => Mounting::FixedFree,
        Some(_) => Mounting::FixedFixed,
        None => {
            let valid = "\"fixed-free\" or \"fixed-fixed\"";
            return Err(PartError::of("mounting", "is missing", valid));
        }
    };
    Ok(Some(AxialSupport {
        bearing_stiffness,
        mounting,
    }))
}

impl Mechanism for BallScrew {
    fn travel_per_radian(&self) -> f64 {
        self.drive.travel_per_radian()
    }

    fn total_inertia(&self) -> f64 {
        self.drive.total_inertia()
    }

    fn load_inertia(&self) -> f64 {
        self.drive.parameters().table_mass
    }

    /// Every part is turned back from the motor by its share of the static wind-up
    /// between motor and table.
    fn rotating(&self, x: f64) -> Vec<[f64; 2]> {
        let p = self.drive.parameters();
        // Compliances from the motor on, rad/(N·m).
        let sensor = 1.0 / p.motor_coupling_stiffness;
        let driven_end = sensor + 1.0 / p.screw_coupling_stiffness;
        let twist = x / (p.material.shear_modulus() * p.section.torsion_constant());
        // Linear up to the nut, constant beyond it: the mean over the screw.
        let screw = driven_end + twist * (1.0 - 0.5 * x / p.screw_length);
        let table = self.compliance(x);
        let screw_inertia = self.drive.rotating_inertia() - p.motor_inertia - p.sensor_inertia;
        vec![
            [p.motor_inertia, 0.0],
            [p.sensor_inertia, sensor / table],
            [screw_inertia, screw / table],
        ]
    }

    fn compliance(&self, x: f64) -> f64 {
        let (p, r) = (self.drive.parameters(), self.travel_per_radian());
        let couplings = 1.0 / p.motor_coupling_stiffness + 1.0 / p.screw_coupling_stiffness;
        let twist = x / (p.material.shear_modulus() * p.section.torsion_constant());
        couplings + twist + 1.0 / (self.drive.contact_stiffness(x) * r * r)
    }

    fn participation(&self, x: f64) -> Result<Vec<Mode>, DriveError> {
        let modes = self.drive.modes(x, NutCoupling::ShapeFunctions)?;
        let load = modes.shapes.nrows() - 1;
        let beta = self.stiffness_damping();
        let elastic = modes.frequencies_rad_s.iter().enumerate().skip(1);
        let elastic = elastic.map(|(i, &frequency)| Mode {
            frequency,
            damping: beta * frequency * frequency,
            motor: modes.shapes[(0, i)],
            load: modes.shapes[(load, i)],
        });
        Ok(std::iter::once(self.rigid_mode()).chain(elastic).collect())
    }

    fn stiffness_damping(&self) -> f64 {
        self.drive.parameters().stiffness_damping
    }

    fn stiffness(&self) -> Option<f64> {
        Some(self.drive.parameters().nut_stiffness)
    }

    fn backlash(&self) -> f64 {
        self.backlash
    }

    fn reach(&self) -> Option<ValueRange> {
        Some(ValueRange {
            least: 0.0,
            most: self.drive.parameters().screw_length,
        })
    }

    fn screw(&self) -> Option<ScrewShape> {
        Some(self.screw)
    }

    fn modes(&self, x: f64) -> Result<Vec<f64>, DriveError> {
        let modes = self.drive.modes(x, NutCoupling::ShapeFunctions)?;
        Ok(modes.frequencies_rad_s.into_iter().skip(1).collect())
    }

    /// The paper's moving node on Newmark's rule, whose periods are longer by (ωh)²/12: at
    /// 60 Hz and twice this step, that alone is half of what two programs differ by there.
    fn exact_step(&self) -> Option<f64> {
        Some(2e-5)
    }

    fn plant(
        &self,
        method: SolutionMethod,
        step: f64,
        assembly: Assembly,
    ) -> Result<Arc<dyn Plant>, DriveError> {
        let coupling = NutCoupling::MovingNode;
        Ok(match method {
            SolutionMethod::Fast => assembly.on(ModalStepper::new(&self.drive, step)?),
            SolutionMethod::Exact => {
                assembly.on(ImplicitStepper::new(&self.drive, coupling, step)?)
            }
        })
    }
}
