//! `velocity-feedforward`: share of the reference velocity that is fed forward.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "velocity-feedforward",
    summary: "share of the reference velocity that is fed forward",
    channel: EffectChannel::Controller,
    depends_on: "reference velocity",
    shown_over: EffectVariable::Speed,
    parameters: &[signed("relative_change", Measure::Ratio, 0.002, 0.5)],
    needs: &[EffectNeed::Role(Role::VelocityFeedforward)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.scale(Role::VelocityFeedforward, v[0])?;
    Ok(())
}
