//! `bouc-wen` and `bouc-wen-rotary`: friction of Bouc and Wen on a Stribeck curve.

use std::sync::Arc;

use lugre::BoucWenOnset;

use super::contact::of_bristle;
use super::keys::{CUBIC, EXPONENT_OF_CURVE, QUADRATIC, STRIBECK_EXPONENT, linear, rotary};
use super::lugre_at_motor::{BREAK_AWAY, COULOMB_LEVEL};
use super::{Friction, FrictionPlace};
use crate::freedom::Freedom;
use crate::part::{Known, PartError, PartKind, Values, number};

pub(super) static LINEAR: PartKind<Friction> = PartKind {
    name: "bouc-wen",
    summary: "friction of Bouc and Wen, as force over speed of a load that moves along a line",
    keys: &[
        linear::COULOMB,
        linear::STICTION,
        linear::STRIBECK_SPEED,
        linear::STIFFNESS_OF_BRISTLE,
        linear::VISCOUS,
        linear::COULOMB_BACKWARD,
        linear::STICTION_BACKWARD,
        STRIBECK_EXPONENT,
        linear::VISCOUS_QUADRATIC,
        linear::VISCOUS_CUBIC,
        number("exponent", 1.0, 16.0),
        number("loading_share", 0.5, 10.0),
    ],
    known: KNOWN,
    build: |v| build(v, Freedom::Linear),
};

pub(super) static ROTARY: PartKind<Friction> = PartKind {
    name: "bouc-wen-rotary",
    summary: "friction of Bouc and Wen, as torque over speed of a load that turns",
    keys: &[
        rotary::COULOMB,
        rotary::STICTION,
        rotary::STRIBECK_SPEED,
        rotary::STIFFNESS_OF_BRISTLE,
        rotary::VISCOUS,
        rotary::COULOMB_BACKWARD,
        rotary::STICTION_BACKWARD,
        STRIBECK_EXPONENT,
        rotary::VISCOUS_QUADRATIC,
        rotary::VISCOUS_CUBIC,
        number("exponent", 1.0, 16.0),
        number("loading_share", 0.5, 10.0),
    ],
    known: KNOWN,
    build: |v| build(v, Freedom::Rotary),
};

const KNOWN: &[Known] = &[
    COULOMB_LEVEL,
    BREAK_AWAY,
    Known::key("stribeck_speed"),
    Known::key("bristle_stiffness"),
    Known::key("viscous"),
    EXPONENT_OF_CURVE,
    QUADRATIC,
    CUBIC,
];

fn build(v: &Values, freedom: Freedom) -> Result<Arc<Friction>, PartError> {
    let onset = BoucWenOnset {
        exponent: v.number("exponent")?,
        loading_share: v.number("loading_share")?,
    };
    of_bristle(v, FrictionPlace::Load(freedom), onset)
}
