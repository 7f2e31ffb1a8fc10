//! The guard around everything.

use axis_scalar::Scalar;
use compensator::GuardLimits;

use super::data::constant;
use super::draft::{Draft, State};
use super::part;

pub(super) fn add<T: Scalar>(draft: &mut Draft, limits: &GuardLimits<T>) {
    draft.data += &[
        constant("POSITION_LIMIT", limits.position, "@L@: greatest offset of the position"),
        constant("EFFORT_LIMIT", limits.effort, "@E@: greatest offset of the command"),
        constant("SURPRISE_LIMIT", limits.surprise, "deviations of the observer"),
        format!(
            "static const uint32_t PATIENCE = {}; /* cycles for which a limit may be exceeded */\nstatic const uint32_t FADE = {}; /* cycles of fading in and out */\n",
            limits.patience, limits.fade
        ),
    ]
    .concat();
    draft.constants += 3;
    draft.counts += 2;
    draft.part(&part::GUARD);
    draft.states.push(State {
        name: "guard",
        declaration: include_str!("runtime/guard.h").to_owned(),
        reals: 2,
        integers: 5,
    });
}
