//! `gear`: robot joint or rotary table behind a gear.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use feed_dynamics::Stiffness;

use super::elastic::Elastic;
use super::{Freedom, KinematicError, Mechanism};
use crate::effects::ScrewState;
use crate::part::units::{ANGLE, INERTIA, TIME, TORSION};
use crate::part::{Known, PartError, PartKind, Role, Values, number, quantity};

pub(super) static KIND: PartKind<dyn Mechanism> = PartKind {
    name: "gear",
    summary: "joint or rotary table behind a gear with stiffness and kinematic error",
    keys: &[
        quantity("motor_inertia", &INERTIA, 1e-9, 1e3).role(Role::MotorInertia),
        number("ratio", 1e-2, 1e4),
        quantity("gear_stiffness", &TORSION, 0.1, 1e10).role(Role::TransmissionStiffness),
        quantity("load_inertia", &INERTIA, 1e-9, 1e6).role(Role::LoadInertia),
        quantity("stiffness_damping", &TIME, 0.0, 0.1),
        quantity("backlash", &ANGLE, 0.0, 0.1)
            .or(0.0)
            .role(Role::Backlash),
        quantity("kinematic_error", &ANGLE, 0.0, 0.1).optional(),
        number("kinematic_error_order", 1e-3, 1e3).optional(),
        quantity("kinematic_error_phase", &ANGLE, -TAU, TAU).optional(),
    ],
    known: &[
        Known::key("motor_inertia"),
        Known::key("gear_stiffness"),
        Known::key("load_inertia"),
        Known::key("stiffness_damping"),
        // How the motor was mounted on the gear, and its encoder on the motor, is known to nobody.
        Known::by("kinematic_error_phase", |v, by| {
            v.shift("kinematic_error_phase", by - 1.0);
        })
        .with_own_tolerance(PI, None)
        .of("kinematic_error")
        .as_angle(),
    ],
    build,
};

/// The stiffness is the gear's at its output. The kinematic error (amplitude)
/// repeats `kinematic_error_order` times (2 where it is left out: a wave
/// generator's) in a turn of the motor.
fn build(v: &Values) -> Result<Arc<dyn Mechanism>, PartError> {
    let inertias = [v.number("motor_inertia")?, v.number("load_inertia")?];
    let stiffness: Arc<dyn Stiffness> = Arc::new(v.number("gear_stiffness")?);
    let mut gear = Elastic::new(v, inertias, 1.0 / v.number("ratio")?, stiffness)?;
    gear.freedom = Freedom::Rotary;
    let amplitude = v.or("kinematic_error", 0.0);
    if amplitude != 0.0 {
        let order = v.or("kinematic_error_order", 2.0);
        let phase = v.or("kinematic_error_phase", 0.0);
        gear.kinematic_error = Some(harmonic(amplitude, order, phase));
        gear.harmonic = Some([amplitude, order, phase]);
    }
    Ok(Arc::new(gear))
}

fn harmonic(amplitude: f64, order: f64, phase: f64) -> KinematicError {
    Arc::new(move |screw: &ScrewState| {
        let (sin, cos) = (order * screw.angle + phase).sin_cos();
        let growth = amplitude * order * cos;
        [amplitude * sin, growth * screw.rate, growth]
    })
}
