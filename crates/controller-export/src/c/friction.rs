//! Friction feed-forward, and the friction law that plans use too.

use std::fmt::Write;

use compensator::FrictionFeedforward;
use lugre::{Exponential, LuGre};

use super::data::{constant, literal, table};
use super::draft::{Draft, State};
use super::{Input, part};

pub(super) fn add<T: Exponential>(draft: &mut Draft, friction: &FrictionFeedforward<T>) {
    law(draft, friction.law());
    draft.data += &[
        constant(
            "PER_TRAVEL",
            friction.per_travel(),
            "the friction's coordinate per @L@",
        ),
        constant(
            "PER_TORQUE",
            friction.per_torque(),
            "@E@ per unit of friction",
        ),
        constant("FRICTION_PERIOD", friction.period(), "s"),
    ]
    .concat();
    draft.constants += 3;
    draft.part(&part::FRICTION);
    draft.effort = Some("friction_effort(&x->friction, in)");
    draft.inputs.insert(Input::ReferenceVelocity);
    draft.states.push(State {
        name: "friction",
        declaration: include_str!("runtime/friction.h").to_owned(),
        reals: 2,
        integers: 0,
    });
}

/// A LuGre law as `FRICTION`, and the coefficients of its exponentials.
pub(super) fn law<T: Exponential>(draft: &mut Draft, law: &LuGre<T>) {
    let c = law.constants();
    let named = [
        ("coulomb", c.coulomb, "T_C, N m"),
        ("stiction", c.stiction, "T_S, N m"),
        ("damping", c.damping, "sigma_1, N m s/rad"),
        ("viscous", c.viscous, "sigma_2, N m s/rad"),
        ("stiffness", c.stiffness, "sigma_0, N m/rad"),
        ("compliance", c.compliance, "1/sigma_0"),
        ("rise", c.rise, "T_S - T_C"),
        (
            "per_stribeck_speed",
            c.per_stribeck_speed,
            "1/Omega_S, s/rad",
        ),
        (
            "flat_above",
            c.flat_above,
            "rad/s: from where the level is T_C",
        ),
        ("coulomb_bristle", c.coulomb_bristle, "T_C/sigma_0, rad"),
        ("coulomb_decay", c.coulomb_decay, "sigma_0/T_C, 1/rad"),
    ];
    let (mut members, mut values) = (String::new(), String::new());
    for (name, value, meaning) in named {
        let _ = writeln!(members, "    real {name}; /* {meaning} */");
        let _ = writeln!(values, "    {},", literal(value));
    }
    draft.data += &format!(
        "/* LuGre friction; for a coordinate along a line read N and m for N m and rad. */\nstatic const struct {{\n{members}}} FRICTION = {{\n{values}}};\n"
    );
    let decays = T::decays();
    draft.data += &[
        table(
            "SHORT_DECAY",
            decays.short,
            "1 - exp(-a) = a + a^2 Q(a): Q up to a = 0.125,",
        ),
        table("LONG_DECAY", decays.long, "and up to 0.7."),
        table("FRACTIONS", decays.fractions, "2^(-j/64)"),
    ]
    .concat();
    let tables = decays.short.len() + decays.long.len() + decays.fractions.len();
    draft.constants += named.len() + tables;
}
