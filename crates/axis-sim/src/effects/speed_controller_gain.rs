//! `speed-controller-gain`: gain of the speed controller.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "speed-controller-gain",
    summary: "gain of the speed controller",
    channel: EffectChannel::Controller,
    depends_on: "speed error",
    shown_over: EffectVariable::Speed,
    parameters: &[signed("relative_change", Measure::Ratio, 0.05, 0.8)],
    needs: &[EffectNeed::Role(Role::SpeedGain)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.scale(Role::SpeedGain, v[0])?;
    Ok(())
}
