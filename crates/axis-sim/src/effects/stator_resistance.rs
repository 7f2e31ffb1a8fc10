//! `stator-resistance`: resistance of the winding.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "stator-resistance",
    summary: "resistance of the winding",
    channel: EffectChannel::Voltage,
    depends_on: "current",
    shown_over: EffectVariable::Current,
    parameters: &[signed("relative_change", Measure::Ratio, 0.15, 0.8)],
    needs: &[EffectNeed::Role(Role::Resistance)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.scale(Role::Resistance, v[0])?;
    Ok(())
}
