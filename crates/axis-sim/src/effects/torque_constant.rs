//! `torque-constant`: torque per current.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "torque-constant",
    summary: "torque per current",
    channel: EffectChannel::Torque,
    depends_on: "current",
    shown_over: EffectVariable::Current,
    parameters: &[signed("relative_change", Measure::Ratio, 0.05, 0.5)],
    needs: &[EffectNeed::Role(Role::TorqueConstant)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.scale(Role::TorqueConstant, v[0])?;
    Ok(())
}
