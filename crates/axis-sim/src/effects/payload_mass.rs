//! `payload-mass`: payload that moves with the load.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, size};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "payload-mass",
    summary: "payload that moves with the load",
    channel: EffectChannel::Torque,
    depends_on: "acceleration",
    shown_over: EffectVariable::Acceleration,
    parameters: &[size("mass", Measure::Inertia, 30.0, 1e3)],
    needs: &[EffectNeed::Role(Role::LoadInertia)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.add(Role::LoadInertia, v[0])?;
    Ok(())
}
