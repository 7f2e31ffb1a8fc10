//! Keys that the laws beside LuGre share, of a load that moves along a line or turns.

use lugre::{FrictionLevel, SteadyState};

use crate::part::units::{
    ANGULAR_SPEED, FORCE, LINEAR_DAMPING, ROTARY_DAMPING, SPEED, STIFFNESS, TORQUE, TORSION,
};
use crate::part::{Key, PartError, Role, Values, quantity};

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
}

/// The curve over speed that all of them have.
pub(super) fn steady(v: &Values) -> Result<SteadyState, PartError> {
    let level = FrictionLevel {
        coulomb: v.number("coulomb")?,
        stiction: v.number("stiction")?,
    };
    Ok(SteadyState {
        forward: level,
        backward: level,
        stribeck_speed: v.number("stribeck_speed")?,
        viscous: v.number("viscous")?,
        ..SteadyState::coulomb(level.coulomb)
    })
}
