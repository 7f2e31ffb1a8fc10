//! `controller-gain`: gain of the position controller.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "controller-gain",
    summary: "gain of the position controller",
    channel: EffectChannel::Controller,
    depends_on: "position error",
    shown_over: EffectVariable::Position,
    parameters: &[signed("relative_change", Measure::Ratio, 0.05, 0.8)],
    needs: &[EffectNeed::Role(Role::PositionGain)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.scale(Role::PositionGain, v[0])?;
    Ok(())
}
