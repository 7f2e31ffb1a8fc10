//! `lugre` and `lugre-rotary`: LuGre friction in the load's own units.

use super::keys::{STRIBECK_EXPONENT, linear, rotary};
use super::lugre_at_motor::{KNOWN, build};
use super::{Friction, FrictionPlace};
use crate::freedom::Freedom;
use crate::part::units::{
    ANGULAR_SPEED, FORCE, LINEAR_DAMPING, ROTARY_DAMPING, SPEED, STIFFNESS, TORQUE, TORSION,
};
use crate::part::{PartKind, Role, quantity};

pub(super) static LINEAR: PartKind<Friction> = PartKind {
    name: "lugre",
    summary: "LuGre friction, as force over speed of a load that moves along a line",
    keys: &[
        quantity("coulomb", &FORCE, 1e-9, 1e7),
        quantity("stiction", &FORCE, 1e-9, 1e7),
        quantity("stribeck_speed", &SPEED, 1e-9, 1e3),
        quantity("bristle_stiffness", &STIFFNESS, 1e-3, 1e15).role(Role::BristleStiffness),
        quantity("bristle_damping", &LINEAR_DAMPING, 0.0, 1e12),
        quantity("viscous", &LINEAR_DAMPING, 0.0, 1e9),
        linear::COULOMB_BACKWARD,
        linear::STICTION_BACKWARD,
        STRIBECK_EXPONENT,
        linear::VISCOUS_QUADRATIC,
        linear::VISCOUS_CUBIC,
    ],
    known: KNOWN,
    build: |v| build(v, FrictionPlace::Load(Freedom::Linear)),
};

pub(super) static ROTARY: PartKind<Friction> = PartKind {
    name: "lugre-rotary",
    summary: "LuGre friction, as torque over speed of a load that turns",
    keys: &[
        quantity("coulomb", &TORQUE, 1e-9, 1e7),
        quantity("stiction", &TORQUE, 1e-9, 1e7),
        quantity("stribeck_speed", &ANGULAR_SPEED, 1e-9, 1e5),
        quantity("bristle_stiffness", &TORSION, 1e-6, 1e15).role(Role::BristleStiffness),
        quantity("bristle_damping", &ROTARY_DAMPING, 0.0, 1e12),
        quantity("viscous", &ROTARY_DAMPING, 0.0, 1e9),
        rotary::COULOMB_BACKWARD,
        rotary::STICTION_BACKWARD,
        STRIBECK_EXPONENT,
        rotary::VISCOUS_QUADRATIC,
        rotary::VISCOUS_CUBIC,
    ],
    known: KNOWN,
    build: |v| build(v, FrictionPlace::Load(Freedom::Rotary)),
};
