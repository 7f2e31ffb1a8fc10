//! `screw-datasheet`: a ball screw from the values of its data sheet alone.
//!
//! What gives way between motor and table, seen at the table at x, r the travel per radian:
//!
//! ```text
//! 1/k = 1/k_bearing and shaft(x) + 1/k_nut + r² (1/k_coupling + x/(G I_p))
//! ```
//!
//! (Altintas, Verl, Brecher, Uriarte, Pritschow, CIRP Annals 60 (2011) 779,
//! doi:10.1016/j.cirp.2011.05.010). At a lead of 10 mm the shaft's torsion is some percent of
//! it, at 40 mm most of it.

use std::f64::consts::{FRAC_PI_4, TAU};
use std::sync::Arc;

use feed_dynamics::{InSeries, Mounting, ScrewShaft, Stiffness};

use super::elastic::Elastic;
use super::{Mechanism, ScrewShape};
use crate::part::units::{DENSITY, INERTIA, LENGTH, MASS, PRESSURE, STIFFNESS, TIME, TORSION};
use crate::part::{Known, PartError, PartKind, Role, Values, quantity, word};
use crate::value_range::ValueRange;

pub(super) static KIND: PartKind<dyn Mechanism> = PartKind {
    name: "screw-datasheet",
    summary: "ball screw without elements: stiffness of coupling, bearing, shaft (length and torsion) and nut in series",
    keys: &[
        quantity("motor_inertia", &INERTIA, 1e-9, 1e3).role(Role::MotorInertia),
        quantity("lead", &LENGTH, 1e-4, 1.0),
        quantity("length", &LENGTH, 0.01, 100.0),
        quantity("root_diameter", &LENGTH, 1e-3, 1.0),
        quantity("youngs_modulus", &PRESSURE, 1e8, 1e13).optional(),
        quantity("shear_modulus", &PRESSURE, 1e8, 1e13).optional(),
        quantity("density", &DENSITY, 100.0, 1e5).optional(),
        word("mounting", &["fixed-free", "fixed-fixed"]),
        quantity("bearing_stiffness", &STIFFNESS, 1e3, 1e12),
        quantity("coupling_stiffness", &TORSION, 0.1, 1e9).optional(),
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
        Known::key("coupling_stiffness"),
        Known::key("nut_stiffness"),
        Known::key("table_mass"),
        Known::key("youngs_modulus"),
        Known::key("shear_modulus"),
        Known::key("density"),
        Known::key("stiffness_damping"),
    ],
    build,
};

/// Young's modulus and density where the file does not say: steel.
const STEEL: [f64; 2] = [206e9, 7850.0];

/// 2 (1 + ν) = E/G, ν = 0.3, where the file has no shear modulus: of steel and most metals.
const MODULI: f64 = 2.6;

fn build(v: &Values) -> Result<Arc<dyn Mechanism>, PartError> {
    let (length, diameter) = (v.number("length")?, v.number("root_diameter")?);
    let area = FRAC_PI_4 * diameter * diameter;
    let mounting = match v.word("mounting") {
        Some("fixed-fixed") => Mounting::FixedFixed,
        _ => Mounting::FixedFree,
    };
    let modulus = v.or("youngs_modulus", STEEL[0]);
    let rigidity = modulus * area;
    let bearing = v.number("bearing_stiffness")?;
    let shaft = ScrewShaft::new(rigidity, length, mounting)
        .and_then(|shaft| shaft.on_bearings(bearing))
        .map_err(|e| PartError::together(e, "other dimensions"))?;
    let travel = v.number("lead")? / TAU;
    let mut parts: Vec<Arc<dyn Stiffness>> =
        vec![Arc::new(shaft), Arc::new(v.number("nut_stiffness")?)];
    // I_p = d²/8 of the area. A shaft twisted from the motor to the nut gives way as one does
    // that is pulled from a rigid bearing, by G I_p/r² in the place of E A.
    let torsion = v.or("shear_modulus", modulus / MODULI) * area * diameter * diameter / 8.0;
    let torsion = ScrewShaft::new(torsion / (travel * travel), length, Mounting::FixedFree)
        .map_err(|e| PartError::together(e, "other dimensions"))?;
    parts.push(Arc::new(torsion));
    if let Some(coupling) = v.optional("coupling_stiffness") {
        parts.push(Arc::new(coupling / (travel * travel)));
    }
    // J = m d²/8 of the shaft.
    let density = v.or("density", STEEL[1]);
    let screw = density * area * length * diameter * diameter / 8.0;
    let inertias = [v.number("motor_inertia")? + screw, v.number("table_mass")?];
    let mut drive = Elastic::new(v, inertias, travel, Arc::new(InSeries(parts)))?;
    drive.reach = Some(ValueRange {
        least: 0.0,
        most: length,
    });
    drive.screw = Some(ScrewShape {
        length,
        diameter,
        density,
        rigidity,
        held_at_both_ends: (mounting == Mounting::FixedFixed).then_some(bearing),
    });
    Ok(Arc::new(drive))
}
