//! `rack`: motor, gearbox, pinion and rack.

use std::sync::Arc;

use feed_dynamics::{InSeries, Stiffness};

use super::Mechanism;
use super::elastic::Elastic;
use crate::part::units::{INERTIA, LENGTH, MASS, STIFFNESS, TIME, TORSION};
use crate::part::{Known, PartError, PartKind, Role, Values, number, quantity};

pub(super) static KIND: PartKind<dyn Mechanism> = PartKind {
    name: "rack",
    summary: "motor with a gearbox, pinion and rack",
    keys: &[
        quantity("motor_inertia", &INERTIA, 1e-9, 1e3).role(Role::MotorInertia),
        quantity("gearbox_inertia", &INERTIA, 0.0, 1e3),
        number("ratio", 1e-2, 1e4),
        quantity("pinion_diameter", &LENGTH, 1e-3, 10.0),
        quantity("gearbox_stiffness", &TORSION, 0.1, 1e10),
        quantity("mesh_stiffness", &STIFFNESS, 1e3, 1e12).role(Role::TransmissionStiffness),
        quantity("carriage_mass", &MASS, 1e-3, 1e6).role(Role::LoadInertia),
        quantity("stiffness_damping", &TIME, 0.0, 0.1),
        quantity("backlash", &LENGTH, 0.0, 0.1)
            .or(0.0)
            .role(Role::Backlash),
    ],
    known: &[
        Known::key("motor_inertia"),
        Known::key("gearbox_stiffness"),
        Known::key("mesh_stiffness"),
        Known::key("carriage_mass"),
        Known::key("gearbox_inertia"),
        Known::key("stiffness_damping"),
    ],
    build,
};

/// The gearbox's stiffness is that at its output, so at the rack it is k / R²,
/// R being the pinion's radius, in series with that of the teeth.
fn build(v: &Values) -> Result<Arc<dyn Mechanism>, PartError> {
    let radius = 0.5 * v.number("pinion_diameter")?;
    let gearbox: Arc<dyn Stiffness> = Arc::new(v.number("gearbox_stiffness")? / (radius * radius));
    let mesh: Arc<dyn Stiffness> = Arc::new(v.number("mesh_stiffness")?);
    let motor = v.number("motor_inertia")? + v.number("gearbox_inertia")?;
    let inertias = [motor, v.number("carriage_mass")?];
    let stiffness = Arc::new(InSeries(vec![gearbox, mesh]));
    let travel = radius / v.number("ratio")?;
    Ok(Arc::new(Elastic::new(v, inertias, travel, stiffness)?))
}
