//! Keys that the laws beside LuGre share, of a load that moves along a line or turns.

use lugre::{FrictionLevel, SteadyState};

use crate::part::units::{
    ANGULAR_SPEED, CUBIC_DAMPING, FORCE, LINEAR_DAMPING, QUADRATIC_DAMPING, ROTARY_CUBIC_DAMPING,
    ROTARY_DAMPING, ROTARY_QUADRATIC_DAMPING, SPEED, STIFFNESS, TORQUE, TORSION,
};
use crate::part::{Key, Known, PartError, Role, Values, number, quantity};

/// δ of the Stribeck curve.
pub(super) const STRIBECK_EXPONENT: Key = number("stribeck_exponent", 0.1, 10.0).or(EXPONENT);

/// δ of the law LuGre.
const EXPONENT: f64 = 2.0;

/// The exponent as a parameter that may be off: by nothing unless `[tolerances]` names it, as every curve has one, most of them
/// by default.
pub(super) const EXPONENT_OF_CURVE: Known = Known::exact("stribeck_exponent");

/// Friction beyond the linear damping, where the file has some.
pub(super) const QUADRATIC: Known = Known::key("viscous_quadratic");
pub(super) const CUBIC: Known = Known::key("viscous_cubic");

pub(super) mod linear {
    use super::*;

    pub(in super::super) const COULOMB: Key = quantity("coulomb", &FORCE, 1e-9, 1e7);
    pub(in super::super) const STICTION: Key = quantity("stiction", &FORCE, 1e-9, 1e7);
    pub(in super::super) const STRIBECK_SPEED: Key = quantity("stribeck_speed", &SPEED, 1e-9, 1e3);
    pub(in super::super) const STIFFNESS_OF_BRISTLE: Key =
        quantity("bristle_stiffness", &STIFFNESS, 1e-3, 1e15).role(Role::BristleStiffness);
    pub(in super::super) const DAMPING: Key =
        quantity("bristle_damping", &LINEAR_DAMPING, 0.0, 1e12);
    pub(in super::super) const VISCOUS: Key = quantity("viscous", &LINEAR_DAMPING, 0.0, 1e9);
    pub(in super::super) const COULOMB_BACKWARD: Key =
        quantity("coulomb_backward", &FORCE, 1e-9, 1e7).optional();
    pub(in super::super) const STICTION_BACKWARD: Key =
        quantity("stiction_backward", &FORCE, 1e-9, 1e7).optional();
    pub(in super::super) const VISCOUS_QUADRATIC: Key =
        quantity("viscous_quadratic", &QUADRATIC_DAMPING, 0.0, 1e9).or(0.0);
    pub(in super::super) const VISCOUS_CUBIC: Key =
        quantity("viscous_cubic", &CUBIC_DAMPING, 0.0, 1e9).or(0.0);
}

pub(super) mod rotary {
    use super::*;

    pub(in super::super) const COULOMB: Key = quantity("coulomb", &TORQUE, 1e-9, 1e7);
    pub(in super::super) const STICTION: Key = quantity("stiction", &TORQUE, 1e-9, 1e7);
    pub(in super::super) const STRIBECK_SPEED: Key =
        quantity("stribeck_speed", &ANGULAR_SPEED, 1e-9, 1e5);
    pub(in super::super) const STIFFNESS_OF_BRISTLE: Key =
        quantity("bristle_stiffness", &TORSION, 1e-6, 1e15).role(Role::BristleStiffness);
    pub(in super::super) const DAMPING: Key =
        quantity("bristle_damping", &ROTARY_DAMPING, 0.0, 1e12);
    pub(in super::super) const VISCOUS: Key = quantity("viscous", &ROTARY_DAMPING, 0.0, 1e9);
    pub(in super::super) const COULOMB_BACKWARD: Key =
        quantity("coulomb_backward", &TORQUE, 1e-9, 1e7).optional();
    pub(in super::super) const STICTION_BACKWARD: Key =
        quantity("stiction_backward", &TORQUE, 1e-9, 1e7).optional();
    pub(in super::super) const VISCOUS_QUADRATIC: Key =
        quantity("viscous_quadratic", &ROTARY_QUADRATIC_DAMPING, 0.0, 1e9).or(0.0);
    pub(in super::super) const VISCOUS_CUBIC: Key =
        quantity("viscous_cubic", &ROTARY_CUBIC_DAMPING, 0.0, 1e9).or(0.0);
}

/// The curve over speed that all of them have.
pub(super) fn steady(v: &Values) -> Result<SteadyState, PartError> {
    let forward = FrictionLevel {
        coulomb: v.number("coulomb")?,
        stiction: v.number("stiction")?,
    };
    let backward = FrictionLevel {
        coulomb: v.or("coulomb_backward", forward.coulomb),
        stiction: v.or("stiction_backward", forward.stiction),
    };
    let has_own = backward != forward;
    if has_own && backward.stiction < backward.coulomb {
        return Err(PartError::together(
            "stiction_backward (stiction, if it is left out) is below coulomb_backward (coulomb)",
            "stiction_backward at least as great as coulomb_backward",
        ));
    }
    Ok(SteadyState {
        forward,
        backward,
        stribeck_speed: v.number("stribeck_speed")?,
        stribeck_exponent: v.or("stribeck_exponent", EXPONENT),
        viscous: v.number("viscous")?,
        viscous_quadratic: v.or("viscous_quadratic", 0.0),
        viscous_cubic: v.or("viscous_cubic", 0.0),
    })
}

/// Whether the curve has what LuGre by itself has not. Keys with a default are there in every file.
pub(super) fn is_beyond_lugre(curve: &SteadyState) -> bool {
    curve.backward != curve.forward
        || curve.stribeck_exponent != EXPONENT
        || curve.viscous_quadratic != 0.0
        || curve.viscous_cubic != 0.0
}
