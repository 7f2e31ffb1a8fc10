//! `maxwell-slip` and `maxwell-slip-rotary`: generalised Maxwell slip of four elements.
//!
//! Each has a quarter of the level, and slides from an eighth, a quarter, a half and the whole of the
//! pre-sliding distance on, as in the effect `maxwell-slip-hysteresis`.

use std::sync::Arc;

use lugre::{MaxwellSlip, MaxwellSlipParameters};

use super::contact::{ELEMENTS, with_contact};
use super::keys::{CUBIC, EXPONENT_OF_CURVE, QUADRATIC, STRIBECK_EXPONENT, linear, rotary, steady};
use super::lugre_at_motor::{BREAK_AWAY, COULOMB_LEVEL};
use super::{Friction, FrictionPlace};
use crate::freedom::Freedom;
use crate::part::units::{ANGLE, LENGTH, TIME};
use crate::part::{Known, PartError, PartKind, Values, quantity};

/// Displacements from rest after which each slides, as shares of the pre-sliding distance.
const REACHES: [f64; ELEMENTS] = [0.125, 0.25, 0.5, 1.0];

pub(super) static LINEAR: PartKind<Friction> = PartKind {
    name: "maxwell-slip",
    summary: "generalised Maxwell slip, as force over speed of a load that moves along a line",
    keys: &[
        linear::COULOMB,
        linear::STICTION,
        linear::STRIBECK_SPEED,
        linear::VISCOUS,
        linear::COULOMB_BACKWARD,
        linear::STICTION_BACKWARD,
        STRIBECK_EXPONENT,
        linear::VISCOUS_QUADRATIC,
        linear::VISCOUS_CUBIC,
        quantity("presliding", &LENGTH, 1e-9, 0.1),
        quantity("lag", &TIME, 1e-9, 1e3),
    ],
    known: KNOWN,
    build: |v| build(v, Freedom::Linear),
};

pub(super) static ROTARY: PartKind<Friction> = PartKind {
    name: "maxwell-slip-rotary",
    summary: "generalised Maxwell slip, as torque over speed of a load that turns",
    keys: &[
        rotary::COULOMB,
        rotary::STICTION,
        rotary::STRIBECK_SPEED,
        rotary::VISCOUS,
        rotary::COULOMB_BACKWARD,
        rotary::STICTION_BACKWARD,
        STRIBECK_EXPONENT,
        rotary::VISCOUS_QUADRATIC,
        rotary::VISCOUS_CUBIC,
        quantity("presliding", &ANGLE, 1e-9, 0.1),
        quantity("lag", &TIME, 1e-9, 1e3),
    ],
    known: KNOWN,
    build: |v| build(v, Freedom::Rotary),
};

const KNOWN: &[Known] = &[
    COULOMB_LEVEL,
    BREAK_AWAY,
    Known::key("stribeck_speed"),
    Known::key("presliding"),
    Known::key("lag"),
    Known::key("viscous"),
    EXPONENT_OF_CURVE,
    QUADRATIC,
    CUBIC,
];

fn build(v: &Values, freedom: Freedom) -> Result<Arc<Friction>, PartError> {
    let steady = steady(v)?;
    let coulomb = steady.forward.coulomb;
    let presliding = v.number("presliding")?;
    let share = 1.0 / ELEMENTS as f64;
    let stiffness = REACHES.map(|reach| share * coulomb / (reach * presliding));
    let law = MaxwellSlip::new(MaxwellSlipParameters {
        steady,
        shares: [share; ELEMENTS],
        stiffness,
        // At the Coulomb level the force follows the curve within the lag.
        attraction: coulomb / v.number("lag")?,
    });
    let whole = stiffness.iter().sum();
    with_contact(v, FrictionPlace::Load(freedom), [whole, 0.0], law)
}
