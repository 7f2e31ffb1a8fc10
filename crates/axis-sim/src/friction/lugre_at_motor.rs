//! `lugre-at-motor`: LuGre friction as torque at the motor's shaft (a screw's, for
//! instance), on its speed.

use std::sync::Arc;

use lugre::{LinearOnset, Parameters};

use super::contact::of_bristle;
use super::keys::{
    CUBIC, EXPONENT_OF_CURVE, QUADRATIC, STRIBECK_EXPONENT, is_beyond_lugre, rotary, steady,
};
use super::{Friction, FrictionPlace};
use crate::part::units::{BRISTLE_STIFFNESS, ROTARY_DAMPING, ROTATION, TORQUE};
use crate::part::{Known, PartError, PartKind, Role, Values, quantity};

pub(super) static KIND: PartKind<Friction> = PartKind {
    name: "lugre-at-motor",
    summary: "LuGre friction of the load, as torque over speed at the motor's shaft",
    keys: &[
        quantity("coulomb", &TORQUE, 1e-9, 1e5),
        quantity("stiction", &TORQUE, 1e-9, 1e5),
        quantity("stribeck_speed", &ROTATION, 1e-6, 1e5),
        quantity("bristle_stiffness", &BRISTLE_STIFFNESS, 1e-6, 1e9).role(Role::BristleStiffness),
        quantity("bristle_damping", &ROTARY_DAMPING, 0.0, 1e5),
        quantity("viscous", &ROTARY_DAMPING, 0.0, 1e5),
        quantity("coulomb_backward", &TORQUE, 1e-9, 1e5).optional(),
        quantity("stiction_backward", &TORQUE, 1e-9, 1e5).optional(),
        STRIBECK_EXPONENT,
        rotary::VISCOUS_QUADRATIC,
        rotary::VISCOUS_CUBIC,
    ],
    known: KNOWN,
    build: |v| build(v, FrictionPlace::Motor),
};

/// The levels, each of which may be off by its own tolerance; the break-away is never below the
/// Coulomb level.
pub(super) const COULOMB_LEVEL: Known = Known::by("coulomb_level", |v, by| {
    v.scale("coulomb", by);
    v.scale("coulomb_backward", by);
    keep_break_away_above(v, 1.0);
});
pub(super) const BREAK_AWAY: Known = Known::by("break_away", |v, by| {
    keep_break_away_above(v, by);
});

/// The break-away levels times a factor, but at least the Coulomb level of their direction.
fn keep_break_away_above(v: &mut Values, by: f64) {
    let (coulomb, stiction) = (v.or("coulomb", 0.0), v.or("stiction", 0.0));
    let backward = v.or("coulomb_backward", coulomb);
    if v.optional("stiction_backward").is_some() || backward > coulomb {
        let own = v.or("stiction_backward", stiction);
        v.set("stiction_backward", (by * own).max(backward));
    }
    v.set("stiction", (by * stiction).max(coulomb));
}

/// The known parameters of every LuGre friction.
pub(super) const KNOWN: &[Known] = &[
    COULOMB_LEVEL,
    BREAK_AWAY,
    Known::key("stribeck_speed"),
    Known::key("bristle_stiffness"),
    Known::key("viscous"),
    Known::key("bristle_damping"),
    EXPONENT_OF_CURVE,
    QUADRATIC,
    CUBIC,
];

pub(super) fn build(v: &Values, at: FrictionPlace) -> Result<Arc<Friction>, PartError> {
    if is_beyond_lugre(&steady(v)?) {
        return of_bristle(v, at, LinearOnset {});
    }
    let parameters = Parameters {
        coulomb: v.number("coulomb")?,
        stiction: v.number("stiction")?,
        stribeck_speed: v.number("stribeck_speed")?,
        stiffness: v.number("bristle_stiffness")?,
        damping: v.number("bristle_damping")?,
        viscous: v.number("viscous")?,
    };
    let unit_stiffness = parameters.stiffness / parameters.coulomb;
    Ok(Arc::new(Friction::new(parameters, unit_stiffness, at)?))
}
