//! The guard around everything.

use axis_scalar::Scalar;
use compensator::GuardLimits;

use super::data::literal;
use super::draft::{Draft, State};
use super::part;

pub(super) fn add<T: Scalar>(draft: &mut Draft, limits: &GuardLimits<T>) {
    let numbers = [limits.position, limits.effort, limits.surprise].map(literal);
    let GuardLimits { patience, fade, .. } = limits;
    draft.limits = format!("{}, {patience}u, {fade}u", numbers.join(", "));
    draft.part(&part::GUARD);
    draft.states.push(State {
        name: "guard",
        declaration: include_str!("runtime/guard.h").to_owned(),
        reals: 9,
        integers: 8,
    });
}
