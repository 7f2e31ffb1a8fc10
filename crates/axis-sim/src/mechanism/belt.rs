//! `belt`: toothed belt, driven at one end, carriage on one strand.

use std::sync::Arc;

use feed_dynamics::{BeltStrands, InSeries, Stiffness};

use super::Mechanism;
use super::elastic::Elastic;
use crate::part::units::{FORCE, INERTIA, LENGTH, MASS, TIME, TORSION};
use crate::part::{Known, PartError, PartKind, Role, Values, number, quantity};
use crate::value_range::ValueRange;

pub(super) static KIND: PartKind<dyn Mechanism> = PartKind {
    name: "belt",
    summary: "toothed belt with both strands, stiffness over the carriage's position",
    keys: &[
        quantity("motor_inertia", &INERTIA, 1e-9, 1e3).role(Role::MotorInertia),
        quantity("pulley_inertia", &INERTIA, 0.0, 1e3),
        number("ratio", 1e-2, 1e4),
        quantity("pulley_diameter", &LENGTH, 1e-3, 10.0),
        quantity("specific_stiffness", &FORCE, 1e2, 1e9).role(Role::TransmissionStiffness),
        quantity("strand_at_zero", &LENGTH, 1e-3, 100.0),
        quantity("strands_together", &LENGTH, 1e-2, 400.0),
        quantity("shaft_stiffness", &TORSION, 0.1, 1e10).optional(),
        quantity("carriage_mass", &MASS, 1e-3, 1e6).role(Role::LoadInertia),
        quantity("stiffness_damping", &TIME, 0.0, 0.1),
        quantity("backlash", &LENGTH, 0.0, 0.1)
            .or(0.0)
            .role(Role::Backlash),
    ],
    known: &[
        Known::key("motor_inertia"),
        Known::key("specific_stiffness"),
        Known::key("carriage_mass"),
        Known::key("pulley_inertia"),
        Known::key("shaft_stiffness"),
        Known::key("stiffness_damping"),
    ],
    build,
};

/// Both pulleys have the driven one's diameter; their inertia, `pulley_inertia`
/// together, turns with the driven one, after the ratio.
fn build(v: &Values) -> Result<Arc<dyn Mechanism>, PartError> {
    let radius = 0.5 * v.number("pulley_diameter")?;
    let (ratio, zero) = (v.number("ratio")?, v.number("strand_at_zero")?);
    let together = v.number("strands_together")?;
    let valid = "strands_together greater than strand_at_zero";
    let strands = BeltStrands::new(v.number("specific_stiffness")?, zero, together)
        .map_err(|e| PartError::together(e, valid))?;
    let strands: Arc<dyn Stiffness> = Arc::new(strands);
    let stiffness = match v.optional("shaft_stiffness") {
        None => strands,
        Some(k) => Arc::new(InSeries(vec![Arc::new(k / (radius * radius)), strands])),
    };
    let motor = v.number("motor_inertia")? + v.number("pulley_inertia")? / (ratio * ratio);
    let inertias = [motor, v.number("carriage_mass")?];
    let mut belt = Elastic::new(v, inertias, radius / ratio, stiffness)?;
    belt.belt = true;
    // Both strands keep a length: at least a thousandth of them together.
    let least = 1e-3 * together;
    belt.reach = Some(ValueRange {
        least: least - zero,
        most: together - least - zero,
    });
    Ok(Arc::new(belt))
}
