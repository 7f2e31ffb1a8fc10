//! `control-delay`: delay of the current reference.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, positive};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "control-delay",
    summary: "delay of the current reference",
    channel: EffectChannel::Controller,
    depends_on: "change of the current reference",
    shown_over: EffectVariable::Current,
    parameters: &[positive("time", Measure::Time, 1e-4, 5e-3)],
    needs: &[EffectNeed::Role(Role::CommandDelay)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.add(Role::CommandDelay, v[0].max(0.0))?;
    Ok(())
}
