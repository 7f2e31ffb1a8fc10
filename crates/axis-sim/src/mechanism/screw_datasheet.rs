//! `screw-datasheet`: a ball screw from the values of its data sheet alone.

use std::f64::consts::{FRAC_PI_4, TAU};
use std::sync::Arc;

use feed_dynamics::{InSeries, Mounting, ScrewShaft, Stiffness};

use super::Mechanism;
use super::elastic::Elastic;
use crate::axis::ValueRange;
use crate::part::units::{DENSITY, INERTIA, LENGTH, MASS, PRESSURE, STIFFNESS, TIME};
use crate::part::{Known, PartError, PartKind, Role, Values, quantity, word};

pub(super) static KIND: PartKind<dyn Mechanism> = PartKind {
    name: "screw-datasheet",
    summary: "ball screw without elements: stiffness of bearing, shaft and nut in series",
    keys: &[
        quantity("motor_inertia", &INERTIA, 1e-9, 1e3).role(Role::MotorInertia),
        quantity("lead", &LENGTH, 1e-4, 1.0),
        quantity("length", &LENGTH, 0.01, 100.0),
        quantity("root_diameter", &LENGTH, 1e-3, 1.0),
        quantity("youngs_modulus", &PRESSURE, 1e8, 1e13).optional(),
        quantity("density", &DENSITY, 100.0, 1e5).optional(),
        word("mounting", &["fixed-free", "fixed-fixed"]),
        quantity("bearing_stiffness", &STIFFNESS, 1e3, 1e12),
        quantity("nut_stiffness", &STIFFNESS, 1e3, 1e12).role(Role::TransmissionStiffness),
        quantity("table_mass", &MASS, 1e-3, 1e6).role(Role::LoadInertia),
        quantity("stiffness_damping", &TIME, 0.0, 0.1),
        quantity("backlash", &LENGTH, 0.0, 0.1)
            .or(0.0)
            .role(Role::Backlash),
    ],
    known: &[
        Known::key("motor_inertia"),
        Known::key("bearing_stiffness"),
        Known::key("nut_stiffness"),
        Known::key("table_mass"),
        Known::key("youngs_modulus"),
        Known::key("density"),
        Known::key("stiffness_damping"),
    ],
    build,
};

/// Steel where the file does not say.
const STEEL: [f64; 2] = [206e9, 7850.0];

fn build(v: &Values) -> Result<Arc<dyn Mechanism>, PartError> {
    let (length, diameter) = (v.number("length")?, v.number("root_diameter")?);
    let area = FRAC_PI_4 * diameter * diameter;
    let mounting = match v.word("mounting") {
        Some("fixed-fixed") => Mounting::FixedFixed,
        _ => Mounting::FixedFree,
    };
    let rigidity = v.or("youngs_modulus", STEEL[0]) * area;
    let bearing = v.number("bearing_stiffness")?;
    let shaft = ScrewShaft::new(rigidity, length, mounting)
        .and_then(|shaft| shaft.on_bearings(bearing))
        .map_err(|e| PartError::together(e, "other dimensions"))?;
    let nut: Arc<dyn Stiffness> = Arc::new(v.number("nut_stiffness")?);
    let parts: [Arc<dyn Stiffness>; 2] = [Arc::new(shaft), nut];
    // J = m d²/8 of the shaft.
    let screw = v.or("density", STEEL[1]) * area * length * diameter * diameter / 8.0;
    let inertias = [v.number("motor_inertia")? + screw, v.number("table_mass")?];
    let stiffness = Arc::new(InSeries(parts.to_vec()));
    let mut drive = Elastic::new(v, inertias, v.number("lead")? / TAU, stiffness)?;
    drive.reach = Some(ValueRange {
        least: 0.0,
        most: length,
    });
    Ok(Arc::new(drive))
}
