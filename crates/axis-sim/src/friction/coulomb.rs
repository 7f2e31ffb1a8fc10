//! `coulomb`: Coulomb's friction with a pre-sliding distance, and viscous friction.

use std::sync::Arc;

use lugre::Parameters;

use super::{Friction, FrictionPlace};
use crate::freedom::Freedom;
use crate::part::units::{ANGLE, FORCE, LENGTH, LINEAR_DAMPING, ROTARY_DAMPING, TORQUE};
use crate::part::{Known, PartError, PartKind, Values, quantity};

pub(super) static LINEAR: PartKind<Friction> = PartKind {
    name: "coulomb",
    summary: "Coulomb's and viscous friction at a load that moves along a line",
    keys: &[
        quantity("viscous", &LINEAR_DAMPING, 0.0, 1e9),
        quantity("coulomb", &FORCE, 0.0, 1e7),
        quantity("presliding", &LENGTH, 1e-9, 0.1),
    ],
    known: KNOWN,
    build: |v| build(v, Freedom::Linear),
};

pub(super) static ROTARY: PartKind<Friction> = PartKind {
    name: "coulomb-rotary",
    summary: "Coulomb's and viscous friction at a load that turns",
    keys: &[
        quantity("viscous", &ROTARY_DAMPING, 0.0, 1e9),
        quantity("coulomb", &TORQUE, 0.0, 1e7),
        quantity("presliding", &ANGLE, 1e-9, 0.1),
    ],
    known: KNOWN,
    build: |v| build(v, Freedom::Rotary),
};

const KNOWN: &[Known] = &[
    Known::key("viscous"),
    Known::key("coulomb"),
    Known::key("presliding"),
];

fn build(v: &Values, freedom: Freedom) -> Result<Arc<Friction>, PartError> {
    let (coulomb, presliding) = (v.number("coulomb")?, v.number("presliding")?);
    let parameters = Parameters {
        coulomb,
        stiction: coulomb,
        stribeck_speed: 1.0,
        stiffness: coulomb / presliding,
        damping: 0.0,
        viscous: v.number("viscous")?,
    };
    let friction = Friction::new(parameters, 1.0 / presliding, FrictionPlace::Load(freedom))?;
    Ok(Arc::new(friction))
}
